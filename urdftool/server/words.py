"""Names in the source of descriptions: what each one is, and the bytes that it has."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator
from typing import Literal, NamedTuple

from ..model.urdf_schema import BLOCKS
from ..rules.moveit.semantic import find_references
from ..rules.renaming import list_joint_references, list_link_references
from ..source.document import Document, Element
from ..source.tags import locate_value
from ..source.xacro_names import TAGS

WordKind = Literal[
    "name", "macro", "argument", "package", "file", "link", "joint", "part", "material"
]
"""Property or parameter; macro; argument; package; file; link; joint; link or joint; material."""

XACRO = "xacro:"
BUILT_IN = frozenset(XACRO + tag for tag in TAGS)
"""Elements of xacro that are not calls of macros."""

_FILES = (f"{XACRO}include", "include", "mesh", "texture")
_PIECE = re.compile(rb"\$\$+[{(]|\$\{(?P<expression>[^}]*)\}|\$\((?P<extension>[^)]*)\)")
_EXTENSION = re.compile(rb"\$\(([^)]*)\)")
_NAME = re.compile(
    rb"""'[^']*'|"[^"]*"|(?P<dotted>\.\s*)?(?P<name>[A-Za-z_\x80-\xff][\w\x80-\xff]*)"""
)
_ARGUMENT = re.compile(rb"""\barg\(\s*['"](?P<name>[^'"]+)['"]""")
_WORD = re.compile(rb"[^\s:=^|,]+")
_PARAMETER = re.compile(
    rb"""\s*(?P<name>[^\s:=]+)(?P<default>\s*:?=\s*(?P<forward>\^\|?)?"""
    rb"""(?:\$\{.*?\}|\$\(.*?\)|(?:'.*?'|".*?"|[^\s'"]+)+|))?"""
)
"""One parameter of a macro, as xacro's ``parse_macro_arg`` reads it."""
_COMMENT = re.compile(rb"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)


class Word(NamedTuple):
    """A name in the source.

    Attributes:
        kind: What it names.
        name: The name as written; of a block of a macro without its asterisks.
        start: First byte.
        end: Byte after the last.
        element: Element of the source in which it is.
        attribute: Attribute in whose value it is; empty for a tag or text.
        is_definition: Whether it defines what it names.
        owner: Macro whose parameter it is; namespace of a name with one; else empty.
    """

    kind: WordKind
    name: str
    start: int
    end: int
    element: Element
    attribute: str = ""
    is_definition: bool = False
    owner: str = ""


class WordTable:
    """Names of one document."""

    def __init__(self, document: Document) -> None:
        """Find the names of a document."""
        self._references = _list_references(document.root)
        self.words = [word for element in document.root.walk() for word in self._list(element)]
        self._definitions: dict[int, list[Word]] = {}
        for word in self.words:
            if word.is_definition:
                self._definitions.setdefault(word.element.start, []).append(word)

    def find(self, offset: int) -> Word | None:
        """Return the smallest name that has a byte, or ends before it; None if there is none."""
        found = [word for word in self.words if word.start <= offset <= word.end]
        return min(found, key=lambda word: word.end - word.start, default=None)

    def list_definitions(self, start: int) -> list[Word]:
        """Return the definitions in the tag of an element, by its first byte."""
        return self._definitions.get(start, [])

    def get_kinds(self, element: Element, attribute: str) -> list[WordKind]:
        """Return what a value, or for an empty attribute the text, of an element names."""
        return [
            word.kind
            for word in self.words
            if word.element.start == element.start and word.attribute == attribute
            if attribute or not word.element.children
            if not word.is_definition
        ]

    def _list(self, element: Element) -> Iterator[Word]:
        """Yield the names in the tag and in the text of an element."""
        yield from _list_tag(element)
        data = element.file.data
        for attribute, span in element.file.locate_attributes(element.start).items():
            start, end = locate_value(data, span)
            yield from _list_inner(element, attribute, start, end)
            yield from self._list_attribute(element, attribute, start, end)
        for start, end in list_texts(element):
            yield from _list_inner(element, "", start, end)
            for kind in self._references.get((element.start, ""), ()):
                text = data[start:end]
                left = start + len(text) - len(text.lstrip())
                yield _make(kind, element, left, start + len(text.rstrip()))

    def _list_attribute(
        self, element: Element, attribute: str, start: int, end: int
    ) -> Iterator[Word]:
        """Yield the names that a whole value is, or that it has in its syntax."""
        tag = element.tag
        known = _DEFINITIONS.get((tag, attribute))
        if known is not None:
            yield _make(known, element, start, end, attribute, is_definition=True)
        elif (tag, attribute) == (f"{XACRO}macro", "params"):
            yield from _list_parameters(element, start, end)
        elif (tag, attribute) == (f"{XACRO}insert_block", "name"):
            yield _make("name", element, start, end, attribute)
        elif (tag, attribute) == (f"{XACRO}call", "macro"):
            yield _make("macro", element, start, end, attribute)
        elif attribute in ("filename", "url", "uri") and tag in _FILES:
            yield _make("file", element, start, end, attribute)
        for kind in self._references.get((element.start, attribute), ()):
            defines = attribute == "name" and tag == kind and _defines_name(element)
            yield _make(kind, element, start, end, attribute, is_definition=defines)


_DEFINITIONS: dict[tuple[str, str], WordKind] = {
    (f"{XACRO}macro", "name"): "macro",
    (f"{XACRO}property", "name"): "name",
    (f"{XACRO}arg", "name"): "argument",
    (f"{XACRO}include", "ns"): "name",
}


def _make(
    kind: WordKind,
    element: Element,
    start: int,
    end: int,
    attribute: str = "",
    *,
    is_definition: bool = False,
    owner: str = "",
) -> Word:
    name = element.file.data[start:end].decode(element.file.encoding, "replace")
    return Word(kind, name, start, end, element, attribute, is_definition, owner)


def _list_references(root: Element) -> dict[tuple[int, str], list[WordKind]]:
    """Return what attributes and texts name, by first byte of the element and attribute."""
    links: dict[tuple[int, str], None] = {}
    joints: dict[tuple[int, str], None] = {}
    semantic_links = [(element, at, "") for element, at, _ in find_references(root, "link")]
    semantic_joints = [(element, at, "") for element, at, _ in find_references(root, "joint")]
    for element, attribute, _ in [*list_link_references(root), *semantic_links]:
        links[element.start, attribute] = None
    for element, attribute, _ in [*list_joint_references(root), *semantic_joints]:
        joints[element.start, attribute] = None
    found: dict[tuple[int, str], list[WordKind]] = {}
    for key in {**links, **joints}:
        both = key in links and key in joints
        found[key] = ["part" if both else "link" if key in links else "joint"]
    for element in root.walk():
        inside = element.parent.tag if element.parent is not None else ""
        if element.tag == "material" and inside not in BLOCKS:
            found[element.start, "name"] = ["material"]
    return found


def _defines_name(element: Element) -> bool:
    """Tell whether a link, joint or material is one, instead of naming one.

    Blocks for simulators and groups of an SRDF name those of the robot.
    """
    if element.tag == "material":
        return bool(element.children)
    above = element.parent
    while above is not None:
        if above.tag in (*BLOCKS, "group", "group_state"):
            return False
        above = above.parent
    return True


def _list_tag(element: Element) -> Iterator[Word]:
    """Yield the macro that a tag calls, twice if it has an end tag, and its parameters."""
    tag = element.tag
    if not tag.startswith(XACRO) or tag in BUILT_IN:
        return
    data, length = element.file.data, len(tag.encode("utf-8"))
    first = element.start + 1
    yield _make("macro", element, first + len(XACRO), first + length)
    if element.end > element.file.find_tag_end(element.start):
        close = data.rfind(b"</", 0, element.end) + 2
        yield _make("macro", element, close + len(XACRO), close + length)
    macro = tag.removeprefix(XACRO)
    for name, (start, _) in element.file.locate_attributes(element.start).items():
        if not name.startswith("xmlns"):
            end = start + len(name.encode("utf-8"))
            yield _make("name", element, start, end, name, owner=macro)


def _list_parameters(element: Element, start: int, end: int) -> Iterator[Word]:
    """Yield the parameters that a macro declares, and names that a default forwards."""
    data, position = element.file.data, start
    macro = element.get("name") or ""
    while match := _PARAMETER.match(data, position, end):
        first, last = match.span("name")
        while data[first : first + 1] == b"*":
            first += 1
        yield _make("name", element, first, last, "params", is_definition=True, owner=macro)
        position = match.end()


def _list_inner(element: Element, attribute: str, start: int, end: int) -> Iterator[Word]:
    """Yield the names in ``${…}`` and ``$(…)`` between two bytes."""
    data = element.file.data
    if b"$" not in data[start:end]:
        return
    for piece in _PIECE.finditer(data, start, end):
        if piece["expression"] is not None:
            yield from _list_expression(element, attribute, *piece.span("expression"))
        elif piece["extension"] is not None:
            yield from _list_extension(element, attribute, *piece.span("extension"))


def _list_expression(element: Element, attribute: str, start: int, end: int) -> Iterator[Word]:
    """Yield the names in an expression, and in ``$(…)`` inside of it, which xacro expands first."""
    for match in _EXTENSION.finditer(element.file.data, start, end):
        yield from _list_names(element, attribute, start, match.start())
        yield from _list_extension(element, attribute, *match.span(1))
        start = match.end()
    yield from _list_names(element, attribute, start, end)


def _list_extension(element: Element, attribute: str, start: int, end: int) -> Iterator[Word]:
    """Yield the names in ``$(command …)``."""
    data = element.file.data
    words = list(_WORD.finditer(data, start, end))
    command = words[0][0] if words else b""
    if command in (b"arg", b"find") and len(words) > 1:
        kind: WordKind = "argument" if command == b"arg" else "package"
        yield _make(kind, element, *words[1].span(), attribute)
    elif command == b"eval":
        yield from _list_names(element, attribute, words[0].end(), end, kind="argument")


def _list_names(
    element: Element, attribute: str, start: int, end: int, kind: WordKind = "name"
) -> Iterator[Word]:
    """Yield the names in an expression; of ``a.b`` the second has the first as its owner."""
    data = element.file.data
    for match in _ARGUMENT.finditer(data, start, end):
        yield _make("argument", element, *match.span("name"), attribute)
    before = ""
    for match in _NAME.finditer(data, start, end):
        name = (match["name"] or b"").decode(element.file.encoding, "replace")
        if name and not keyword.iskeyword(name):
            owner = before if match["dotted"] else ""
            yield _make(kind, element, *match.span("name"), attribute, owner=owner)
        before = name


def list_texts(element: Element) -> Iterator[tuple[int, int]]:
    """Yield the spans of text directly in an element, without comments."""
    data, position = element.file.data, element.file.find_tag_end(element.start)
    if element.end <= position:
        return
    close = data.rfind(b"</", position, element.end)
    for begin in [*(child.start for child in element.children), close]:
        for start, end in _split_comments(data, position, begin):
            if data[start:end].strip():
                yield start, end
        child = next((one for one in element.children if one.start == begin), None)
        position = child.end if child is not None else begin


def _split_comments(data: bytes, start: int, end: int) -> Iterator[tuple[int, int]]:
    for match in _COMMENT.finditer(data, start, end):
        yield start, match.start()
        start = match.end()
    yield start, end
