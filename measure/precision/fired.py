"""``python -m measure.precision.fired FOLDER…``: in how many files each rule has a finding.

The descriptions below the folders are checked with the defaults; ``fired.json``, of which the
table of evidence in docs/rules/index.md is made, is written anew.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from urdftool.formats.detect import read_other_format
from urdftool.formats.search import find_other_descriptions
from urdftool.lint.options import Options
from urdftool.lint.parallel import check_files
from urdftool.lint.robot_search import find_robots

FIRED = Path(__file__).with_name("fired.json")


def count_files(folders: Iterable[str]) -> dict[str, object]:
    """Count the checked files, and those with a finding by rule."""
    folders = list(folders)
    options = Options(read_other=read_other_format)
    files = [
        robot.path for robot in find_robots(folders, workspace=options.workspace).robots.values()
    ]
    files += find_other_descriptions(folders).files
    counts: Counter[str] = Counter()
    checked = 0
    for report in check_files(files, options, 1):
        checked += report.checked
        counts.update({finding.code for finding in report.findings})
    return {"files": checked, "rules": dict(sorted(counts.items()))}


if __name__ == "__main__":
    FIRED.write_text(json.dumps(count_files(sys.argv[1:]), indent=1) + "\n", "utf-8")
