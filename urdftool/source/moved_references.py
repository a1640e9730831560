"""Adjust the relative file names of a description that is written to another folder."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..errors import SourceError
from . import edit
from .document import Element
from .location import SourceFile
from .packages import shorten_path

_TAGS = ("mesh", "texture")


def is_relative(name: str) -> bool:
    """Tell whether a file name is relative to its description, and not computed by xacro."""
    return bool(name) and "://" not in name and not name.startswith(("/", "$"))


def move_references(
    file: SourceFile, elements: Iterable[Element], here: Path, folder: Path
) -> bytes:
    """Return a description with the relative names of its meshes, textures and includes adjusted.

    Raises:
        SourceError: A relative name is computed, or written in an included file, so that it cannot
            be adjusted; or the encoding is not supported for edits.
    """
    if here == folder:
        return file.data
    source = edit.parse_source(file)
    named = dict(_list_relative(source.document.root.walk()))
    for name, element in _list_relative(elements):
        if element.tag in _TAGS and name not in named:
            raise SourceError(
                f"'{name}' is relative to {file.path}, but is computed or written in an included "
                "file, so it cannot be made relative to the output; write to a file in "
                f"{shorten_path(here)}",
                at=element.locate_attribute("filename"),
            )
    edits = []
    for element in source.document.root.walk():
        for name, _ in _list_relative([element]):
            moved = Path(os.path.relpath(here / name, folder)).as_posix()
            edits.append(edit.set_attribute(source, element, "filename", moved))
    return edit.apply(file, edits)


def _list_relative(elements: Iterable[Element]) -> Iterator[tuple[str, Element]]:
    """Yield the relative names of meshes, textures and included files, each with its element."""
    for element in elements:
        name = element.get("filename") or ""
        is_include = element.tag.endswith(":include")
        if (is_include or element.tag in _TAGS) and is_relative(name) and "$" not in name:
            yield name, element
