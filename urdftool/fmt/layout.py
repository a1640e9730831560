"""Layout of XML: where lines begin, and how far they are indented.

Two spaces an element; attributes keep their order and their lines; tags, comments and texts that
share a line keep sharing it, unless an element that is written in one line is wider than
``WIDTH``. At most one blank line is kept in a row: xacro removes comments before its own tags by
counting line ends, so that one and none are not the same, and two and one are.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import accumulate

INDENT = b"  "
WIDTH = 100
"""Width [bytes] up to which an element stays in one line; chosen, no source."""

_TAGS = ("start", "empty", "end")
_SPACE = b" \t\r\n"


def format_xml(data: bytes) -> bytes:
    """Return well-formed XML with its layout; comments, texts and values are not changed.

    Args:
        data: The bytes, in an encoding in which ASCII has its own bytes. The line ends of the
            result are those of its first line; a byte order mark is kept.
    """
    mark = data[:3] if data.startswith(b"\xef\xbb\xbf") else b""
    body = data[len(mark) :]
    first = body.find(b"\n")
    has_crlf = first > 0 and body[first - 1 : first] == b"\r"
    tokens = _read_tokens(body.replace(b"\r\n", b"\n"))
    text = b"".join(_lay_out(tokens)).strip(_SPACE) + b"\n"
    return mark + (text.replace(b"\n", b"\r\n") if has_crlf else text)


def _lay_out(tokens: list[Token]) -> list[bytes]:
    """Return the pieces of the result."""
    breaks, widths = _sum_up(tokens)
    pieces: list[bytes] = []
    wide: list[bool] = []
    index = 0
    while index < len(tokens):
        token = tokens[index]
        depth = len(wide)
        if token.kind == "blank":
            follower = tokens[index + 1] if index + 1 < len(tokens) else None
            breaks_here = (not wide or wide[-1]) and not _is_trailing(tokens, index)
            pieces.append(_format_blank(token, follower, depth, breaks_here))
        elif token.kind in _TAGS:
            depth -= token.kind == "end"
            pieces.append(_format_tag(token.data, INDENT * (depth + 2)))
        else:
            pieces.append(token.data)
        if token.kind == "start":
            end = token.partner
            if token.is_verbatim:
                pieces += [one.data for one in tokens[index + 1 : end]]
                pieces.append(_format_tag(tokens[end].data, b""))
                index = end
            else:
                is_flat = breaks[end + 1] == breaks[index]
                width = len(INDENT) * depth + widths[end + 1] - widths[index]
                wide.append(is_flat and width > WIDTH)
        elif token.kind == "end":
            wide.pop()
        index += 1
    return pieces


def _sum_up(tokens: list[Token]) -> tuple[list[int], list[int]]:
    """Return the sums of line breaks and of bytes before each token and at the end."""
    widths = [
        len(_format_tag(token.data, b"")) if token.kind in _TAGS else len(token.data)
        for token in tokens
    ]
    return [0, *accumulate(token.breaks for token in tokens)], [0, *accumulate(widths)]


def _is_trailing(tokens: list[Token], index: int) -> bool:
    """Tell whether the blank is in front of a comment behind a tag in the same line."""
    follows = index + 1 < len(tokens) and tokens[index + 1].kind == "comment"
    return follows and index > 0 and tokens[index - 1].kind in ("empty", "end")


def _format_blank(token: Token, follower: Token | None, depth: int, breaks_here: bool) -> bytes:
    """Return the white space between two tokens that are not text."""
    count = min(token.breaks, 2) or int(breaks_here)
    if not count:
        return token.data
    if follower is not None and follower.kind == "end":
        depth -= 1
    return b"\n" * count + INDENT * depth


_TOKEN = re.compile(
    rb"""(?P<comment><!--.*?-->)
    |(?P<cdata><!\[CDATA\[.*?\]\]>)
    |(?P<doctype><!DOCTYPE[^\[>]*(?:\[.*?\]\s*)?>)
    |(?P<instruction><\?.*?\?>)
    |(?P<end></[^>]*>)
    |(?P<start><(?:[^>"']|"[^"]*"|'[^']*')*>)
    |(?P<text>[^<]+)""",
    re.DOTALL | re.VERBOSE,
)

_PRESERVED = re.compile(rb"""\sxml:space\s*=\s*["']preserve["']""")
_NAME = re.compile(rb"<([^\s/>]+)")
_ATTRIBUTE = re.compile(rb"""(\s+)([^\s=/>"']+)\s*=\s*("[^"]*"|'[^']*')""")


@dataclass(slots=True)
class Token:
    """A piece of a file.

    Attributes:
        kind: ``start``, ``empty``, ``end``, ``comment``, ``instruction``, ``doctype``, ``cdata``,
            ``text`` or ``blank``; the last one is white space, and may be empty.
        data: Its bytes.
        partner: Index of the end tag of a start tag.
        is_verbatim: Whether its bytes, or for a start tag those of its content, are data.
        breaks: Number of line breaks in it.
    """

    kind: str
    data: bytes
    partner: int = -1
    is_verbatim: bool = False
    breaks: int = 0


def _read_tokens(data: bytes) -> list[Token]:
    r"""Return the tokens of well-formed XML, with a ``blank`` between any two that are not text.

    Args:
        data: Bytes of an encoding in which ASCII has its own bytes, with ``\n`` as line break.
    """
    tokens: list[Token] = []
    for match in _TOKEN.finditer(data):
        kind, piece = str(match.lastgroup), match[0]
        if kind == "text" and not piece.strip():
            kind = "blank"
        if kind == "start" and piece.endswith(b"/>"):
            kind = "empty"
        is_markup = kind not in ("text", "cdata", "blank")
        if is_markup and tokens and tokens[-1].kind not in ("text", "cdata", "blank"):
            tokens.append(Token("blank", b""))
        tokens.append(Token(kind, piece, breaks=piece.count(b"\n")))
    _match_tags(tokens)
    return tokens


def _match_tags(tokens: list[Token]) -> None:
    """Find the end tag of each start tag, and which contents are data."""
    open_ones: list[int] = []
    for index, token in enumerate(tokens):
        if token.kind == "start":
            open_ones.append(index)
            token.is_verbatim = _PRESERVED.search(token.data) is not None
        elif token.kind == "end" and open_ones:
            start = open_ones.pop()
            tokens[start].partner = index
            if index == start + 2 and not tokens[start + 1].breaks:
                tokens[start].is_verbatim = True  # an element without content, or with a blank
        elif token.kind in ("text", "cdata") and open_ones:
            tokens[open_ones[-1]].is_verbatim = True


def _format_tag(data: bytes, margin: bytes) -> bytes:
    """Return a tag with one space between attributes; breaks between attributes are kept.

    Args:
        data: The tag.
        margin: White space at the beginning of its further lines.
    """
    if data.startswith(b"</"):
        return b"</" + data[2:-1].strip() + b">"
    name = _NAME.match(data)
    if name is None:
        return data
    parts = [name[0]]
    for space, key, value in _ATTRIBUTE.findall(data, name.end()):
        parts.append(b"\n" + margin if b"\n" in space else b" ")
        parts += [key, b"=", value]
    return b"".join(parts) + (b"/>" if data.endswith(b"/>") else b">")
