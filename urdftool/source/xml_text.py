"""Check that an expanded tree can be written as XML.

Expressions can compute characters that XML does not allow, and names of elements and attributes.
"""

from __future__ import annotations

import re
from xml.parsers import expat

from ..control_characters import escape_controls
from ..errors import XacroError
from .xacro_tree import CDATA, COMMENT, INSTRUCTION, Characters, XacroDocument, XacroElement

_FORBIDDEN = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_IN_NAME = re.compile(r"[\s<>/=&'\"?!]")
_ENDS = {COMMENT: "--", CDATA: "]]>", INSTRUCTION: "?>"}
_LONGEST = 60  # characters of a name in a message


def check_writable(document: XacroDocument) -> None:
    """Check that a tree, written as XML, is read again as the same tree.

    Raises:
        XacroError: A value has a character that XML does not allow, a comment contains ``--``, or a
            name is not a name of XML or has an undeclared prefix; with the place of the element.
    """
    known: set[str] = set()
    for node in document.childNodes:
        if isinstance(node, Characters):
            _check_text(node, document.documentElement)
    todo: list[tuple[XacroElement, frozenset[str]]] = [(document.documentElement, _PREFIXES)]
    while todo:
        element, prefixes = todo.pop()
        attributes = element.attributes
        text = "".join(attributes.values())
        if not text.isprintable() and (found := _FORBIDDEN.search(text)):
            name = next(name for name, value in attributes.items() if found[0] in value)
            raise _make_error(f"attribute '{name}' has", found[0], element)
        prefixes = _declare(element, prefixes)
        for name in (element.tagName, *attributes):
            if name not in known:
                _check_name(name, element)
                known.add(name)
            if ":" in name and name.partition(":")[0] not in prefixes:
                raise XacroError(
                    f"the namespace prefix of '{escape_controls(name)}' is not declared; add "
                    'xmlns:PREFIX="…" to <robot>',
                    at=element.place,
                    rule="expansion-failed",
                )
        for child in element.childNodes:
            if isinstance(child, XacroElement):
                todo.append((child, prefixes))
            elif isinstance(child, Characters):
                _check_text(child, element)


_PREFIXES = frozenset(("xml", "xmlns"))


def _declare(element: XacroElement, prefixes: frozenset[str]) -> frozenset[str]:
    """Return the prefixes in an element: those around it, and those that it declares."""
    declared = [name for name in element.attributes if name.startswith("xmlns")]
    for name in declared:
        prefix, uri = name[6:], element.attributes[name]
        if (prefix and not uri) or prefix in _PREFIXES or uri in _RESERVED or " " in uri:
            raise XacroError(
                f'{escape_controls(name)}="{escape_controls(uri)}" is not a valid declaration of a '
                "namespace; use another prefix and address",
                at=element.place,
                rule="expansion-failed",
            )
    return prefixes.union(name[6:] for name in declared) if declared else prefixes


_RESERVED = ("http://www.w3.org/XML/1998/namespace", "http://www.w3.org/2000/xmlns/")


def _check_text(node: Characters, parent: XacroElement) -> None:
    """Check a text, CDATA section, comment or processing instruction."""
    data = node.data
    if not data.isprintable() and (found := _FORBIDDEN.search(data)):
        raise _make_error("the text has", found[0], parent)
    end = _ENDS.get(node.nodeType)
    if end is None:
        return
    kind = "comment" if node.nodeType == COMMENT else "section"
    if end in data or (node.nodeType == COMMENT and data.endswith("-")):
        raise _make_error(f"a {kind} has", end, parent)
    if "\r" in data:  # cannot be escaped there, and is read as a line feed
        raise _make_error(f"a {kind} has", "\r", parent)


def _check_name(name: str, element: XacroElement) -> None:
    """Check a name, with the parser that reads descriptions."""
    if not _NOT_IN_NAME.search(name) and re.fullmatch("[^:]+(:[^:]+)?", name):
        parser = expat.ParserCreate()
        try:
            parser.Parse(f"<{name}/>", True)
        except (expat.ExpatError, ValueError):
            pass
        else:
            return
    raise XacroError(
        f"'{escape_controls(name[:_LONGEST])}' is not a name of an XML element or attribute; "
        "use letters, digits, '_', '-' and '.'",
        at=element.place,
        rule="expansion-failed",
    )


def _make_error(what: str, character: str, element: XacroElement) -> XacroError:
    return XacroError(
        f"{what} '{escape_controls(character)}', which XML does not allow there; "
        "remove it from the expression",
        at=element.place,
        rule="expansion-failed",
    )
