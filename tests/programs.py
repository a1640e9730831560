"""Tell whether a program is installed that tests are marked with: ``python -m tests.programs``."""

import re
import shutil
import sys
from pathlib import Path

MARK = re.compile(r"mark\.program\(([^)]*)\)")


def named():
    """The programs that tests are marked with."""
    for path in Path(__file__).parent.rglob("test_*.py"):
        for arguments in MARK.findall(path.read_text("utf-8")):
            yield from re.findall(r'"([\w-]+)"', arguments)


if __name__ == "__main__":
    found = sorted({name for name in named() if shutil.which(name)})
    print(f"programs that tests require: {', '.join(found) or 'none'} installed")
    sys.exit(not found)
