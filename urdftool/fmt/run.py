"""Formatting of one file, with the check that it is the same XML afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest

from ..errors import SourceError
from ..source.location import SourceFile
from ..source.well_formed import WIDE
from .equality import list_events
from .layout import format_xml


@dataclass
class Formatted:
    """Bytes of a file before and after."""

    path: str
    before: bytes
    after: bytes

    @property
    def is_changed(self) -> bool:
        """Tell whether the bytes differ."""
        return self.before != self.after

    @property
    def first_line(self) -> int:
        """Return the number of the first line that differs, from 1; 0 if none does."""
        lines = zip_longest(self.before.split(b"\n"), self.after.split(b"\n"))
        return next((n for n, (one, other) in enumerate(lines, 1) if one != other), 0)


def format_file(file: SourceFile) -> Formatted:
    """Return a file with its layout.

    Raises:
        XmlError: The file is not well-formed, or declares entities.
        SourceError: It is in UTF-16 or UTF-32.
        RuntimeError: The result would not be the same XML.
    """
    if any(file.data.startswith(start) for start, _ in WIDE):
        raise SourceError("is UTF-16 or UTF-32; save it as UTF-8", path=file.path)
    before = list_events(file)
    data = format_xml(file.data)
    if data != file.data and list_events(SourceFile(file.path, data)) != before:
        raise RuntimeError(f"{file.path}: its format would change the XML")
    return Formatted(file.path, file.data, data)
