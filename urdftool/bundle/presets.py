"""Presets of bundles: the options that a reader requires, with the reason."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..errors import MeshError
from ..finding import Finding
from ..geometry.stl_header import read_stl_header
from ..source.location import SourceFile
from .drake import change_for_drake

if TYPE_CHECKING:
    from .mesh_formats import MeshFormat

Change = Callable[[SourceFile], tuple[SourceFile, list[Finding]]]
"""Returns a URDF that a reader loads, and a finding for each change."""

Uri = Literal["relative", "package", "file"]
"""How the URDF of a bundle names its files."""

_MOST_STL_FACES = 200_000
"""Triangles of an STL file above which a preset reduces it. Chosen, no source."""

_OBJECT = re.compile(rb"(?m)^[ \t]*[og][ \t]")


@dataclass(frozen=True)
class Preset:
    """Options for one reader.

    Attributes:
        uri: Form of mesh URIs.
        meshes: Format of meshes that the reader cannot read; empty converts none.
        suffixes: Suffixes of meshes that the reader reads as RViz does.
        is_readable: Further condition for a mesh with such a suffix.
        reason: Sentence for the documentation.
        change: Changes the URDF where the reader refuses what others read; None if it needs none.
    """

    uri: Uri
    meshes: MeshFormat
    suffixes: tuple[str, ...]
    reason: str
    is_readable: Callable[[Path], bool] = bool
    change: Change | None = None

    def is_accepted(self, path: Path) -> bool:
        """Tell whether a mesh needs no conversion."""
        return path.suffix.lower() in self.suffixes and self.is_readable(path)


def is_readable_by_mujoco(path: Path) -> bool:
    """Tell whether MuJoCo reads all of an STL or OBJ file.

    It reads binary STL files of at most 200,000 faces, and the first object of an OBJ file.
    """
    try:
        if path.suffix.lower() == ".obj":
            return len(_OBJECT.findall(path.read_bytes())) < 2
        header = read_stl_header(path)
    except (OSError, MeshError):
        return True
    size = (_MOST_STL_FACES * 50) + 84
    return header.kind == "binary" and header.bytes <= size


PRESETS = {
    "mujoco": Preset(
        "relative",
        "obj",
        (".stl", ".obj"),
        "MuJoCo reads STL and OBJ: binary STL of at most 200,000 faces, the first object of an OBJ",
        is_readable_by_mujoco,
    ),
    "pybullet": Preset(
        "relative",
        "obj",
        (".stl", ".obj"),
        "PyBullet rotates COLLADA meshes by their up axis, as RViz does not, and reads no glTF",
    ),
    "drake": Preset(
        "relative",
        "obj",
        (".obj", ".gltf", ".glb"),
        "Drake reads OBJ and glTF; STL and COLLADA are ignored or rejected",
        change=change_for_drake,
    ),
    "isaac": Preset(
        "relative",
        "obj",
        (".stl", ".obj", ".dae"),
        "the URDF importer of Isaac Sim reads STL, OBJ and COLLADA with relative paths",
    ),
    "genesis": Preset(
        "relative",
        "obj",
        (".stl", ".obj"),
        "Genesis reads meshes by trimesh, which applies the up axis of COLLADA and glTF",
    ),
    "web": Preset(
        "relative",
        "dae",
        (".stl", ".dae"),
        "urdf-loader of three.js loads STL and COLLADA without further code",
    ),
    "foxglove": Preset(
        "package",
        "glb",
        (".stl", ".dae", ".obj", ".glb"),
        "the Foxglove bridge serves package:// URIs of portable names only",
    ),
}
"""Presets by name."""
