"""Tags, comments and texts of well-formed XML, as bytes."""

from __future__ import annotations

import re
from dataclasses import dataclass

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


def read_tokens(data: bytes) -> list[Token]:
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


def format_tag(data: bytes, margin: bytes) -> bytes:
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
