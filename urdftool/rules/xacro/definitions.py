"""What xacro files define."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ...errors import SourceError
from ...source.description import Description
from ...source.document import Document, Element, parse


@dataclass
class Definitions:
    """All that the files of a description define, unexpanded.

    Attributes:
        documents: The files, parsed; those that are not well-formed are left out.
        macros: The ``<xacro:macro>`` elements by name.
        properties: The ``<xacro:property>`` elements by name.
        arguments: The ``<xacro:arg>`` elements by name.
    """

    documents: list[Document] = field(default_factory=list)
    macros: dict[str, list[Element]] = field(default_factory=dict)
    properties: dict[str, list[Element]] = field(default_factory=dict)
    arguments: dict[str, list[Element]] = field(default_factory=dict)


_last: tuple[Description, Definitions] | None = None


def definitions(description: Description) -> Definitions:
    """What a description's files define; read once, however many rules ask."""
    global _last
    if _last is None or _last[0] is not description:
        found = Definitions()
        for document in _documents(description):
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
        _last = description, found
    return _last[1]


def _documents(description: Description) -> Iterator[Document]:
    for file in description.files:
        try:
            yield parse(file)
        except SourceError:
            continue


def macro_names(description: Description) -> frozenset[str]:
    """Names of the macros that a description's files define."""
    return frozenset(definitions(description).macros)


def is_expanded(description: Description) -> bool:
    """Whether it is xacro and its expansion came to its end."""
    return description.expansion is not None
