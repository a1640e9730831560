"""Discovery of descriptions: named files, and descriptions in named folders."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator

ENDINGS = (".urdf", ".urdf.xacro")
_HEAD = 16_384


def find_descriptions(paths: Iterable[str]) -> list[str]:
    """Return the files to check, each once: named files, and descriptions below named folders.

    Hidden folders are skipped. A path that does not exist is kept, so that it is reported.
    """
    found: dict[str, str] = {}
    for path in paths:
        files = _list_files(path) if os.path.isdir(path) else [path]
        for file in files:
            found.setdefault(os.path.realpath(file) if file != "-" else file, file)
    return list(found.values())


def list_parts(paths: Iterable[str]) -> list[str]:
    """Return the ``.xacro`` files below named folders that are not descriptions by their name."""
    folders = [path for path in paths if os.path.isdir(path)]
    found = (path for folder in folders for path in _list_files(folder, (".xacro",)))
    return [path for path in dict.fromkeys(found) if not path.endswith(ENDINGS)]


def explain_nothing_found(paths: Iterable[str]) -> str:
    """Return the message for folders without a description, with a ``.xacro`` that may be one."""
    folders = list(paths)
    said = f"no .urdf or .urdf.xacro below {', '.join(folders)}"
    for folder in folders:
        for path in _list_files(folder, (".xacro",)):
            if _has_name(path):
                return (
                    f"{said}; .xacro files may be parts of robots: give {path} itself if it is "
                    "a robot"
                )
    return said


def _has_name(path: str) -> bool:
    """Tell whether a file has a ``<robot>`` with a name, which included files rarely have."""
    try:
        with open(path, "rb") as stream:
            return re.search(rb"<robot\b[^>]*\sname\s*=", stream.read(_HEAD)) is not None
    except OSError:
        return False


def _list_files(folder: str, endings: tuple[str, ...] = ENDINGS) -> Iterator[str]:
    for root, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            if name.endswith(endings):
                yield os.path.normpath(os.path.join(root, name))
