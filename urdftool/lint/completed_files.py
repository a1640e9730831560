"""Descriptions that the code of a project completes before it loads them.

Such a file names a folder that a program downloads or replaces, gets its files from the program, or
is a part that a program merges into another. No reader loads it as it lies, which is no defect of
the file: it is not checked, and the summary says once for each cause why.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path, PurePosixPath
from typing import Any

from ..errors import UrdftoolError
from ..source.packages import shorten_path
from ..workspace import Workspace
from .imported_readers import find_project, list_code_of

_GENERIC = frozenset(
    (
        *("assets", "meshes", "mesh", "textures", "texture", "visual", "visuals", "collision"),
        *("collisions", "models", "model", "data", "urdf", "mjcf", "xml", "xmls", "robots"),
        *("robot", "common", "scene", "scenes", "resources", "include", "stl", "obj", "files"),
    )
)
"""Names of folders that code also mentions for another reason. Chosen from public packages."""

_FETCHES = re.compile(rb"https?://|\bgit clone\b|urlretrieve|snapshot_download|hf_hub_download")
_NEAR = 400
"""Distance [bytes] of a name from the download that it belongs to; chosen, no source."""

_HANDS_OVER = re.compile(rb"\bfrom_xml_string\([^;]{0,200}?\bassets\b")
_LOADS_PATH = re.compile(rb"\bfrom_xml_path\(")
_SETS_FILE = re.compile(rb"""\.set\(\s*["']file["']""")
_MERGES = re.compile(
    rb"\bmjcf\.from_(?:path|file|xml_string)\(|\.attach_body\(|\bMjSpec\.from_|\bMujocoXML\b"
)


def find_completing_code(files: Workspace, path: str, error: UrdftoolError) -> str:
    """Return how code of its project completes a file that cannot be read; empty if none does.

    Args:
        files: Reads the code.
        path: Path of the description.
        error: Why it cannot be read.
    """
    missing = error.data.get("missing")
    if missing is None and not error.data.get("lost_name"):
        return ""
    project = find_project(files, Path(os.path.abspath(path)).parent)
    if project is None:
        return ""
    code = [name for name in list_code_of(files, str(project)) if name.endswith(".py")]
    if missing is None:
        place = _find_place(files, code, _MERGES.search)
        return place and f"parts that a program merges into other models ({place})"
    lost = PurePosixPath(missing)
    base = Path(error.at.file.path if error.at is not None else path).parent
    for number, _ in enumerate(lost.parts[:-1]):
        folder = base.joinpath(*lost.parts[: number + 1])
        place = _find_download(files, code, folder)
        if place:
            return f"folder '{folder.name}' is missing, which code that downloads names ({place})"
        if " " in folder.name:  # a remark in place of a folder
            words = [re.escape(os.fsencode(word)) for word in folder.name.split()]
            place = _find_place(files, code, re.compile(rb"\s+".join(words)).search)
            if place:
                return f"code of the project replaces '{folder.name}' ({place})"
    if lost.suffix.lower() in (".png", ".jpg", ".jpeg"):
        place = _find_place(files, code, _SETS_FILE.search)
        if place:
            return f"code of the project writes the names of files into the XML ({place})"
    if not _find_place(files, code, _LOADS_PATH.search):
        place = _find_place(files, code, _HANDS_OVER.search)
        if place:
            return f"code of the project hands files over as assets ({place})"
    return ""


def find_supplying_code(files: Workspace, path: str, data: Mapping[str, Any]) -> str:
    """Return how code of its project supplies meshes that a description does not find.

    It downloads their folder, or reads the description as text and hands the meshes over, which
    are elsewhere in the project.

    Args:
        files: Reads the code.
        path: Path of the description.
        data: Data of the finding: the missing ``folder``, or the ``path`` of a missing file.

    Returns:
        What the code does, with a place; empty if nothing shows that it supplies them.
    """
    project = find_project(files, Path(os.path.abspath(path)).parent)
    if project is None:
        return ""
    code = [name for name in list_code_of(files, str(project)) if name.endswith(".py")]
    missing = data.get("path")
    folder = Path(os.path.abspath(data.get("folder") or os.path.dirname(missing or path)))
    place = _find_download(files, code, folder)
    if place:
        return f"code that downloads names the folder ({place})"
    if missing is None or not files.list_matches(project, f"**/{os.path.basename(missing)}"):
        return ""
    name = re.escape(os.fsencode(os.path.basename(path)))
    place = _find_place(files, code, partial(_find_reading, re.compile(rb"""["'/]%s["']""" % name)))
    return place and f"code reads the URDF as text and hands the meshes over ({place})"


def _find_reading(word: re.Pattern[bytes], text: bytes) -> re.Match[bytes] | None:
    """Return the first match of a name in code that reads files as text, and meshes as bytes."""
    reads = _READS_TEXT.search(text) and _READS_MESHES.search(text)
    return word.search(text) if reads else None


_READS_TEXT = re.compile(rb"\bfromstring\(|\bElementTree\b")
_READS_MESHES = re.compile(rb"\bread_bytes\(|\bopen\([^)\n]*[\"']rb[\"']")


def _find_download(files: Workspace, code: list[str], folder: Path) -> str:
    """Return the place of code that downloads a missing folder; empty if none does.

    A general name such as ``assets`` counts with that of the folder above it.
    """
    name = folder.name
    if name == ".." or files.exists(folder):
        return ""
    if name in _GENERIC:
        above = Path(os.path.abspath(folder)).parent.name
        word = re.compile(rb"""(?<=["'/])%s(?=["'/])""" % re.escape(os.fsencode(f"{above}/{name}")))
        return _find_place(files, code, partial(_find_beside_download, word))
    word = re.compile(rb"""(?<=["'/])%s(?=["'/.])""" % re.escape(os.fsencode(name)))
    return _find_place(files, code, partial(_find_near_download, word))


def _find_beside_download(word: re.Pattern[bytes], text: bytes) -> re.Match[bytes] | None:
    """Return the first match of a path in code that downloads anything."""
    return word.search(text) if _FETCHES.search(text) else None


def _find_near_download(word: re.Pattern[bytes], text: bytes) -> re.Match[bytes] | None:
    """Return the first match of a word that stands near to a download."""
    for match in word.finditer(text):
        if _FETCHES.search(text, max(match.start() - _NEAR, 0), match.end() + _NEAR):
            return match
    return None


def _find_place(
    files: Workspace, code: list[str], search: Callable[[bytes], re.Match[bytes] | None]
) -> str:
    """Return file and line of the first match in code; empty if there is none."""
    for path in code:
        try:
            text = files.read_bytes(path)
        except (OSError, UrdftoolError):
            continue
        match = search(text)
        if match is not None:
            line = text.count(b"\n", 0, match.start()) + 1
            return f"{shorten_path(path)}:{line}"
    return ""
