"""Layout of XML: where lines begin, and how far they are indented.

Two spaces an element; attributes keep their order and their lines; tags, comments and texts that
share a line keep sharing it, unless an element that is written in one line is wider than
``WIDTH``. At most one blank line is kept in a row: xacro removes comments before its own tags by
counting line ends, so that one and none are not the same, and two and one are.
"""

from __future__ import annotations

from itertools import accumulate

from .tokens import Token, format_tag, read_tokens

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
    tokens = read_tokens(body.replace(b"\r\n", b"\n"))
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
            pieces.append(format_tag(token.data, INDENT * (depth + 2)))
        else:
            pieces.append(token.data)
        if token.kind == "start":
            end = token.partner
            if token.is_verbatim:
                pieces += [one.data for one in tokens[index + 1 : end]]
                pieces.append(format_tag(tokens[end].data, b""))
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
        len(format_tag(token.data, b"")) if token.kind in _TAGS else len(token.data)
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
