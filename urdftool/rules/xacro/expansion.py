"""What stops the expansion.

The expansion itself reports these, with the place at which it stopped; the functions are their
pages.
"""

from __future__ import annotations

import os
import re

from ...finding import Finding
from ...source.location import SourceFile
from ..fix import FixContext, Proposal, Span, safe, unsafe, write_inside
from ..rule import BOTH, ERROR, SAFE, UNSAFE, Problem, rule

APPLIES_TO = ()

_NOTHING: tuple[Problem, ...] = ()


@rule(
    ERROR,
    effects={
        "xacro": "stops: the file is not well-formed",
    },
)
def missing_xmlns() -> tuple[Problem, ...]:
    """A file uses ``xacro:`` tags and does not declare the prefix.

    Every file needs ``xmlns:xacro="http://www.ros.org/wiki/xacro"`` on its ``<robot>``, the
    included ones as well: each is parsed on its own. The parser calls it an unbound prefix.
    """
    return _NOTHING


_XMLNS = b' xmlns:xacro="http://www.ros.org/wiki/xacro"'


@missing_xmlns.fix(SAFE, of_file=True)
def declare_xmlns(finding: Finding, context: FixContext) -> Proposal | None:
    """Declare the prefix on the root."""
    file = finding.location.file
    match = re.search(rb"<(?![?!])[^\s/>]+", re.sub(rb"<!--.*?-->", _blank, file.data, flags=16))
    if match is None or b"xmlns:xacro" in file.data or b"<xacro:" not in file.data:
        return None
    return safe("declare xmlns:xacro", Span(file, match.end(), match.end(), _XMLNS))


def _blank(match: re.Match[bytes]) -> bytes:
    return b" " * len(match[0])


@rule(
    ERROR,
    effects={
        "xacro": "stops: unknown macro name",
    },
)
def unknown_macro() -> tuple[Problem, ...]:
    """A macro is called that is not defined.

    Its name is misspelled, its file is not included, or it is defined further down: xacro works
    from the top to the bottom. Macros of a file included with ``ns`` have that name before theirs.
    """
    return _NOTHING


@unknown_macro.fix(UNSAFE, of_file=True)
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
    end = place.file.tag_end(place.start)
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
    """An expression names something that is not defined.

    What stands in ``${…}`` may name properties defined further up, parameters of the macro, and
    what xacro knows from Python and its ``math``. Arguments are not names: they are ``$(arg …)``.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: undefined substitution argument",
    },
)
def undeclared_arg() -> tuple[Problem, ...]:
    """An argument is used that has no value.

    ``$(arg NAME)`` wants ``<xacro:arg name="NAME" default="…"/>`` before it, in this file or in
    one that includes it, or a value on the command line.
    """
    return _NOTHING


@undeclared_arg.fix(UNSAFE, of_file=True)
def declare_argument(finding: Finding, context: FixContext) -> Proposal | None:
    """Write the suggested argument, or declare it with an empty default, first in the robot."""
    name, place = finding.data["name"], finding.location
    if not re.fullmatch(r"[\w-]+", name) or place.calls or finding.data["given"]:
        return None
    if finding.data["suggestion"]:
        return write_inside(finding, name, finding.data["suggestion"])
    file = place.file
    root = re.search(rb"<robot\b", re.sub(rb"<!--.*?-->", _blank, file.data, flags=16))
    if root is None:
        return None
    at = file.tag_end(root.start())
    if root.start() <= place.start < at:  # its attributes are expanded before what is in it
        return None
    following = re.match(rb"\s*?(\r?\n[ \t]*)(?=\S)", file.data[at:])
    indent = following[1] if following else b""
    line = indent + f'<xacro:arg name="{name}" default=""/>'.encode()
    return unsafe("declare it with an empty default", Span(file, at, at, line))


@rule(
    ERROR,
    effects={
        "xacro": "stops: no such file",
    },
)
def include_not_found() -> tuple[Problem, ...]:
    """An included file is not there.

    The path is wrong or the file has another name. A relative path is relative to the file with
    the include. With ``optional="true"`` xacro passes over it.
    """
    return _NOTHING


@include_not_found.fix(BOTH, of_file=True)
def write_suggested_file(finding: Finding, context: FixContext) -> Proposal | None:
    """Write the suggested file; safe where only the case differs."""
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
    """A macro is called with other arguments than it takes.

    One without a default is missing, one that it does not have is given, or there are too few or
    too many elements inside the call for its ``*block`` parameters.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: circular variable definition",
    },
)
def circular_property() -> tuple[Problem, ...]:
    """Properties are defined by one another in a circle.

    A property is evaluated when it is first used, and its value must not need the property itself.
    ``lazy_eval="false"`` evaluates it where it stands, so that ``x`` may be the old ``x`` plus
    one.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops at Python's limit of nested calls, or does not end",
    },
)
def endless_expansion() -> tuple[Problem, ...]:
    """The expansion has no end.

    A macro calls itself, a file includes itself, or each call makes several more. xacro goes on
    until Python's stack or the memory is used up; a recursion wants an ``<xacro:if>`` that ends
    it.
    """
    return _NOTHING


@rule(
    ERROR,
    effects={
        "xacro": "stops: conditional evaluated to something that is not a boolean expression",
    },
)
def non_boolean_conditional() -> tuple[Problem, ...]:
    """A condition is neither true nor false.

    ``<xacro:if>`` and ``<xacro:unless>`` take ``true``, ``false``, ``1`` and ``0``, or an
    expression that gives one. A comparison is such an expression only inside ``${…}``: ``$(arg
    kind) == arm`` is text.
    """
    return _NOTHING


_TRUTHS = {"yes": "true", "on": "true", "no": "false", "off": "false"}
_COMPARED = re.compile(r"(\$\(arg [\w-]+\))\s*(==|!=)\s*(['\"]?)([\w.-]+)\3")


@non_boolean_conditional.fix(UNSAFE, of_file=True)
def write_boolean(finding: Finding, context: FixContext) -> Proposal | None:
    """Write ``true`` for ``yes``, ``false`` for ``no``, and a comparison as an expression."""
    place = finding.location
    start = _tag(place.file, place.start)
    span = place.file.attribute_spans(start).get("value")
    if span is None:
        return None
    text = place.file.data[span[0] : span[1]].decode(place.file.encoding, "replace")
    value = text.partition("=")[2].strip(" \t\r\n\"'")
    new = _TRUTHS.get(value.strip().lower()) or _comparison(value, text[-1:])
    if not new:
        return None
    begin = span[0] + text.rfind(value)
    return unsafe(f"write {new}", Span(place.file, begin, begin + len(value), new.encode()))


def _comparison(value: str, quote: str) -> str:
    """A comparison of an argument with a word, as an expression; empty where it is none."""
    match = _COMPARED.fullmatch(value.strip())
    if match is None:
        return ""
    q = "'" if quote == '"' else '"'
    return f"${{{q}{match[1]}{q} {match[2]} {q}{match[4]}{q}}}"


def _tag(file: SourceFile, at: int) -> int:
    """Byte of the ``<`` of the tag that a place is in."""
    return at if file.data[at : at + 1] == b"<" else file.data.rfind(b"<", 0, at)


@rule(
    ERROR,
    effects={
        "xacro": "stops",
    },
)
def expansion_failed() -> tuple[Problem, ...]:
    """The expansion stopped for another reason.

    An expression that Python refuses, a YAML file that is not YAML, a tag without an attribute it
    needs, a substitution that there is not. The message is xacro's, with the place.
    """
    return _NOTHING
