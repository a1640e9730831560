"""Parsing of files as TinyXML2 does, the XML reader of MuJoCo and libsdformat.

TinyXML2 accepts some text that is not well-formed: blanks before ``<?xml …?>``, a wrong one, ``--``
in comments, no blank between attributes, and end tags after the root element.
"""

from __future__ import annotations

from typing import NamedTuple

from ..errors import XmlError
from .document import Document, parse
from .location import Place, SourceFile
from .well_formed import drop_end_tags_after_root, repair, separate_attributes


class Tolerated(NamedTuple):
    """A parsed file, and what other parsers reject in it.

    Attributes:
        document: The document, with the offsets of the file, but for missing blanks.
        error: First defect; None if the file is well-formed or has only end tags too many.
        surplus: First end tag after the root element, if any.
    """

    document: Document
    error: XmlError | None = None
    surplus: Place | None = None


def parse_as_tinyxml2(file: SourceFile) -> Tolerated:
    """Parse a file that may have the defects that TinyXML2 accepts.

    Raises:
        XmlError: It has another one.
    """
    try:
        return Tolerated(parse(file))
    except XmlError as error:
        if error.rule == "content-before-declaration" and error.case != "blanks":
            raise
        text = repair(file) or file
        text = separate_attributes(text) or text
        is_repaired = text is not file
        text, surplus = drop_end_tags_after_root(text) or (text, None)
        if text is file:
            raise
        return Tolerated(parse(text), error if is_repaired else None, surplus)
