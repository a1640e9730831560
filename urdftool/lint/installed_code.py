"""Digest of the code that checks: results of other code are not used."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path

from .. import __version__
from ..extras import EXTRA_OF, is_installed


def hash_code() -> str:
    """Return a digest of the code that runs: files of urdftool, Python, installed libraries."""
    root = Path(__file__).parents[1]
    facts = [
        *(__version__, sys.version),
        # an installer that changes an installation also changes the folder of libraries
        [] if root.parent.name in _OF_LIBRARIES else _list_code(str(root)),
        list(_list_library_folders(sys.path)),
        [library for library in EXTRA_OF if is_installed(library)],
    ]
    return sha256(repr(facts).encode("utf-8", "surrogateescape")).hexdigest()


def _list_code(root: str) -> list[tuple[str, int, int]]:
    """Return the files of code below a folder with their sizes [bytes] and times [ns], sorted."""
    folders = [root]
    files: list[tuple[str, int, int]] = []
    for folder in folders:
        with os.scandir(folder) as entries:
            for entry in entries:
                if entry.name.endswith((".py", ".html")):
                    status = entry.stat()
                    files.append((entry.path, status.st_size, status.st_mtime_ns))
                elif "." not in entry.name and entry.name != "__pycache__" and entry.is_dir():
                    folders.append(entry.path)
    return sorted(files)


_OF_LIBRARIES = ("site-packages", "dist-packages")
"""Names of the folders into which libraries are installed."""


def _list_library_folders(path: Iterable[str]) -> Iterable[tuple[str, int]]:
    """Yield the library folders with their modification times [ns]."""
    for folder in path:
        if os.path.basename(folder) in _OF_LIBRARIES:
            try:
                yield folder, os.stat(folder).st_mtime_ns
            except OSError:
                continue
