"""Descriptions in SDF and MJCF below folders, by name and content."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from ..errors import UrdftoolError
from ..extras import is_installed
from ..lint.discover import has_ending, list_files

_ENDINGS = (".sdf", ".xml", ".mjcf")
_INCLUDE = re.compile(rb"<include\b[^<>]*?\bfile\s*=\s*[\"']([^\"']+)[\"']")
_MODEL = re.compile(rb"<(?:include|model|attach)\b")


@dataclass
class Found:
    """Descriptions below folders.

    Attributes:
        files: Files that describe a robot.
        skipped: Reason by file that belongs to a format, but describes no robot of its own.
        not_checked: Reason by file that may be a robot, but whose reader is not installed.
        links: Links that are not followed.
    """

    files: list[str] = field(default_factory=list)
    skipped: dict[str, str] = field(default_factory=dict)
    not_checked: dict[str, str] = field(default_factory=dict)
    links: list[str] = field(default_factory=list)


def find_other_descriptions(paths: Iterable[str]) -> Found:
    """Find the descriptions in SDF and MJCF below folders; hidden folders are skipped.

    A part that another MJCF file below the folders includes is skipped, and so is a world of SDF
    without a link of its own. MJCF is not checked without MuJoCo.
    """
    found, models = Found(), {}
    folders = [path for path in paths if os.path.isdir(path)]
    if not folders:  # avoids imports
        return found
    from ..source.document import read_file
    from .detect import format_of

    for path in (path for folder in folders for path in list_files(folder, _ENDINGS, found.links)):
        try:
            file = read_file(path)
        except UrdftoolError as error:
            if has_ending(path, ".sdf"):
                found.skipped[path] = error.message
            continue
        kind = format_of(file).name
        if kind == "mjcf":
            models[os.path.realpath(path)] = path, file.data
        elif kind == "sdf" and has_ending(path, ".sdf"):
            if b"<link" in file.data or (b"<include" in file.data and b"<world" not in file.data):
                found.files.append(path)
            else:
                found.skipped[path] = "SDF without a link of its own"
    _add_models(found, models)
    return found


def _add_models(found: Found, models: dict[str, tuple[str, bytes]]) -> None:
    """Add the MJCF files, of which ``models`` has the path and content by resolved path."""
    included: set[str] = set()
    for real in models:
        included |= set(_list_included(real, models)) - {real}
    for real, (path, data) in models.items():
        if b"<mujocoinclude" in data[:4096] or real in included:
            found.skipped[path] = "a part of an MJCF model; lint the file that includes it"
        elif b"<body" not in data and not _MODEL.search(data):
            found.skipped[path] = "MJCF without a body"
        elif not is_installed("mujoco"):
            found.not_checked[path] = "MJCF requires MuJoCo: pip install 'urdftool[mujoco]'"
        else:
            found.files.append(path)


def _list_included(top: str, models: dict[str, tuple[str, bytes]]) -> Iterator[str]:
    """Yield the files that a file includes, relative to it or to the file that includes them."""
    todo, known = [top], {top}
    while todo:
        current = todo.pop()
        for name in _INCLUDE.findall(models[current][1]):
            for base in (top, current):
                path = os.path.join(os.path.dirname(base), os.fsdecode(name))
                real = os.path.realpath(path)
                if real in models and real not in known:
                    known.add(real)
                    todo.append(real)
                    yield real
