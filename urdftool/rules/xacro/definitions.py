"""Find the definitions in xacro files."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from ...errors import SourceError
from ...source.description import Description
from ...source.document import Document, Element, parse
from ...source.location import SourceFile


@dataclass
class Definitions:
    """All definitions in the files of a description, unexpanded."""

    documents: list[Document] = field(default_factory=list)
    macros: dict[str, list[Element]] = field(default_factory=dict)
    properties: dict[str, list[Element]] = field(default_factory=dict)
    arguments: dict[str, list[Element]] = field(default_factory=dict)


def get_definitions(description: Description) -> Definitions:
    """Get the definitions in a description's files, read once for all rules."""
    return description.memo.get("definitions", lambda: _collect_definitions(description))


def _collect_definitions(description: Description) -> Definitions:
    found = Definitions()
    for document in _parse_documents(description):
        found.documents.append(document)
        for element in document.root.walk():
            kinds = {
                "xacro:macro": found.macros,
                "xacro:property": found.properties,
                "xacro:arg": found.arguments,
            }
            table = kinds.get(element.tag)
            if table is not None and "name" in element.attributes:
                table.setdefault(element.attributes["name"], []).append(element)
    return found


def _parse_documents(description: Description) -> Iterator[Document]:
    for file in description.files:
        try:
            yield parse(file)
        except SourceError:
            continue


_NAME = re.compile(rb"<xacro:(macro|arg)\b[^<>]*?\bname\s*=\s*[\"']([^\"']+)[\"']")


def get_names(description: Description, file: SourceFile) -> list[tuple[str, str]]:
    """Find kind and name of each macro and argument in a file, without parsing it."""
    return description.memo.get(("names", file), lambda: _find_names(file))


def _find_names(file: SourceFile) -> list[tuple[str, str]]:
    return [
        (match[1].decode("ascii"), match[2].decode(file.encoding, "replace"))
        for match in _NAME.finditer(file.data)
    ]


def get_macro_names(description: Description) -> frozenset[str]:
    """Get the names of the macros that a description's files define, found once for all rules."""
    return description.memo.get("macro names", lambda: _find_macro_names(description))


def _find_macro_names(description: Description) -> frozenset[str]:
    return frozenset(
        name
        for file in description.files
        for kind, name in get_names(description, file)
        if kind == "macro"
    )
