"""Parser for the tree on which xacro works."""

from __future__ import annotations

from xml.parsers import expat

from ..errors import XmlError
from .location import Call, SourceFile
from .well_formed import MAX_DEPTH, run_parser
from .xacro_tree import (
    CDATA,
    COMMENT,
    INSTRUCTION,
    TEXT,
    Attributes,
    Characters,
    Parent,
    XacroDocument,
    XacroElement,
)


def parse_xacro(file: SourceFile, calls: tuple[Call, ...] = ()) -> XacroDocument:
    """Parse a file into the tree on which xacro works.

    Raises:
        XmlError: It is not well-formed, uses an undeclared prefix, declares entities, or is
            nested too deeply.
    """
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.namespace_prefixes = True
    parser.buffer_text = True
    document = XacroDocument()
    stack: list[XacroElement] = []
    sizes: list[int] = []  # XacroElement.plain of each element of the stack, as far as it is known

    def inside() -> Parent:
        return stack[-1] if stack else document

    declared: list[tuple[str, str]] = []
    cdata = False

    def namespace(prefix: str | None, uri: str | None) -> None:
        declared.append((f"xmlns:{prefix}" if prefix else "xmlns", uri or ""))

    def start(tag: str, attributes: dict[str, str]) -> None:
        values = Attributes(declared)
        declared.clear()
        for name, value in attributes.items():
            values[_qualify(name) if " " in name else name] = value
        element = XacroElement(
            _qualify(tag) if " " in tag else tag, values, file, parser.CurrentByteIndex, calls
        )
        if not stack:
            document.documentElement = element
        elif len(stack) > MAX_DEPTH:
            raise XmlError(
                f"elements are nested more than {MAX_DEPTH} deep, the limit of a robot description",
                at=element.place,
            )
        inside().appendChild(element)
        document.elements.append(element)
        stack.append(element)
        sizes.append(0 if _is_computed(element) else 1)

    def end(_: str) -> None:
        size = stack.pop().plain = sizes.pop()
        if sizes:
            sizes[-1] = size and sizes[-1] and size + sizes[-1]

    def characters(text: str) -> None:
        if "$" in text and sizes:
            sizes[-1] = 0
        last = inside().lastChild
        kind = CDATA if cdata else TEXT
        if isinstance(last, Characters) and last.nodeType == kind and not cdata:
            last.data += text
        else:
            inside().appendChild(Characters(text, kind))

    def start_cdata() -> None:
        nonlocal cdata
        cdata = True

    def end_cdata() -> None:
        nonlocal cdata
        cdata = False

    def comment(text: str) -> None:
        if "xacro:" in text and sizes:  # may be about the evaluation of comments
            sizes[-1] = 0
        inside().appendChild(Characters(text, COMMENT))

    def instruction(target: str, text: str) -> None:
        inside().appendChild(Characters(f"{target} {text}", INSTRUCTION))

    parser.StartNamespaceDeclHandler = namespace
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = characters
    parser.StartCdataSectionHandler = start_cdata
    parser.EndCdataSectionHandler = end_cdata
    parser.CommentHandler = comment
    parser.ProcessingInstructionHandler = instruction
    run_parser(parser, file, stack)
    return document


def _is_computed(element: XacroElement) -> bool:
    """Tell whether xacro changes an element or its attributes."""
    return element.tagName.startswith("xacro:") or any(
        "$" in value or name.startswith(("xacro:", "xmlns"))
        for name, value in element.attributes.items()
    )


def take_tree(file: SourceFile, calls: tuple[Call, ...]) -> XacroDocument:
    """Return the tree of a file as :func:`parse_xacro`; one that was parsed before is used up.

    Raises:
        XmlError: See :func:`parse_xacro`.
    """
    document, file.tree = file.tree, None
    if not isinstance(document, XacroDocument):
        return parse_xacro(file, calls)
    for element in document.elements:
        element.calls = calls
    return document


def _qualify(name: str) -> str:
    """Return ``prefix:local`` for expat's ``uri local prefix``."""
    parts = name.split(" ")
    return f"{parts[2]}:{parts[1]}" if len(parts) == 3 else parts[1]
