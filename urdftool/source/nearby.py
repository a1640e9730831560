"""Files beside a description that are no part of it, such as its package.xml.

While fixes are tried they are read as the fixes leave them, as descriptions are.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import SourceError
from .document import Document, copy_of, parse
from .location import SourceFile
from .packages import shown_path

if TYPE_CHECKING:
    from tempfile import TemporaryDirectory


def bytes_of(path: str | Path) -> bytes:
    """What is in a file.

    Raises:
        OSError: It cannot be read.
    """
    copy = copy_of(path)
    return Path(path).read_bytes() if copy is None else copy


def file_at(path: str | Path) -> SourceFile | None:
    """A file, for places in it; None where it cannot be read."""
    try:
        return SourceFile(shown_path(path), bytes_of(path))
    except OSError:
        return None


def document_at(path: str | Path) -> Document | None:
    """An XML file; None where it cannot be read, or is not well-formed."""
    file = file_at(path)
    try:
        return None if file is None else parse(file)
    except SourceError:
        return None


_folder: list[TemporaryDirectory[str]] = []


def stand_in(path: Path) -> Path:
    """A file for readers that open it themselves: as it is, or a copy of what it is read as.

    Raises:
        OSError: The copy cannot be written.
    """
    copy = copy_of(path)
    if copy is None:
        return path
    from hashlib import sha256
    from tempfile import TemporaryDirectory

    if not _folder:
        _folder.append(TemporaryDirectory(prefix="urdftool-"))
    there = Path(_folder[0].name, sha256(copy).hexdigest(), path.name)
    if not there.exists():
        there.parent.mkdir(exist_ok=True)
        there.write_bytes(copy)
    return there
