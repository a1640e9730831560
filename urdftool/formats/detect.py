"""The format of a file, by its root element or first bytes, and reading a file by its format."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..source.location import SourceFile
    from ..source.packages import Packages
    from .registry import Format

_PROLOG = re.compile(rb"\s+|<\?.*?\?>|<!--.*?-->|<!DOCTYPE[^>\[]*(?:\[.*?\]\s*)?>", re.DOTALL)
_TAG = re.compile(rb"<([\w:.-]+)")


def format_of(file: SourceFile) -> Format:
    """Return the format of a file; URDF if the root element belongs to no format."""
    from ..source.description_formats import ROOTS, URDF, find_by_head
    from .registry import format_named

    if found := find_by_head(file.data):
        return format_named(found.name)
    data = file.data.removeprefix(b"\xef\xbb\xbf")
    at = 0
    while skipped := _PROLOG.match(data, at):
        at = skipped.end()
    tag = _TAG.match(data, at)
    return format_named(ROOTS.get(tag[1].decode("latin-1") if tag else "", URDF).name)


def read_other_format(file: SourceFile, packages: Packages, name: str = "") -> Robot | None:
    """Read a robot in a format other than URDF; return None for URDF and xacro.

    Args:
        file: The file.
        packages: Finder of meshes and included models.
        name: Name of one of several robots in the file; empty for the largest.

    Raises:
        UrdftoolError: The file cannot be read.
    """
    found = format_of(file)
    if found.name == "urdf":
        return None
    workspace = packages.workspace
    options = {"packages": packages, "workspace": workspace}
    return found.read(file.path, file=file, name=name, **options).robot
