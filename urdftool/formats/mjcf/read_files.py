"""Check of the files that MuJoCo opens itself: meshes, textures, height fields, skins."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from itertools import product
from pathlib import Path

from ...errors import AccessError
from ...source.access import FileAccess
from ...source.document import STDIN, Element
from .read_text import Expanded

_FOLDERS = ("assetdir", "meshdir", "texturedir")


def check_files(expanded: Expanded, access: FileAccess) -> None:
    """Check every file that MuJoCo may open for a model, with any of its compiler settings.

    Raises:
        AccessError: The model may not read a file.
    """
    elements = list(expanded.lines.values())
    folders = sorted({folder for element in elements for folder in _list_folders(element)})
    main = expanded.files[0].path
    for element in elements:
        sources = {os.path.dirname(path) for path in (main, element.file.path) if path != STDIN}
        for name in _list_names(element):
            for path in _list_paths(name, sources or {""}, folders):
                reason = access.explain_refusal(path) if os.path.lexists(path) else ""
                if reason:
                    raise AccessError(f"file '{name}' {reason}", at=element.place)


def _list_folders(element: Element) -> list[str]:
    return ["", *filter(None, (element.get(name) for name in _FOLDERS))]


def _list_names(element: Element) -> Iterator[str]:
    """Yield the files of an element: ``file``, and ``fileup`` and others of a cube map."""
    for name, value in element.attributes.items():
        if name.startswith("file") and value and "\0" not in value:
            yield value


def _list_paths(name: str, sources: Iterable[str], folders: Iterable[str]) -> set[Path]:
    """Return the paths that a name may mean; MuJoCo may strip its folders."""
    written = {name, os.path.basename(name.replace("\\", "/"))}
    return {Path(source, *parts) for source, *parts in product(sources, folders, written)}
