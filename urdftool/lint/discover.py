"""The descriptions among what the user named: files as they are, folders searched."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator

ENDINGS = (".urdf", ".urdf.xacro")
_HEAD = 16_384


def find_descriptions(paths: Iterable[str]) -> list[str]:
    """The files to check, each once: files that are named, and descriptions below folders.

    Hidden folders are passed over. A path that does not exist is kept, so that it is reported.
    """
    found: dict[str, str] = {}
    for path in paths:
        files = _below(path) if os.path.isdir(path) else [path]
        for file in files:
            found.setdefault(os.path.realpath(file) if file != "-" else file, file)
    return list(found.values())


def parts_below(paths: Iterable[str]) -> list[str]:
    """The ``.xacro`` files of searched folders that are not taken for descriptions."""
    folders = [path for path in paths if os.path.isdir(path)]
    found = (path for folder in folders for path in _below(folder, (".xacro",)))
    return [path for path in dict.fromkeys(found) if not path.endswith(ENDINGS)]


def nothing_below(paths: Iterable[str]) -> str:
    """What to say where folders have no description, with a ``.xacro`` that may be one."""
    folders = list(paths)
    said = f"no .urdf or .urdf.xacro below {', '.join(folders)}"
    for folder in folders:
        for path in _below(folder, (".xacro",)):
            if _has_name(path):
                return f"{said}; parts of robots are .xacro too: name {path} if it is a robot"
    return said


def _has_name(path: str) -> bool:
    """Whether a file is a robot with a name, as parts that are included seldom are."""
    try:
        with open(path, "rb") as stream:
            return re.search(rb"<robot\b[^>]*\sname\s*=", stream.read(_HEAD)) is not None
    except OSError:
        return False


def _below(folder: str, endings: tuple[str, ...] = ENDINGS) -> Iterator[str]:
    for root, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            if name.endswith(endings):
                yield os.path.normpath(os.path.join(root, name))
