"""Rule on typos in xacro that no robot expands: branches that are not taken, uncalled macros."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from ...model.elements import JOINT_TYPES
from ...model.urdf_schema import BLOCKS, DIALECT_ATTRIBUTES, VOCABULARY
from ...source.description import Description
from ...source.document import Document, Element
from ...source.location import Place
from ...source.xacro_names import TAGS
from ..rule import ERROR, Problem, rule
from ..xml.vocabulary_table import is_zero_default, suggest_word
from .definitions import get_macro_names

_EXPRESSION = re.compile(r"(?<!\$)(?:\$\$)*\$\{([^}]+)\}")
_NOT_URDF = (*BLOCKS, "xacro:property")
"""Elements whose content is not that of links and joints of URDF, or may be of any of them."""


class _Typo(NamedTuple):
    """A typo: its element and place, and what is wrong."""

    element: Element
    at: Place | Element
    message: str


@rule(
    ERROR,
    effects={
        "xacro": "stops if it expands such an expression or tag; copies the others to the robot",
    },
    evidence="Of 54 typos planted in macro files of nine repositories, 14 were in what none of "
    "their robots expands by default; a later user of the macro or argument meets them.",
)
def unreached_typo(document: Document, description: Description) -> Iterator[Problem]:
    """A part of a xacro file that no robot expands has a typo.

    A robot is checked as it is expanded. Branches that its arguments do not take, macros that it
    does not call and properties that it does not use are checked for typos only: an expression that
    is not Python, a tag of xacro, element, attribute or joint type with a similar name in URDF.
    In a folder, so are the files of robots that could not be expanded.
    """
    if description.expansion is None and description.document.root.tag:
        return  # not xacro
    starts = description.memo.get("reached", lambda: _collect_reached(description))
    reached, macros = starts.get(document.file.path, set()), get_macro_names(description)
    typos = document.memo.get_for(
        _find_typos,
        (reached, macros),
        lambda: [
            typo
            for element in document.elements
            if element.start not in reached
            for typo in _find_typos(element, macros)
        ],
    )
    for typo in typos:
        yield Problem(typo.element, typo.message, at=typo.at)


def _collect_reached(description: Description) -> dict[str, set[int]]:
    """Return the first bytes of the elements of each file that are in the robot."""
    found: dict[str, set[int]] = {}
    for element in description.document.elements:
        found.setdefault(element.file.path, set()).add(element.start)
    return found


def _find_typos(element: Element, macros: frozenset[str]) -> Iterator[_Typo]:
    yield from _find_bad_expressions(element)
    if element.tag.startswith("xacro:"):
        yield from _find_bad_tag(element, macros)
    elif _is_of_urdf(element):
        yield from _find_bad_names(element)


def _find_bad_expressions(element: Element) -> Iterator[_Typo]:
    for name, value in element.attributes.items():
        for message in _describe_bad_expressions(value) if "${" in value else ():
            yield _Typo(element, element.locate_attribute(name), message)
    if "${" in element.text and not element.children:
        for message in _describe_bad_expressions(element.text):
            yield _Typo(element, element, message)


@lru_cache(maxsize=4096)
def _describe_bad_expressions(text: str) -> tuple[str, ...]:
    found = []
    for match in _EXPRESSION.finditer(text):
        if "$(" in match[1]:
            continue  # xacro replaces this before it evaluates the expression
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                ast.parse(match[1].strip(), mode="eval")
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            why = error.msg if isinstance(error, SyntaxError) else "it is too complex"
            shown = match[1] if len(match[1]) <= 40 else f"{match[1][:40]}…"
            found.append(f"${{{shown}}} is not a Python expression: {why}; nothing expands it here")
    return tuple(found)


def _find_bad_tag(element: Element, macros: frozenset[str]) -> Iterator[_Typo]:
    name = element.tag.partition(":")[2]
    word = None if name in macros or name in TAGS else suggest_word(name, TAGS)
    if word is not None and TAGS[word] in element.attributes:
        message = (
            f"<{element.tag}> is neither a tag of xacro nor a macro here; write <xacro:{word}>"
        )
        yield _Typo(element, element, message)


def _is_of_urdf(element: Element) -> bool:
    """Tell whether an element is inside links, joints and tags of xacro only."""
    above = element.parent
    while above is not None:
        if above.tag in _NOT_URDF or not (above.tag in VOCABULARY or above.tag[:6] == "xacro:"):
            return False
        if above.parent is None:
            return above.tag == "robot"
        above = above.parent
    return False


def _find_bad_names(element: Element) -> Iterator[_Typo]:
    parent = _get_urdf_parent(element)
    if element.tag not in VOCABULARY[parent].children:
        word = suggest_word(element.tag, VOCABULARY[parent].children)
        if word is not None and element.tag not in VOCABULARY:
            message = f"<{parent}> has the unknown element <{element.tag}>; write <{word}>"
            yield _Typo(element, element, message)
        return
    names = VOCABULARY[element.tag].attributes
    free = [name for name in names if name not in element.attributes]
    for name in element.attributes.keys() - {*names, *DIALECT_ATTRIBUTES.get(element.tag, ())}:
        word = suggest_word(name, free)
        if word is not None and word != name:
            if is_zero_default(element.tag, word, element.attributes[name]):
                continue
            message = f"<{element.tag}> has the unknown attribute '{name}'; write {word}"
            yield _Typo(element, element.locate_attribute(name), message)
    kind = element.get("type") or ""
    word = None if kind in JOINT_TYPES else suggest_word(kind, JOINT_TYPES)
    if element.tag == "joint" and word is not None and word != kind:
        message = f"<joint> has the unknown type '{kind}'; write {word}"
        yield _Typo(element, element.locate_attribute("type"), message)


def _get_urdf_parent(element: Element) -> str:
    """Return the tag of the nearest element around that is not of xacro."""
    above = element.parent
    while above is not None and above.tag.startswith("xacro:"):
        above = above.parent
    return "robot" if above is None else above.tag
