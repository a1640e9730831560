"""Meshes in a zip file next to the description, which is unpacked before the robot is loaded."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterator
from pathlib import Path

from ...errors import UrdftoolError
from ...source.description import Description
from ...workspace import Workspace


def find_packed(paths: list[Path], description: Description) -> dict[Path, list[Path]]:
    """Find missing files in the zip files of the folder of a description, by zip file.

    A file counts if it is there after the zip file is unpacked next to itself, or into a folder of
    its name.
    """
    if description.path == "-" or not paths:
        return {}
    files = description.workspace
    folder = Path(os.path.abspath(description.path)).parent
    packed: dict[Path, list[Path]] = {}
    for archive in files.list_matches(folder, "*.zip"):
        entries = set(_list_unpacked(archive, files))
        found = [path for path in paths if os.path.abspath(path) in entries]
        if found:
            packed[archive] = found
            paths = [path for path in paths if path not in found]
    return packed


def _list_unpacked(archive: Path, files: Workspace) -> Iterator[str]:
    """List the paths that the files of a zip file have once it is unpacked."""
    try:
        with files.open(archive) as stream, zipfile.ZipFile(stream) as opened:
            names = opened.namelist()
    except (OSError, UrdftoolError, zipfile.BadZipFile, NotImplementedError, ValueError):
        return
    for name in names:
        for folder in (archive.parent, archive.with_suffix("")):
            yield os.path.normpath(folder / name)
