"""Run the ``console`` blocks of the pages in a copy of the fixtures.

A comment in a page sets how its commands run: ``<!-- run: slow, needs mujoco, numbers vary -->``.
Slow pages run only in the slow tests; pages that need a library are skipped without it. Where
numbers vary (seconds, results of an engine on another processor), tests compare only the words.
Commands see only the programs of ``programs.py``.
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

from .programs import restrict_path

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "fixtures"
LARGE = ("rules", "effects")
"""Folders of fixtures with many files, which are copied only for pages that name them."""

BLOCK = re.compile(r"(?<=```console\n).*?(?=```)", re.DOTALL)
FILE = re.compile(r"<!-- file: (\S+) -->\n\n```\w+\n(.*?)```", re.DOTALL)
PICTURE = re.compile(r"!\[[^\]]*\]\([^)]*pictures/([^)/]+)\)")
RUN = re.compile(r"<!-- run: (.*?) -->")
TIME = re.compile(r" \(checked in [\d.]+ s\)$", re.MULTILINE)
"""The time that a command adds where it took long."""

PROGRESS = re.compile(r"^(?:\d+ of \d+ [\w ]+, )?\d+ s(?:: .*)?\n", re.MULTILINE)
UNSEEN = ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "FORCE_COLOR", "URDFTOOL_TRUST")


@dataclass(frozen=True)
class Mode:
    """How the commands of a page are run.

    Attributes:
        slow: Only the slow tests run them.
        needs: Libraries and programs that they require.
        numbers_vary: Numbers in their output are not compared.
    """

    slow: bool = False
    needs: tuple[str, ...] = ()
    numbers_vary: bool = False

    @property
    def is_possible(self) -> bool:
        """Whether the libraries and programs are installed."""
        return all(find_spec(name) or shutil.which(name) for name in self.needs)


def read_mode(text: str) -> Mode:
    """Read how the commands of a page are run."""
    comment = RUN.search(text)
    words = [word.strip() for word in comment[1].split(",")] if comment else []
    needs = tuple(word.removeprefix("needs ") for word in words if word.startswith("needs "))
    known = {"slow", "numbers vary", *(f"needs {name}" for name in needs)}
    assert set(words) <= known, f"{set(words) - known} cannot be set for a page"
    return Mode("slow" in words, needs, "numbers vary" in words)


def list_pages() -> Iterator[Path]:
    """Yield the pages that people write."""
    yield ROOT / "README.md"
    for path in sorted((ROOT / "docs").rglob("*.md")):
        if path.parent.name != "rules":
            yield path


def insert_output(text: str, pictures: Path | None = None) -> str:
    """Replace the output in a page by the current output of its commands, run in order.

    A block under a mark ``<!-- file: NAME -->`` is written to that file first.

    Args:
        text: Text of the page.
        pictures: Folder for the pictures that its commands write and the page shows.
    """
    if not BLOCK.search(text):
        return text
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        unnamed = [name for name in LARGE if f"fixtures/{name}" not in text]
        shutil.copytree(FIXTURES, here / "fixtures", ignore=shutil.ignore_patterns(*unnamed))
        for name, content in FILE.findall(text):
            (here / name).write_text(content, "utf-8")

        def run(match: re.Match[str]) -> str:
            commands = [line for line in match[0].splitlines() if line.startswith("$ ")]
            return "".join(f"{line}\n{_run_command(line[2:], folder)}" for line in commands)

        text = BLOCK.sub(run, text)
        for name in PICTURE.findall(text) if pictures else ():
            if (here / name).exists():
                shutil.copy(here / name, pictures / name)
        return text


def is_same(old: str, new: str, mode: Mode) -> bool:
    """Return whether two versions of a page show the same output."""
    if mode.numbers_vary:
        old, new = (BLOCK.sub(lambda match: _mask_numbers(match[0]), text) for text in (old, new))
    return old == new


def _mask_numbers(block: str) -> str:
    without = re.sub(r"[-+]?[\d,.]*\d(e[-+]?\d+)?", "0", block)
    return re.sub(r"[ \t]+|-{3,}|─+", " ", without)


def _run_command(command: str, folder: str) -> str:
    """Return what a command prints on both streams, without progress, which depends on the time."""
    path = restrict_path(Path(folder) / ".programs", Path(sys.executable).parent)
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
    shown = TIME.sub("", PROGRESS.sub("", done.stdout))
    return re.sub(r"[ \t]+$", "", shown, flags=re.MULTILINE)
