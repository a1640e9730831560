"""The tree that xacro works on: the part of the DOM it uses, with the place of each element.

xacro expands a DOM by moving and cloning nodes. These nodes do just that, carry where they were
written (``file``, ``start``) and which calls they came through (``calls``), and are copied several
times faster than those of ``xml.dom.minidom``. Names follow the DOM because xacro calls them.
"""

# ruff: noqa: N802, N815 -- the DOM's names

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple
from xml.dom import NotFoundErr

from .location import Call, Place, SourceFile

ELEMENT, TEXT, CDATA, INSTRUCTION, COMMENT, DOCUMENT = 1, 3, 4, 7, 8, 9


class Node:
    """Anything in the tree."""

    __slots__ = ("nextSibling", "parentNode", "previousSibling")
    nodeType = 0

    def __init__(self) -> None:
        """Make a node that is in no tree."""
        self.parentNode: Parent | None = None
        self.previousSibling: Node | None = None
        self.nextSibling: Node | None = None

    def copy(self, calls: tuple[Call, ...] | None) -> Node:
        """A copy; with ``calls``, one that came through those calls."""
        raise NotImplementedError


class Characters(Node):
    """Text, a CDATA section, a comment or a processing instruction."""

    __slots__ = ("data", "nodeType")

    def __init__(self, data: str, kind: int = TEXT) -> None:
        """Make it of text and node type."""
        self.parentNode = None
        self.previousSibling = None
        self.nextSibling = None
        self.data = data
        self.nodeType = kind

    def copy(self, calls: tuple[Call, ...] | None) -> Characters:
        """As :meth:`Node.copy`."""
        return Characters(self.data, self.nodeType)


class Parent(Node):
    """A node with children, kept as a linked list: xacro inserts and removes all the time."""

    __slots__ = ("firstChild", "lastChild")

    def __init__(self) -> None:
        """Make it without children."""
        super().__init__()
        self.firstChild: Node | None = None
        self.lastChild: Node | None = None

    @property
    def childNodes(self) -> Iterator[Node]:
        """The children, in order."""
        child = self.firstChild
        while child is not None:
            yield child
            child = child.nextSibling

    def appendChild(self, node: Node) -> None:
        """Add a node that is in no tree as the last child."""
        node.parentNode = self
        last = node.previousSibling = self.lastChild
        if last is None:
            self.firstChild = node
        else:
            last.nextSibling = node
        self.lastChild = node

    def insertBefore(self, node: Node, reference: Node | None) -> None:
        """Move a node in front of a child, or to the end."""
        if node.parentNode is not None:
            node.parentNode.removeChild(node)
        if reference is None:
            self.appendChild(node)
            return
        node.parentNode = self
        node.nextSibling = reference
        before = node.previousSibling = reference.previousSibling
        reference.previousSibling = node
        if before is None:
            self.firstChild = node
        else:
            before.nextSibling = node

    def removeChild(self, node: Node) -> None:
        """Take a child out of the tree."""
        before, after = node.previousSibling, node.nextSibling
        if before is None:
            self.firstChild = after
        else:
            before.nextSibling = after
        if after is None:
            self.lastChild = before
        else:
            after.previousSibling = before
        node.parentNode = node.previousSibling = node.nextSibling = None


class _Value(NamedTuple):
    value: str


class Attributes(dict[str, str]):
    """Attributes by name; ``items`` is a list, since xacro changes them while it goes through."""

    __slots__ = ()

    def items(self) -> list[tuple[str, str]]:  # type: ignore[override]
        """Names and values, as they are now."""
        return list(dict.items(self))


class XacroElement(Parent):
    """An element, with its place.

    Attributes:
        definition_of: The expansion whose calls a copy of this element takes; set on a macro's
            definition, whose copies are the macro's instances.
    """

    __slots__ = ("attributes", "calls", "definition_of", "file", "nodeName", "start", "tagName")
    nodeType = ELEMENT

    def __init__(
        self,
        tag: str,
        attributes: Attributes,
        file: SourceFile,
        start: int,
        calls: tuple[Call, ...],
    ) -> None:
        """Make it without children."""
        self.parentNode = None
        self.previousSibling = None
        self.nextSibling = None
        self.firstChild = None
        self.lastChild = None
        self.tagName = self.nodeName = tag
        self.attributes = attributes
        self.file = file
        self.start = start
        self.calls = calls
        self.definition_of: Instances | None = None

    @property
    def tag(self) -> str:
        """Its name, as elements of a document call it."""
        return self.tagName

    @property
    def place(self) -> Place:
        """The span of its start tag."""
        return Place(self.file, self.start, self.file.tag_end(self.start), self.calls)

    def hasAttribute(self, name: str) -> bool:
        """Whether there is an attribute of that name."""
        return name in self.attributes

    def getAttribute(self, name: str) -> str:
        """The value of an attribute; empty where there is none."""
        return self.attributes.get(name, "")

    def getAttributeNode(self, name: str) -> _Value | None:
        """The attribute as something with a ``value``; None where there is none."""
        value = self.attributes.get(name)
        return None if value is None else _Value(value)

    def setAttribute(self, name: str, value: object) -> None:
        """Set an attribute."""
        self.attributes[name] = str(value)

    def removeAttribute(self, name: str) -> None:
        """Take an attribute away, or raise as the DOM does."""
        if self.attributes.pop(name, None) is None:
            raise NotFoundErr

    def cloneNode(self, deep: bool = True) -> XacroElement:
        """A copy of it and all below; of a macro's definition, an instance of the macro."""
        instances = self.definition_of
        return self.copy(None if instances is None else instances.calls)

    def copy(self, calls: tuple[Call, ...] | None) -> XacroElement:
        """As :meth:`Node.copy`."""
        twin = XacroElement(
            self.tagName,
            Attributes(self.attributes),
            self.file,
            self.start,
            self.calls if calls is None else calls,
        )
        child = self.firstChild
        while child is not None:
            twin.appendChild(child.copy(calls))
            child = child.nextSibling
        return twin


class Instances:
    """What the copies of macro definitions are instances of: the calls under way."""

    calls: tuple[Call, ...] = ()


class XacroDocument(Parent):
    """A file's tree."""

    __slots__ = ("documentElement",)
    nodeType = DOCUMENT

    documentElement: XacroElement
