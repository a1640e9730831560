"""XML parsing with checks common to all descriptions, and explanations of errors.

Rejected are text that is not well-formed, entity declarations (which covers entity bombs and
external entities) and nesting deeper than ``MAX_DEPTH``.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, Protocol
from xml.parsers import expat

from ..errors import XmlError
from .description_formats import find_by_head
from .location import Place, SourceFile

MAX_DEPTH = 200  # nested elements; chosen, no source: the deepest of 219 real ones has 9


class OpenElement(Protocol):
    """Element whose end tag has not been read; used in error messages."""

    start: int

    @property
    def tag(self) -> str:
        """Return the name."""


def run_parser(parser: Any, file: SourceFile, stack: Sequence[OpenElement]) -> None:
    """Parse a file with an expat parser and the common checks.

    Raises:
        XmlError: The file is not well-formed, declares entities, or cannot be decoded.
    """

    def entity(name: str, *_: object) -> None:
        at = parser.CurrentByteIndex
        raise XmlError(
            f"entity '{name}' is declared, but entities are not allowed in robot descriptions; "
            "write the text itself, or use a xacro property",
            at=Place(file, at, at),
        )

    def declaration(_: str, encoding: str | None, __: int) -> None:
        if encoding and encoding.lower() not in _ENCODINGS_OF_EXPAT:
            file.encoding = _find_codec(encoding)

    parser.EntityDeclHandler = entity
    parser.XmlDeclHandler = declaration
    try:
        parser.Parse(_as_expat_reads(file), True)
    except expat.ExpatError as error:
        offset = min(parser.ErrorByteIndex, len(file.data))
        message, rule, case = _explain(file, error, offset)
        if case == _OPEN_QUOTE:
            offset = _find_open_quote(file.data, offset)
        if stack and case == "an element that is not closed":
            line = file.position(stack[-1].start)[0]
            message += f" (open: <{stack[-1].tag}> of line {line})"
        raise XmlError(
            message,
            at=Place(file, max(offset, 0), max(offset, 0)),
            rule=rule,
            case=case,
        ) from None
    except (LookupError, UnicodeDecodeError, ValueError) as error:
        raise XmlError(
            f"the text cannot be decoded ({error}); save the file as UTF-8", at=Place(file, 0, 0)
        ) from None


def _find_codec(encoding: str) -> str:
    """Return Python's name of a declared encoding, of those with one byte for each character.

    Raises:
        LookupError: It is unknown, not an encoding of text (``zlib``), or one in which ``<`` can be
            a part of another character (``shift_jis``).
    """
    import codecs

    try:
        name = codecs.lookup(encoding).name
    except (LookupError, ValueError):
        name = ""
    if not re.fullmatch(_SINGLE_BYTE, name) or b"<".decode(name) != "<":
        raise LookupError(f"encoding '{encoding}' is not supported")
    return name


def _as_expat_reads(file: SourceFile) -> bytes:
    """Return the bytes of a file; convert UTF-16 and UTF-32 to UTF-8, in ``file.data`` too."""
    for start, encoding in WIDE:
        if file.data.startswith(start):
            text = file.data.decode(encoding).removeprefix("\ufeff")
            text = re.sub(r"^(<\?xml[^>]*?)\s+encoding\s*=\s*(\"[^\"]*\"|'[^']*')", r"\1", text)
            file.data = text.encode("utf-8")
            break
    return file.data


_ENCODINGS_OF_EXPAT = ("utf-8", "utf8", "us-ascii", "ascii")
_SINGLE_BYTE = r"iso8859-\d+|cp\d+|koi8-[a-z]|mac-\w+|tis-620|kz1048|ptcp154|hp-roman8|ascii|utf-8"
WIDE = (
    (b"\xff\xfe\x00\x00", "utf-32"),
    (b"\x00\x00\xfe\xff", "utf-32"),
    (b"\xff\xfe", "utf-16"),
    (b"\xfe\xff", "utf-16"),
    (b"<\x00\x00\x00", "utf-32-le"),
    (b"\x00\x00\x00<", "utf-32-be"),
    (b"<\x00", "utf-16-le"),
    (b"\x00<", "utf-16-be"),
)
"""First bytes of a file in UTF-16 or UTF-32, with a byte order mark or with ``<``."""


def _explain(file: SourceFile, error: expat.ExpatError, offset: int) -> tuple[str, str, str]:
    """Return message, rule and case of an expat error."""
    data = file.data
    reason = expat.ErrorString(error.code) or str(error)
    closing = data[offset : data.find(b">", offset)].decode(file.encoding, "replace").strip("</ ")
    if found := find_by_head(data):
        text = f"the file is {found.name.upper()}, not a URDF or xacro file"
        return text, "not-well-formed", "no XML"
    if data.startswith(b"version https://git-lfs"):
        return (
            "the file is a Git LFS pointer, not its content; run 'git lfs pull'",
            "not-well-formed",
            "no XML",
        )
    if b"<" not in data[:4096] and offset < 4096:
        message = "the file is not XML; a robot description starts with <robot>"
        return message, "not-well-formed", "no XML"
    if (at := data.find(b"<?xml")) > 0 and offset <= at + 5:
        before = data[:at].removeprefix(b"\xef\xbb\xbf")
        blank = not before.strip()
        what = "whitespace" if blank else "text"
        return (
            f"{what} precedes the XML declaration <?xml …?>, which XML parsers reject; "
            "move the declaration to the start of the file",
            "content-before-declaration",
            "blanks" if blank else "a comment" if before.lstrip()[:4] == b"<!--" else "other text",
        )
    case = ""
    if reason == _INVALID and _find_open_quote(data, offset) >= 0:
        reason = "the quote that opens here is not closed before the next tag; add one at the end"
        case = _OPEN_QUOTE
    elif reason == _INVALID and data[offset : offset + 1] == b"\0":
        reason = "a NUL byte is in the file, which XML does not allow; remove it"
    elif reason == _INVALID and data[offset - 1 : offset + 1] == b"</":
        reason = f"</{closing}> is an end tag, but no element is open here; remove it"
    elif reason == _INVALID and _is_after_value(data, offset):
        reason = "a blank is missing between two attributes"
    elif reason == _INVALID and re.search(rb"&[\w.#-]*$", data[max(0, offset - 80) : offset]):
        reason = "'&' begins an entity, such as &lt;; write &amp; for the character"
    elif reason == _INVALID and re.search(rb"<[^<>]*=\s*$", data[max(0, offset - 400) : offset]):
        reason = "the value of an attribute has no quotes; add them"
    elif reason == "unclosed token" and data.startswith(b"<!--", offset):
        reason = "the comment that opens here is not closed; add '-->' at its end"
    elif data.startswith((b"<?xml", b"\xef\xbb\xbf<?xml")) and offset <= data.find(b"?>"):
        reason = f'the XML declaration is invalid ({reason}); use <?xml version="1.0"?>'
        case = "a wrong declaration"
    elif _is_in_comment(data, offset):
        reason = "a comment contains '--', which XML does not allow; use '- -' or '-'"
        case = "'--' in a comment"
    else:
        case = "an element that is not closed" if reason in _NOT_CLOSED else ""
        reason = {
            "mismatched tag": f"</{closing}> closes an element that is not open here",
            "unbound prefix": "a namespace prefix is not declared; for xacro, add "
            'xmlns:xacro="http://www.ros.org/wiki/xacro" to <robot>',
            "no element found": "the file ends before all elements are closed; it may be truncated",
            "unclosed token": "the file ends inside a tag; it may be truncated",
            "junk after document element": "the file has content after the root element; "
            "an XML file has one root element",
            "undefined entity": "an entity is not defined; XML defines &lt; &gt; &amp; &quot; "
            "&apos;",
            "duplicate attribute": "the tag has the same attribute twice",
        }.get(reason, f"not well-formed XML ({reason})")
    rule = "missing-xmlns" if error.code == _UNBOUND_PREFIX else "not-well-formed"
    return reason, rule, case


_INVALID = "not well-formed (invalid token)"
_OPEN_QUOTE = "a quote that is not closed"
_UNBOUND_PREFIX = 27  # XML_ERROR_UNBOUND_PREFIX of expat
_NOT_CLOSED = ("mismatched tag", "no element found")


def _find_open_quote(data: bytes, offset: int) -> int:
    """Find the quote that opens the value of an attribute with ``<`` in it; -1 if there is none.

    A quote that is not closed takes the text up to the next quote into its value, with the tags in
    between. The parser then reports the first of these, or what follows the next quote.
    """
    start = data.rfind(b"<", 0, offset)
    if data[offset : offset + 1] != b"<" or start < 0:
        return -1
    quote = -1
    for at in range(start, offset):
        if data[at] not in b"\"'":
            continue
        if quote < 0:
            quote = at
        elif data[at] == data[quote]:
            quote = -1
    return quote


def _is_after_value(data: bytes, offset: int) -> bool:
    """Tell whether an attribute begins directly behind the value of the one before."""
    return data[offset - 1 : offset] in (b'"', b"'") and data[offset : offset + 1].isalpha()


def separate_attributes(file: SourceFile) -> SourceFile | None:
    """Return a file with blanks between attributes; None if none is missing.

    Each blank moves what follows in its line by one column.
    """
    data = file.data
    for _ in range(_MOST_BLANKS):
        parser = expat.ParserCreate()
        try:
            parser.Parse(data, True)
        except expat.ExpatError as error:
            at = parser.ErrorByteIndex
            if expat.ErrorString(error.code) == _INVALID and _is_after_value(data, at):
                data = data[:at] + b" " + data[at:]
                continue
        except ValueError:
            pass
        break
    return None if data == file.data else SourceFile(file.path, data, file.encoding)


_MOST_BLANKS = 100
"""Number of missing blanks in a file, each of which is another run of the parser. Chosen."""


def _is_in_comment(data: bytes, offset: int) -> bool:
    before = data.rfind(b"<!--", 0, offset + 1)
    return before >= 0 and b"-->" not in data[before:offset] and b"--" in data[before + 4 :]


def drop_end_tags_after_root(file: SourceFile) -> tuple[SourceFile, Place] | None:
    """Return a file without end tags after its root element, and the place of the first of them.

    Blanks replace the tags, so that offsets are unchanged. Comments may be between them.

    Returns:
        None if there is no such tag, or if there is other content.
    """
    end = _find_root_end(file)
    rest = b"" if end is None else _COMMENT.sub(lambda c: b" " * len(c[0]), file.data[end:])
    tags = list(_END_TAG.finditer(rest))
    if end is None or not tags or _END_TAG.sub(b"", rest).strip():
        return None
    data = bytearray(file.data)
    for tag in tags:
        data[end + tag.start() : end + tag.end()] = b" " * len(tag[0])
    place = Place(file, end + tags[0].start(), end + tags[0].end())
    return SourceFile(file.path, bytes(data), file.encoding), place


_END_TAG = re.compile(rb"</[^<>]*>")
_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)


def _find_root_end(file: SourceFile) -> int | None:
    """Return the offset behind the root element; None if the text is not well-formed before."""
    parser = expat.ParserCreate()
    depth, ends = 0, []

    def begin(_: str, __: object) -> None:
        nonlocal depth
        depth += 1

    def finish(_: str) -> None:
        nonlocal depth
        depth -= 1
        if depth == 0:
            ends.append(parser.CurrentByteIndex)

    parser.StartElementHandler, parser.EndElementHandler = begin, finish
    with suppress(expat.ExpatError, ValueError):
        parser.Parse(file.data, True)
    return file.data.find(b">", ends[0]) + 1 if ends else None


def repair(file: SourceFile) -> SourceFile | None:
    """Return a file that tolerant readers accept, made well-formed at unchanged offsets.

    Blanks replace what TinyXML ignores: a wrong or late ``<?xml …?>`` and ``--`` in comments. The
    result is for further checks of a file that is not well-formed.

    Returns:
        The repaired file; None if nothing was repaired or a comment is not closed.
    """
    data = bytearray(file.data)
    at = data.find(b"<?xml")
    end = data.find(b"?>", at)
    if 0 <= at < end:
        data[at : end + 2] = b" " * (end + 2 - at)
    at = data.find(b"<!--")
    while at >= 0:
        end = data.find(b"-->", at + 4)
        if end < 0:
            return None
        inner = bytes(data[at + 4 : end]).replace(b"--", b"  ")
        data[at + 4 : end] = inner.removesuffix(b"-") + b" " if inner.endswith(b"-") else inner
        at = data.find(b"<!--", end)
    return None if data == file.data else SourceFile(file.path, bytes(data), file.encoding)
