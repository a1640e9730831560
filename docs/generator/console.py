"""What commands print: the ``console`` blocks of the pages, run in a copy of the fixtures.

A page may say how it is run in a comment, ``<!-- run: slow, needs mujoco, numbers vary -->``: slow
pages are run by the slow tests alone, those that need a library where there is one, and where
numbers vary (seconds, what an engine computes on another processor) the words are compared.
Programs that not every machine has cannot be seen by the commands.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from .programs import bare_path

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "fixtures"
BLOCK = re.compile(r"(?<=```console\n).*?(?=```)", re.DOTALL)
FILE = re.compile(r"<!-- file: (\S+) -->\n\n```\w+\n(.*?)```", re.DOTALL)
PICTURE = re.compile(r"!\[[^\]]*\]\([^)]*pictures/([^)/]+)\)")
RUN = re.compile(r"<!-- run: (.*?) -->")
UNSEEN = ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "FORCE_COLOR", "URDFTOOL_TRUST")


@dataclass(frozen=True)
class How:
    """How the commands of a page are run."""

    slow: bool = False
    needs: tuple[str, ...] = ()
    numbers_vary: bool = False

    @property
    def is_possible(self) -> bool:
        """Whether what they need is installed."""
        return all(find_spec(name) or shutil.which(name) for name in self.needs)


def how(text: str) -> How:
    """What a page says of how it is run."""
    said = RUN.search(text)
    words = [word.strip() for word in said[1].split(",")] if said else []
    needs = tuple(word.removeprefix("needs ") for word in words if word.startswith("needs "))
    known = {"slow", "numbers vary", *(f"needs {name}" for name in needs)}
    assert set(words) <= known, f"{set(words) - known} is no way to run a page"
    return How("slow" in words, needs, "numbers vary" in words)


def written_pages() -> Iterator[Path]:
    """The pages that people write."""
    yield ROOT / "README.md"
    for path in sorted((ROOT / "docs").rglob("*.md")):
        if path.parent.name != "rules":
            yield path


def with_output(text: str, pictures: Path | None = None) -> str:
    """A page with what its commands print now; the commands of a page run one after the other.

    Files that the page shows under a mark, ``<!-- file: NAME -->``, are there when they start.

    Args:
        text: The page.
        pictures: Where pictures go that its commands make and that it shows.
    """
    if not BLOCK.search(text):
        return text
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        shutil.copytree(FIXTURES, here / "fixtures")
        for name, content in FILE.findall(text):
            (here / name).write_text(content, "utf-8")

        def run(match: re.Match[str]) -> str:
            commands = [line for line in match[0].splitlines() if line.startswith("$ ")]
            return "".join(f"{line}\n{_output(line[2:], folder)}" for line in commands)

        text = BLOCK.sub(run, text)
        for name in PICTURE.findall(text) if pictures else ():
            if (here / name).exists():
                shutil.copy(here / name, pictures / name)
        return text


def same(old: str, new: str, how: How) -> bool:
    """Whether two states of a page say the same."""
    if how.numbers_vary:
        old, new = (BLOCK.sub(lambda match: _words(match[0]), text) for text in (old, new))
    return old == new


def _words(block: str) -> str:
    without = re.sub(r"[-+]?[\d,.]*\d(e[-+]?\d+)?", "0", block)
    return re.sub(r"[ \t]+|-{3,}|─+", " ", without)


def _output(command: str, folder: str) -> str:
    """What a command prints on both streams."""
    path = bare_path(Path(folder) / ".programs", Path(sys.executable).parent)
    seen = {name: value for name, value in os.environ.items() if name not in UNSEEN}
    own = {"PATH": path, "NO_COLOR": "1", "COLUMNS": "100", "XDG_CACHE_HOME": f"{folder}/.cache"}
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env={**seen, **own},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    return re.sub(r"[ \t]+$", "", done.stdout, flags=re.MULTILINE)
