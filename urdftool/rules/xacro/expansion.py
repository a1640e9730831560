"""Rules on errors that stop the expansion.

The expansion reports them, with the place at which it stops; the functions here are their pages.
"""

from __future__ import annotations

import os
import re

from ...finding import Finding
from ...source.comments import blank_comments
from ...source.location import SourceFile
from ..fix import FixContext, Proposal, Span, safe, unsafe, write_inside
from ..rule import BOTH, ERROR, SAFE, UNSAFE, Problem, rule

APPLIES_TO = ()

_NO_PROBLEMS: tuple[Problem, ...] = ()


@rule(
    ERROR,
    effects={
        "xacro": "stops: the file is not well-formed",
    },
)
def missing_xmlns() -> tuple[Problem, ...]:
    """A file uses ``xacro:`` tags but does not declare the prefix.

    Every file, also an included one, needs ``xmlns:xacro="http://www.ros.org/wiki/xacro"`` in its
    ``<robot>``. The XML parser reports an unbound prefix.
    """
    return _NO_PROBLEMS


_XMLNS = b' xmlns:xacro="http://www.ros.org/wiki/xacro"'


@missing_xmlns.fix(SAFE, of_file=True, reveals=True)
def declare_xmlns(finding: Finding, context: FixContext) -> Proposal | None:
    """Declare the prefix in the root element."""
    file = finding.location.file
    match = re.search(rb"<(?![?!])[^\s/>]+", blank_comments(file.data))
    if match is None or b"xmlns:xacro" in file.data or b"<xacro:" not in file.data:
        return None
    return safe("declare xmlns:xacro", Span(file, match.end(), match.end(), _XMLNS))


@rule(
    ERROR,
    effects={
        "xacro": "stops: unknown macro name",
    },
)
def unknown_macro() -> tuple[Problem, ...]:
    """An unknown macro is called.

    Its name is misspelled, its file is not included, or it is defined after the call: xacro
    processes a file from top to bottom. Macros of a file included with ``ns`` have that prefix.
    """
    return _NO_PROBLEMS


@unknown_macro.fix(UNSAFE, of_file=True, reveals=True)
def call_suggested_macro(finding: Finding, context: FixContext) -> Proposal | None:
    """Call the suggested macro."""
    right = finding.data.get("suggestion", "")
    place = finding.location
    if not right:
        return None
    old, new = (f"xacro:{name}".encode() for name in (finding.data["name"], right))
    data = place.file.data
    if not data.startswith(b"<" + old, place.start):
        return None
    spans = [Span(place.file, place.start + 1, place.start + 1 + len(old), new)]
    end = place.file.find_tag_end(place.start)
    if data[end - 2 : end] != b"/>":
        close = data.find(b"</" + old, end)
        if close < 0 or data.find(b"<" + old, end, close) >= 0:
            return None
        spans.append(Span(place.file, close + 2, close + 2 + len(old), new))
    return unsafe(f"call '{right}'", *spans)


@rule(
    ERROR,
    effects={
        "xacro": "stops: name is not defined",
    },
)
def undefined_name() -> tuple[Problem, ...]:
    """An expression contains an undefined name.

    ``${…}`` can contain properties defined above, parameters of the macro, and the Python functions
    of xacro, such as ``math``. Arguments are written as ``$(arg …)``.
    """
    return _NO_PROBLEMS


@rule(
    ERROR,
    effects={
        "xacro": "stops: undefined substitution argument",
    },
)
def undeclared_arg() -> tuple[Problem, ...]:
    """An argument has no value.

    ``$(arg NAME)`` requires ``<xacro:arg name="NAME" default="…"/>`` before it, in this file or in
    one that includes it, or a value on the command line.
    """
    return _NO_PROBLEMS


@undeclared_arg.fix(UNSAFE, of_file=True, reveals=True)
def declare_argument(finding: Finding, context: FixContext) -> Proposal | None:
    """Write the suggested argument, or declare it with an empty default at the start."""
    name, place = finding.data["name"], finding.location
    if not re.fullmatch(r"[\w-]+", name) or place.calls or finding.data["given"]:
        return None
    if finding.data["suggestion"]:
        return write_inside(finding, name, finding.data["suggestion"])
    file = place.file
    root = re.search(rb"<robot\b", blank_comments(file.data))
    if root is None:
        return None
    at = file.find_tag_end(root.start())
    if root.start() <= place.start < at:  # xacro expands the attributes before the children
        return None
    if any(_needs_value(name, one) for one in context.description.files):
        return None
    following = re.match(rb"\s*?(\r?\n[ \t]*)(?=\S)", file.data[at:])
    indent = following[1] if following else b""
    line = indent + f'<xacro:arg name="{name}" default=""/>'.encode()
    return unsafe("declare it with an empty default", Span(file, at, at, line))


def _needs_value(name: str, file: SourceFile) -> bool:
    """Tell whether a file uses an argument where xacro does not accept an empty text.

    These are conditions, which must be boolean, names of files, and expressions.
    """
    text = blank_comments(file.data).decode(file.encoding, "replace")
    word = rf"\$\(arg\s+{re.escape(name)}\s*\)"
    return any(
        re.search(pattern, text) is not None
        for pattern in (
            rf"<xacro:(?:if|unless|include)\b[^<>]*{word}",
            rf"\$\{{[^}}]*{word}",
            rf"\$\(eval[^)]*\b{re.escape(name)}\b",
            rf"<xacro:property\b[^<>]*{word}",
        )
    )


@rule(
    ERROR,
    effects={
        "xacro": "stops: no such file",
    },
)
def include_not_found() -> tuple[Problem, ...]:
    """An included file does not exist.

    The path is wrong, or the file has a different name. A relative path is relative to the file
    with the include. With ``optional="true"`` xacro ignores a missing file.
    """
    return _NO_PROBLEMS


@include_not_found.fix(BOTH, of_file=True, reveals=True)
def write_suggested_file(finding: Finding, context: FixContext) -> Proposal | None:
    """Write the suggested file; safe if only the case differs."""
    right = finding.data.get("suggestion", "")
    wrong = os.path.basename(finding.data.get("file", ""))
    if not right or not wrong:
        return None
    return write_inside(finding, wrong, right, harmless=wrong.casefold() == right.casefold())


@rule(
    ERROR,
    effects={
        "xacro": "stops: invalid or undefined parameters",
    },
)
def macro_arguments_mismatch() -> tuple[Problem, ...]:
    """A macro call does not match the parameters of the macro.

    A parameter without a default is missing, an unknown one is given, or the number of elements in
    the call differs from the number of ``*block`` parameters.
    """
    return _NO_PROBLEMS


@rule(
    ERROR,
    effects={
        "xacro": "stops: circular variable definition",
    },
)
def circular_property() -> tuple[Problem, ...]:
    """Properties depend on each other in a circle.

    xacro evaluates a property at its first use, and its value must not depend on the property
    itself. ``lazy_eval="false"`` evaluates it at its definition, so that ``x`` can be the previous
    ``x`` plus one.
    """
    return _NO_PROBLEMS


@rule(
    ERROR,
    effects={
        "xacro": "stops at Python's limit of nested calls, or does not end",
    },
)
def endless_expansion() -> tuple[Problem, ...]:
    """The expansion does not end.

    A macro calls itself, a file includes itself, or each call creates several others. xacro
    continues until it reaches the recursion limit of Python, or runs out of memory. A recursive
    macro requires an ``<xacro:if>`` that ends it.
    """
    return _NO_PROBLEMS


@rule(
    ERROR,
    effects={
        "xacro": "stops: conditional evaluated to something that is not a boolean expression",
    },
)
def non_boolean_conditional() -> tuple[Problem, ...]:
    """A condition is neither true nor false.

    ``<xacro:if>`` and ``<xacro:unless>`` take ``true``, ``false``, ``1`` and ``0``, or an
    expression with such a value. A comparison must be inside ``${…}``: ``$(arg kind) == arm`` is
    text.
    """
    return _NO_PROBLEMS


_BOOLEANS = {"yes": "true", "on": "true", "no": "false", "off": "false"}
_COMPARED = re.compile(r"(\$\(arg [\w-]+\))\s*(==|!=)\s*(['\"]?)([\w.-]+)\3")


@non_boolean_conditional.fix(UNSAFE, of_file=True, reveals=True)
def write_boolean(finding: Finding, context: FixContext) -> Proposal | None:
    """Write ``true`` for ``yes``, ``false`` for ``no``, and a comparison as an expression."""
    place = finding.location
    start = _find_tag_start(place.file, place.start)
    span = place.file.locate_attributes(start).get("value")
    if span is None:
        return None
    text = place.file.data[span[0] : span[1]].decode(place.file.encoding, "replace")
    value = text.partition("=")[2].strip(" \t\r\n\"'")
    new = _BOOLEANS.get(value.strip().lower()) or _write_comparison(value, text[-1:])
    if not new:
        return None
    begin = span[0] + text.rfind(value)
    return unsafe(f"write {new}", Span(place.file, begin, begin + len(value), new.encode()))


def _write_comparison(value: str, quote: str) -> str:
    """Write a comparison of an argument with a word as an expression; empty if it is none."""
    match = _COMPARED.fullmatch(value.strip())
    if match is None:
        return ""
    q = "'" if quote == '"' else '"'
    return f"${{{q}{match[1]}{q} {match[2]} {q}{match[4]}{q}}}"


def _find_tag_start(file: SourceFile, at: int) -> int:
    """Find the byte of the ``<`` of the tag that contains a place."""
    return at if file.data[at : at + 1] == b"<" else file.data.rfind(b"<", 0, at)


@rule(
    ERROR,
    effects={
        "xacro": "stops with an error",
    },
)
def expansion_failed() -> tuple[Problem, ...]:
    """The expansion stopped for a different reason.

    Examples are an expression that Python rejects, an invalid YAML file, a tag without a required
    attribute, or an unknown substitution. The message is that of xacro, with the place.
    """
    return _NO_PROBLEMS
