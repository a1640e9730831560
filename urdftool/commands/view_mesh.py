"""Read a mesh file as a robot of one link, for the viewer."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from ..console import Console

if TYPE_CHECKING:
    from ..model.elements import Robot


def is_mesh(path: str) -> bool:
    """Tell whether a path has the suffix of a mesh file."""
    from ..geometry.load import READERS

    return Path(path).suffix.lower().removeprefix(".") in READERS


def read_mesh_robot(
    console: Console,
    path: str,
    packages: Mapping[str, Path],
    package_paths: Iterable[str],
) -> Robot:
    """Read a mesh file as a robot of one link, whose visual and collision geometry is the mesh.

    Raises:
        UrdftoolError: The file is not found, or cannot be read.
    """
    from ..geometry.load import load_named
    from ..model.load import make_robot
    from ..source.location import SourceFile
    from .load_strict import read_configured

    name = quoteattr(Path(path).name)
    shape = f"<geometry><mesh filename={name}/></geometry>"
    text = (
        f"<robot name={name}><link name={name}><visual>{shape}</visual>"
        f"<collision>{shape}</collision></link></robot>"
    )
    file = SourceFile(path, text.encode("utf-8", "surrogateescape"))
    description = read_configured(console, path, {}, packages, package_paths, file=file)
    load_named(description, Path(path).name, (1.0, 1.0, 1.0))
    return make_robot(description)
