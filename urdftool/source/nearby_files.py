"""Files near a description that are not part of it, such as its package.xml."""

from __future__ import annotations

from pathlib import Path

from ..errors import SourceError
from ..workspace import Workspace
from .document import Document, parse
from .location import SourceFile
from .packages import shorten_path


def read_optional_file(workspace: Workspace, path: str | Path) -> SourceFile | None:
    """Read a file; None if it cannot be read."""
    try:
        return SourceFile(shorten_path(path), workspace.read_bytes(path))
    except OSError:
        return None


def read_optional_document(workspace: Workspace, path: str | Path) -> Document | None:
    """Read an XML file; None if it cannot be read or is not well-formed."""
    file = read_optional_file(workspace, path)
    try:
        return None if file is None else parse(file)
    except SourceError:
        return None
