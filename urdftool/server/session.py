"""What the checking process knows: open documents, robots of the workspace, their last checks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ..fmt.run import format_file
from ..model.elements import Joint, Link, Robot
from ..source.document import Document, Element
from .actions import list_actions, list_safe_edits
from .around import YAML
from .checks import Checks
from .completion import list_completions
from .edits import make_edit
from .hover import describe_position
from .knowledge import Knowledge, make_path
from .navigation import list_definitions, list_references
from .rename import prepare_rename, rename

_MOST_SYMBOLS = 5000
"""Symbols of one document; chosen: editors freeze with tens of thousands (vscode-yaml#485)."""

_CLASS, _FUNCTION, _VARIABLE, _EVENT = 5, 12, 13, 24  # SymbolKind; source: the protocol, 3.17
_KINDS = {
    "link": _CLASS,
    "joint": _EVENT,
    "xacro:macro": _FUNCTION,
    "xacro:property": _VARIABLE,
    "xacro:arg": _VARIABLE,
}


def _list_symbols(knowledge: Knowledge, params: dict[str, Any]) -> list[dict[str, Any]]:
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
        if name in self.seen or len(self.seen) >= _MOST_SYMBOLS:
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
    while todo and count < _MOST_SYMBOLS:
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


def _format_document(knowledge: Knowledge, params: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the edits that format a document; none if it has its layout, or is YAML.

    Raises:
        SourceError: It is not well-formed.
    """
    if params["path"].endswith(YAML):
        return []
    file = knowledge.read(params["path"])
    done = format_file(file)
    return [make_edit(knowledge, file, done.after)] if done.is_changed else []


Emit = Callable[[Any], None]
Question = Callable[[Knowledge, dict[str, Any]], Any]

_QUESTIONS: dict[str, Question] = {
    "actions": list_actions,
    "completion": list_completions,
    "definition": list_definitions,
    "fix-all": list_safe_edits,
    "format": _format_document,
    "hover": describe_position,
    "prepare-rename": prepare_rename,
    "references": list_references,
    "rename": rename,
    "symbols": _list_symbols,
}


class Session:
    """Answers to the messages of the protocol process."""

    def __init__(self) -> None:
        """Create a session without documents."""
        self.knowledge = Knowledge()
        self.knowledge.read_robots = self._read_robots

    def set_document(self, path: str, text: str | None) -> None:
        """Store the text of an open document; None for one that was closed."""
        self.knowledge.set_document(path, text)

    def compute_answer(
        self, method: str, params: dict[str, Any], emit: Emit, poll: Callable[[], None]
    ) -> Any:
        """Return the answer to a message, as JSON.

        Raises:
            UrdftoolError: It cannot be answered.
        """
        if method == "configure":
            return self.knowledge.configure(**params)
        if method == "refresh":
            return self.knowledge.refresh()
        if method == "check":
            return Checks(self.knowledge, emit, poll).check(params["paths"])
        self._read_robots(params["path"])
        return _QUESTIONS[method](self.knowledge, params)

    def prepare(self) -> None:
        """Prepare the next check, while there is nothing to answer."""
        self.knowledge.expansion_server.prepare()

    def _read_robots(self, path: str) -> None:
        """Read the robots of a file again, if no check has read them as they are."""
        states = self.knowledge.list_states(path)
        if not states or any(one.version != self.knowledge.version for one in states):
            Checks(self.knowledge, lambda part: None, lambda: None).read(path)
