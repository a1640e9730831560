"""Expansion of xacro to plain URDF, with the origin of each element."""

from __future__ import annotations

from collections.abc import Mapping

from .expansion import Expansion
from .expansion_process import expand
from .location import SourceFile
from .packages import Packages


def expand_xacro(
    file: SourceFile,
    arguments: Mapping[str, str],
    packages: Packages,
    *,
    record: bool = False,
) -> Expansion:
    """Expand a xacro file.

    Args:
        file: The file.
        arguments: Values of its ``<xacro:arg>`` elements, as given by ``name:=value``.
        packages: Finder for ``$(find NAME)``.
        record: Whether to record what elements look up, which takes up to a tenth more time.

    Raises:
        XmlError: A file is not well-formed.
        XacroError: The expansion failed; the error has the location of the cause.
        PackageNotFound: The package of ``$(find NAME)`` was not found.
    """
    result = Expansion(file, arguments, record=record)
    expand(result, packages)
    return result
