"""Read a robot from URDF or xacro."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...model.load import load
from ..reading import Reading


def read(path: str | Path, **options: Any) -> Reading:
    """Read a robot; the options are those of :func:`urdftool.load`.

    Raises:
        SourceError: The file cannot be read, parsed or expanded.
        ModelError: It is not a robot description.
    """
    return Reading(load(path, **options))
