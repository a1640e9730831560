"""Outline of a document: links by the kinematic tree, or elements of a file of macros."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..model.elements import Joint, Link, Robot
from ..source.document import Document, Element
from .knowledge import Knowledge, make_path

MOST_SYMBOLS = 5000
"""Symbols of one document; chosen: editors freeze with tens of thousands (vscode-yaml#485)."""

_CLASS, _FUNCTION, _VARIABLE, _EVENT = 5, 12, 13, 24  # SymbolKind; source: the protocol, 3.17
_KINDS = {
    "link": _CLASS,
    "joint": _EVENT,
    "xacro:macro": _FUNCTION,
    "xacro:property": _VARIABLE,
    "xacro:arg": _VARIABLE,
}


def list_symbols(knowledge: Knowledge, params: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the symbols of a document: each link with the links below it, else its elements."""
    path = make_path(params["path"])
    document = knowledge.parse(path)
    if document is None:
        return []
    for description, robot in knowledge.list_descriptions(path):
        if make_path(description.path) == path and robot.links:
            return _Outline(knowledge, document, robot).list_roots()
    return list(_list_elements(knowledge, document))


class _Outline:
    """Symbols of one robot."""

    def __init__(self, knowledge: Knowledge, document: Document, robot: Robot) -> None:
        self.knowledge, self.document, self.robot = knowledge, document, robot
        self.elements = {element.start: element for element in document.root.walk()}
        self.seen: set[str] = set()

    def list_roots(self) -> list[dict[str, Any]]:
        """Return the symbols of the roots, then those of links that no root reaches."""
        tree = self.robot.tree
        names = [link.name for link in tree.roots] + [link.name for link in self.robot.links]
        return [found for name in names if (found := self._make_tree(name)) is not None]

    def _make_tree(self, root: str) -> dict[str, Any] | None:
        """Return the symbol of a link with its children; None if it was listed."""
        if not self._add(root):
            return None
        top = self._make(self.robot.link[root], None)
        todo = [(root, top)]
        while todo:
            name, symbol = todo.pop()
            for joint in self.robot.tree.get_child_joints(name):
                if joint.child in self.robot.link and self._add(joint.child):
                    child = self._make(self.robot.link[joint.child], joint)
                    symbol["children"].append(child)
                    todo.append((joint.child, child))
        return top

    def _add(self, name: str) -> bool:
        if name in self.seen or len(self.seen) >= MOST_SYMBOLS:
            return False
        self.seen.add(name)
        return True

    def _make(self, link: Link, joint: Joint | None) -> dict[str, Any]:
        detail = f"{joint.type} joint {joint.name}" if joint is not None else ""
        element = self._find_element(link)
        return _make_symbol(self.knowledge, element, link.name or "?", detail, _CLASS)

    def _find_element(self, link: Link) -> Element:
        """Return the element of this document that makes a link: itself, or the call."""
        made = link.xml
        file = self.document.file.path
        places = []
        if made is not None:
            places = [(made.file.path, made.start)]
            places += [(call.file.path, call.start) for call in made.calls]
        for path, start in places:
            if make_path(path) == make_path(file) and start in self.elements:
                return self.elements[start]
        return self.document.root


def _make_symbol(
    knowledge: Knowledge, element: Element, name: str, detail: str, kind: int
) -> dict[str, Any]:
    table = knowledge.make_table(element.file)
    whole = table.get_range(element.start, element.end)
    tag = table.get_first_line(element.start, element.file.find_tag_end(element.start))
    return {
        "name": name,
        "detail": detail,
        "kind": kind,
        "range": whole,
        "selectionRange": tag,
        "children": [],
    }


def _list_elements(knowledge: Knowledge, document: Document) -> Iterator[dict[str, Any]]:
    """Yield symbols of links, joints, macros, properties and arguments, in the order of a file."""
    count = 0
    todo: list[tuple[Element, list[dict[str, Any]] | None]] = [(document.root, None)]
    top: list[dict[str, Any]] = []
    while todo and count < MOST_SYMBOLS:
        element, above = todo.pop()
        into = top if above is None else above
        kind, name = _KINDS.get(element.tag), element.get("name")
        if kind is not None and name:
            symbol = _make_symbol(knowledge, element, name, element.tag, kind)
            into.append(symbol)
            into = symbol["children"]
            count += 1
        todo += [(child, into) for child in reversed(element.children)]
    yield from top
