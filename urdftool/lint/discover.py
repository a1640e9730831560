"""The descriptions among what the user named: files as they are, folders searched."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

ENDINGS = (".urdf", ".urdf.xacro")


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


def _below(folder: str) -> Iterator[str]:
    for root, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            if name.endswith(ENDINGS):
                yield os.path.normpath(os.path.join(root, name))
