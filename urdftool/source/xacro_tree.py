"""Tree on which xacro works: the DOM subset that it uses, with locations.

xacro expands a DOM by moving and cloning nodes. These nodes support that, record their source
(``file``, ``start``) and calls (``calls``), and are copied several times faster than those of
``xml.dom.minidom``. xacro requires the names of the DOM.
"""

# ruff: noqa: N802, N815 -- the DOM's names

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from .location import Call, Place, SourceFile

ELEMENT, TEXT, CDATA, INSTRUCTION, COMMENT, DOCUMENT = 1, 3, 4, 7, 8, 9
"""Types of nodes, by the specification of the DOM."""


class Node:
    """Node of the tree."""

    __slots__ = ("nextSibling", "parentNode", "previousSibling")
    nodeType = 0

    def __init__(self) -> None:
        """Create a node without a parent."""
        self.parentNode: Parent | None = None
        self.previousSibling: Node | None = None
        self.nextSibling: Node | None = None

    def copy(self, calls: tuple[Call, ...] | None) -> Node:
        """Return a copy; its ``calls`` are replaced if given."""
        raise NotImplementedError


class Characters(Node):
    """Text, CDATA section, comment or processing instruction."""

    __slots__ = ("data", "nodeType")

    def __init__(self, data: str, kind: int = TEXT) -> None:
        """Create a node of text and node type."""
        self.parentNode = None
        self.previousSibling = None
        self.nextSibling = None
        self.data = data
        self.nodeType = kind

    def copy(self, calls: tuple[Call, ...] | None) -> Characters:
        """Return a copy; see :meth:`Node.copy`."""
        return Characters(self.data, self.nodeType)


class Parent(Node):
    """Node with children in a linked list, for fast insertion and removal."""

    __slots__ = ("firstChild", "lastChild")

    def __init__(self) -> None:
        """Create a node without children."""
        super().__init__()
        self.firstChild: Node | None = None
        self.lastChild: Node | None = None

    @property
    def childNodes(self) -> Iterator[Node]:
        """Yield the children, in order."""
        child = self.firstChild
        while child is not None:
            yield child
            child = child.nextSibling

    def appendChild(self, node: Node) -> None:
        """Append a node that has no parent."""
        node.parentNode = self
        last = node.previousSibling = self.lastChild
        if last is None:
            self.firstChild = node
        else:
            last.nextSibling = node
        self.lastChild = node

    def insertBefore(self, node: Node, reference: Node | None) -> None:
        """Move a node before a child, or to the end if ``reference`` is None."""
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
        """Remove a child from the tree."""
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
    """Attributes by name; ``items`` returns a list, since xacro modifies them while iterating.

    Attributes:
        only_computed: Whether the next ``items`` are only those that xacro changes when it
            evaluates an element: with an expression, or of xacro itself.
    """

    __slots__ = ("only_computed",)

    def items(self) -> list[tuple[str, str]]:  # type: ignore[override]
        """Return a copy of names and values."""
        if getattr(self, "only_computed", False):  # not set before an evaluation
            self.only_computed = False
            pairs = dict.items(self)
            return [pair for pair in pairs if "$" in pair[1] or pair[0].startswith("xacro:")]
        return list(dict.items(self))


class XacroElement(Parent):
    """Element with its location.

    Attributes:
        plain: Number of elements of a tree in which xacro changes nothing, this one included; 0 of
            other elements.
        definition_of: Expansion whose current calls a copy of this element records; set on the
            definition of a macro, whose copies are instances of the macro.
    """

    __slots__ = (
        "attributes",
        "calls",
        "definition_of",
        "file",
        "nodeName",
        "plain",
        "start",
        "tagName",
    )
    nodeType = ELEMENT

    def __init__(
        self,
        tag: str,
        attributes: Attributes,
        file: SourceFile,
        start: int,
        calls: tuple[Call, ...],
        plain: int = 0,
    ) -> None:
        """Create an element without children."""
        self.plain = plain
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
        """Return the name, as ``Element.tag``."""
        return self.tagName

    @property
    def place(self) -> Place:
        """Return the span of the start tag."""
        return Place(self.file, self.start, self.file.find_tag_end(self.start), self.calls)

    def hasAttribute(self, name: str) -> bool:
        """Tell whether an attribute exists."""
        return name in self.attributes

    def getAttribute(self, name: str) -> str:
        """Return the value of an attribute; empty if absent."""
        return self.attributes.get(name, "")

    def getAttributeNode(self, name: str) -> _Value | None:
        """Return an object with the ``value`` of an attribute; None if absent."""
        value = self.attributes.get(name)
        return None if value is None else _Value(value)

    def setAttribute(self, name: object, value: object) -> None:
        """Set an attribute; its name may be the value of an expression."""
        self.attributes[str(name)] = str(value)

    def removeAttribute(self, name: str) -> None:
        """Remove an attribute if it exists; xacro ignores the DOM's exception for others."""
        self.attributes.pop(name, None)

    def cloneNode(self, deep: bool = True) -> XacroElement:
        """Return a deep copy; a copy of the definition of a macro is an instance of the macro."""
        instances = self.definition_of
        return self.copy(None if instances is None else instances.calls)

    def copy(self, calls: tuple[Call, ...] | None) -> XacroElement:
        """Return a deep copy; see :meth:`Node.copy`."""
        twin = XacroElement(
            self.tagName,
            Attributes(self.attributes),
            self.file,
            self.start,
            self.calls if calls is None else calls,
            self.plain,
        )
        child = self.firstChild
        while child is not None:
            twin.appendChild(child.copy(calls))
            child = child.nextSibling
        return twin


class Instances:
    """Current calls, which copies of macro definitions record."""

    calls: tuple[Call, ...] = ()


class XacroDocument(Parent):
    """Tree of a file.

    Attributes:
        documentElement: Its root element.
        elements: Its elements as parsed.
    """

    __slots__ = ("documentElement", "elements")
    nodeType = DOCUMENT

    documentElement: XacroElement

    def __init__(self) -> None:
        """Create a document without a root element."""
        super().__init__()
        self.elements: list[XacroElement] = []
