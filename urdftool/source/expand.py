"""Expansion of xacro to plain URDF, with the origin of each element."""

from __future__ import annotations

import threading
from collections.abc import Mapping

from ..errors import UrdftoolError
from .expansion import Expansion
from .location import SourceFile
from .packages import Packages
from .xacro_hooks import Run

_lock = threading.RLock()


def expand_xacro(
    file: SourceFile,
    arguments: Mapping[str, str],
    packages: Packages,
) -> Expansion:
    """Expand a xacro file.

    Args:
        file: The file.
        arguments: Values of its ``<xacro:arg>`` elements, as given by ``name:=value``.
        packages: Finder for ``$(find NAME)``.

    Raises:
        XmlError: A file is not well-formed.
        XacroError: The expansion failed; the error has the location of the cause.
        PackageNotFound: The package of ``$(find NAME)`` was not found.
    """
    with _lock:
        run = Run(Expansion(file, arguments), packages)
        with run.install_hooks():
            try:
                run.expand()
            except UrdftoolError:
                raise
            except Exception as error:
                raise run.explain(error) from error
        return run.result
