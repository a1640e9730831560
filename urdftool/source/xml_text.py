"""Check that an expanded tree can be written as XML.

Expressions can compute characters that XML does not allow, and names of elements and attributes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from xml.parsers import expat

from ..control_characters import escape_controls
from ..errors import XacroError
from .expansion import ExpandedNode
from .location import Place
from .xacro_tree import CDATA, COMMENT, INSTRUCTION, TEXT

_FORBIDDEN = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_IN_NAME = re.compile(r"[\s<>/=&'\"?!]")
_ENDS = {COMMENT: "--", CDATA: "]]>", INSTRUCTION: "?>"}
_LONGEST = 60  # characters of a name in a message; chosen


def check_writable(nodes: Sequence[ExpandedNode]) -> None:
    """Check that a tree, written as XML, is read again as the same tree.

    Raises:
        XacroError: A value has a character that XML does not allow, a comment contains ``--``, or a
            name is not a name of XML or has an undeclared prefix; with the place of the element.
    """
    elements = [node for node in nodes if isinstance(node[1], str)]
    _check_texts(nodes)
    if not "".join(value for node in elements for value in node[2].values()).isprintable():
        for node in elements:
            _check_values(node)
    known: set[tuple[str, ...]] = set()
    scopes = [(0, _PREFIXES)]
    for node in elements:
        while node[0] <= scopes[-1][0]:  # the element that declares them has ended
            scopes.pop()
        names = node[1], *node[2]
        if names in known:
            continue
        prefixes = _declare(node, scopes[-1][1])
        if prefixes is not scopes[-1][1]:
            scopes.append((node[0], prefixes))
        _check_names(names, prefixes, node)
        if not any(":" in name or name == "xmlns" for name in names):
            known.add(names)  # others depend on the elements around


def _check_texts(nodes: Sequence[ExpandedNode]) -> None:
    """Check the nodes that are not elements."""
    texts = [node for node in nodes if not isinstance(node[1], str)]
    plain = not _FORBIDDEN.search("".join(node[2] for node in texts))
    if plain and all(node[1] == TEXT or _is_plain(node[1], node[2]) for node in texts):
        return
    above: list[ExpandedNode] = []
    for node in nodes:
        del above[node[0] - 1 :]
        if isinstance(node[1], str):
            above.append(node)
        else:
            root = next(one for one in nodes if isinstance(one[1], str))
            _check_text(node[1], node[2], above[-1] if above else root)


def _check_values(node: ExpandedNode) -> None:
    """Check the values of the attributes of an element."""
    for name, value in node[2].items():
        if not value.isprintable() and (found := _FORBIDDEN.search(value)):
            raise _make_error(f"attribute '{name}' has", found[0], node)


def _check_names(names: Iterable[str], prefixes: frozenset[str], node: ExpandedNode) -> None:
    """Check the names of an element and its attributes."""
    for name in names:
        _check_name(name, node)
        if ":" in name and name.partition(":")[0] not in prefixes:
            raise XacroError(
                f"the namespace prefix of '{escape_controls(name)}' is not declared; add "
                'xmlns:PREFIX="…" to <robot>',
                at=_locate(node),
                rule="expansion-failed",
            )


def _locate(node: ExpandedNode) -> Place:
    """Return the span of the start tag of an element."""
    file, start, calls = node[3:]
    return Place(file, start, file.find_tag_end(start), calls)


_PREFIXES = frozenset(("xml", "xmlns"))


def _declare(node: ExpandedNode, prefixes: frozenset[str]) -> frozenset[str]:
    """Return the prefixes in an element: those around it, and those that it declares."""
    attributes: dict[str, str] = node[2]
    declared = [name for name in attributes if name.startswith("xmlns")]
    for name in declared:
        prefix, uri = name[6:], attributes[name]
        if (prefix and not uri) or prefix in _PREFIXES or uri in _RESERVED or " " in uri:
            raise XacroError(
                f'{escape_controls(name)}="{escape_controls(uri)}" is not a valid declaration of a '
                "namespace; use another prefix and address",
                at=_locate(node),
                rule="expansion-failed",
            )
    return prefixes.union(name[6:] for name in declared) if declared else prefixes


_RESERVED = ("http://www.w3.org/XML/1998/namespace", "http://www.w3.org/2000/xmlns/")


def _is_plain(kind: int, data: str) -> bool:
    """Tell whether nothing in a comment, section or instruction can end it or is lost."""
    return _ENDS[kind] not in data and "\r" not in data and not data.endswith("-")


def _check_text(kind: int, data: str, parent: ExpandedNode) -> None:
    """Check a text, CDATA section, comment or processing instruction."""
    if not data.isprintable() and (found := _FORBIDDEN.search(data)):
        raise _make_error("the text has", found[0], parent)
    end = _ENDS.get(kind)
    if end is None:
        return
    what = "comment" if kind == COMMENT else "section"
    if end in data or (kind == COMMENT and data.endswith("-")):
        raise _make_error(f"a {what} has", end, parent)
    if "\r" in data:  # cannot be escaped there, and is read as a line feed
        raise _make_error(f"a {what} has", "\r", parent)


def _check_name(name: str, node: ExpandedNode) -> None:
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
        at=_locate(node),
        rule="expansion-failed",
    )


def _make_error(what: str, character: str, node: ExpandedNode) -> XacroError:
    return XacroError(
        f"{what} '{escape_controls(character)}', which XML does not allow there; "
        "remove it from the expression",
        at=_locate(node),
        rule="expansion-failed",
    )
