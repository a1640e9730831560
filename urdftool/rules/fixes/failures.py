"""Fixes of what keeps a file from being read or expanded: from the finding and the bytes alone."""

from __future__ import annotations

import os
import re

from ...finding import Finding
from ...source.location import SourceFile
from .proposal import FixContext, Proposal, Span, safe, unsafe

_XMLNS = b' xmlns:xacro="http://www.ros.org/wiki/xacro"'
_MEANT = re.compile(r"did you mean '([^']*)'\?")


def not_well_formed(finding: Finding, context: FixContext) -> Proposal | None:
    """``- -`` for ``--`` in comments, all of them."""
    if "holds '--'" not in finding.message:
        return None
    file = finding.place.file
    spans = []
    for match in re.finditer(rb"<!--(.*?)-->", file.data, re.DOTALL):
        inner = match[1]
        new = re.sub(rb"-(?=-)", b"- ", inner)
        new = new + b" " if new.endswith(b"-") else new
        if new != inner:
            spans.append(Span(file, match.start(1), match.end(1), new))
    return safe("write '- -' in comments", *spans) if spans else None


def content_before_declaration(finding: Finding, context: FixContext) -> Proposal | None:
    """The declaration first."""
    file = finding.place.file
    match = re.search(rb"<\?xml[^>]*?\?>", file.data)
    if match is None or file.data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return None
    begin = 3 if file.data.startswith(b"\xef\xbb\xbf") else 0
    before = file.data[begin : match.start()]
    if not before.strip():
        return safe("take away what stands before it", Span(file, begin, match.start(), b""))
    rest = re.match(rb"[ \t]*\r?\n", file.data[match.end() :])
    end = match.end() + (rest.end() if rest else 0)
    line_end = b"\r\n" if b"\r\n" in file.data else b"\n"
    if not file.data[: match.start()].endswith(b"\n"):
        end = match.end()
    return safe(
        "move it to the start of the file",
        Span(file, begin, begin, match[0] + line_end),
        Span(file, match.start(), end, b""),
    )


def missing_xmlns(finding: Finding, context: FixContext) -> Proposal | None:
    """The declaration, on the root."""
    file = finding.place.file
    match = re.search(rb"<(?![?!])[^\s/>]+", re.sub(rb"<!--.*?-->", _blank, file.data, flags=16))
    if match is None or b"xmlns:xacro" in file.data or b"<xacro:" not in file.data:
        return None
    return safe("declare xmlns:xacro", Span(file, match.end(), match.end(), _XMLNS))


def _blank(match: re.Match[bytes]) -> bytes:
    return b" " * len(match[0])


def unknown_macro(finding: Finding, context: FixContext) -> Proposal | None:
    """The macro that was meant."""
    match = re.search(r"unknown macro '([^']+)'; did you mean '([^']+)'\?", finding.message)
    place = finding.place
    if match is None:
        return None
    old, new = (f"xacro:{name}".encode() for name in match.groups())
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
    return unsafe(f"call '{match[2]}'", *spans)


def undeclared_arg(finding: Finding, context: FixContext) -> Proposal | None:
    """The one that was meant; else declared, with an empty default, first in the robot."""
    meant = _MEANT.search(finding.message)
    match = re.search(r"the argument '([\w-]+)' has no value", finding.message)
    place = finding.place
    if match is None or place.calls or "was it meant by" in finding.message:
        return None
    if meant is not None:
        return _in_value(finding, match[1], meant[1], False)
    file = place.file
    root = re.search(rb"<robot\b", re.sub(rb"<!--.*?-->", _blank, file.data, flags=16))
    if root is None:
        return None
    at = file.tag_end(root.start())
    if root.start() <= place.start < at:  # its attributes are expanded before what is in it
        return None
    following = re.match(rb"\s*?(\r?\n[ \t]*)(?=\S)", file.data[at:])
    indent = following[1] if following else b""
    line = indent + f'<xacro:arg name="{match[1]}" default=""/>'.encode()
    return unsafe("declare it with an empty default", Span(file, at, at, line))


def include_not_found(finding: Finding, context: FixContext) -> Proposal | None:
    """The file that was meant; safely, where only capitals differ."""
    match = _MEANT.search(finding.message)
    missing = finding.message.partition(": ")[0]
    wrong = os.path.basename(missing)
    if match is None:
        return None
    return _in_value(finding, wrong, match[1], wrong.casefold() == match[1].casefold())


def _in_value(finding: Finding, old: str, new: str, harmless: bool) -> Proposal | None:
    place, file = finding.place, finding.place.file
    written = file.data[place.start : place.end]
    at = written.rfind(old.encode())
    if at < 0 or written.count(old.encode()) != 1:
        return None
    start = place.start + at
    span = Span(file, start, start + len(old.encode()), new.encode())
    return safe(f"write {new}", span) if harmless else unsafe(f"write {new}", span)


_TRUTHS = {"yes": "true", "on": "true", "no": "false", "off": "false"}


def non_boolean_conditional(finding: Finding, context: FixContext) -> Proposal | None:
    """``true`` for ``yes``, ``false`` for ``no``; a comparison as an expression."""
    place = finding.place
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


_COMPARED = re.compile(r"(\$\(arg [\w-]+\))\s*(==|!=)\s*(['\"]?)([\w.-]+)\3")


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


def unknown_rule(finding: Finding, context: FixContext) -> Proposal | None:
    """The rule that was meant."""
    match = re.search(r"no rule is called '([^']+)'; did you mean '?([\w*-]+)'?", finding.message)
    if match is None:
        return None
    return _in_value(finding, match[1], match[2], False)


def unused_suppression(finding: Finding, context: FixContext) -> Proposal | None:
    """Gone, with its line where nothing else stands on it."""
    place, data = finding.place, finding.place.file.data
    start, end = place.start, place.end
    begin = data.rfind(b"\n", 0, start) + 1
    rest = re.compile(rb"[ \t]*\r?\n").match(data, end)
    if not data[begin:start].strip() and rest is not None:
        start, end = begin, rest.end()
    else:
        while data[start - 1 : start] in (b" ", b"\t"):
            start -= 1
    return safe("take it away", Span(place.file, start, end, b""))
