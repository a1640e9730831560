"""The way in which rde-urdf 1.4 finds definitions: one line decides what a word is.

Its search was written again after its description: what the line contains decides what is looked
for; the first match in the file, the files that it includes with a plain relative path, and the
first hundred files of the workspace. Source: urdfDefinitionProvider.ts of
github.com/Ranch-Hand-Robotics/rde-urdf.
"""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

from urdftool.server.words import Word

MOST_FILES = 100
"""Files of the workspace that it searches; source: its call of ``findFiles``."""

_TAGS = {
    "link": ("link",),
    "joint": ("joint",),
    "macro": ("xacro:macro",),
    "property": ("xacro:property",),
    "": ("link", "joint", "xacro:macro", "xacro:property"),
}
_INCLUDE = re.compile(r"<xacro:include\s+filename=[\"']([\w/.-]+)[\"']")


def find_by_line(word: Word, folder: Path) -> tuple[str, int] | None:
    """Return the file and line, from 1, to which rde-urdf jumps from a name; None for nothing."""
    file = word.element.file
    number = file.position(word.start)[0]
    kind = classify_line(file.get_line_text(number))
    if kind == "file":
        return None
    path = Path(file.path).resolve()
    for one in (path, *_list_included(path), *_list_files(folder)):
        text = _read(one)
        for tag in _TAGS[kind]:
            match = re.search(rf"<{tag}\s+name=[\"']{re.escape(word.name)}[\"']", text)
            if match is not None:
                return str(one), text.count("\n", 0, match.start()) + 1
    return None


def classify_line(line: str) -> str:
    """Return what a word in a line is taken for; empty for any."""
    if "package://" in line or "filename=" in line:
        return "file"
    if any(part in line for part in ("link=", "<child", "<parent")):
        return "link"
    if "joint=" in line or "<joint" in line:
        return "joint"
    if "xacro:" in line and "name=" in line:
        return "macro"
    return "property" if "${" in line or "xacro:property" in line else ""


@lru_cache(maxsize=1024)
def _read(path: Path) -> str:
    try:
        return path.read_text("utf-8", "replace")
    except OSError:
        return ""


def _list_included(path: Path) -> list[Path]:
    found = (path.parent / name for name in _INCLUDE.findall(_read(path)))
    return [one for one in found if one.is_file()]


@lru_cache(maxsize=64)
def _list_files(folder: Path) -> list[Path]:
    files = [one for end in ("urdf", "xacro") for one in folder.rglob(f"*.{end}")]
    return sorted(files)[:MOST_FILES]
