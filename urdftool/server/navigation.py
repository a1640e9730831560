"""Definitions and references of the name at a position."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..errors import UrdftoolError
from .around import get_table, is_around
from .knowledge import Knowledge, make_path
from .names import Names, get_names
from .words import Word

Location = dict[str, Any]


def find_word(knowledge: Knowledge, params: dict[str, Any]) -> Word | None:
    """Return the name at the position of a question; None if there is none."""
    table = get_table(knowledge, params["path"])
    return None if table is None else table.find(knowledge.get_offset(params))


def list_definitions(knowledge: Knowledge, params: dict[str, Any]) -> list[Location]:
    """Return the places that define the name at a position, the file that it names, or none."""
    word = find_word(knowledge, params)
    if word is None:
        return []
    names = get_names(knowledge, params["path"])
    if word.kind in ("file", "package"):
        start = {"line": 0, "character": 0}
        span = {"start": start, "end": start}
        return [{"path": path, "range": span} for path in dict.fromkeys(_list_files(names, word))]
    return [locate(knowledge, one) for one in names.find_definitions(word)]


def list_references(knowledge: Knowledge, params: dict[str, Any]) -> list[Location]:
    """Return the places that use what the name at a position names."""
    word = find_word(knowledge, params)
    if word is None:
        return []
    names = get_names(knowledge, params["path"])
    if word.kind in ("link", "joint", "part"):
        names.add_files_around()
    if is_around(params["path"]) and not names.find_definitions(word):
        return []  # another word of the file
    found = names.find_references(word)
    declared = params.get("declaration", True)
    return [locate(knowledge, one) for one in found if declared or not one.is_definition]


def locate(knowledge: Knowledge, word: Word) -> Location:
    """Return the place of a name as a location of the protocol."""
    file = word.element.file
    return {
        "path": make_path(file.path),
        "range": knowledge.make_table(file).get_range(word.start, word.end),
    }


def _list_files(names: Names, word: Word) -> Iterator[str]:
    """Yield the paths that a name of a file or package means."""
    if word.kind == "file":
        yield from names.list_included(word)
    for packages in names.list_packages():
        try:
            if word.kind == "package":
                yield make_path(packages.find(word.name) / "package.xml")
            else:
                yield from (make_path(packages.resolve(value)) for value in names.get_values(word))
        except UrdftoolError:
            continue
