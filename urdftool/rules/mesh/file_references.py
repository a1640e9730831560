"""Check files that mesh files refer to."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from ...geometry.reference_patterns import INIT_FROM, MTLLIB, URI
from ...model.elements import Robot, Visual
from ...source.description import Description
from ...workspace import Workspace, memoize_by_workspace
from ..rule import INFO, URDF_AND_SDF, WARNING, Problem, rule
from ..words import quote
from .mesh_uses import MeshUse, get_mesh_uses

APPLIES_TO = ("mesh",)

_RELIEF = re.compile(r"normal|bump|height|specular|_nrm", re.IGNORECASE)
_MOST = 4_000_000
"""Bytes that are searched. Chosen, no source."""


@rule(
    WARNING,
    effects={
        "mujoco, pybullet, drake": "load the robot anyway",
    },
    formats=URDF_AND_SDF,
    pedantic="MTL files, without which a mesh is gray",
)
def missing_mesh_dependency(
    robot: Robot, description: Description, *, together: float = 3
) -> Iterator[Problem]:
    """A file that a mesh refers to does not exist.

    An OBJ file has its colors in an MTL file, a COLLADA file its textures and a glTF file its
    buffers in separate files, which are easily left behind when a mesh is copied. Without colors
    or textures a mesh keeps its shape, which is an info; without its buffers it has no shape. An
    MTL file is not missed if the visual has a material of its own.
    More than ``together`` such meshes are one finding.
    """
    seen: set[str] = set()
    found: list[tuple[MeshUse, tuple[str, ...]]] = []
    for use in get_mesh_uses(robot, description):
        if use.path is None or not use.exists or use.uri in seen or use.collides:
            continue
        seen.add(use.uri)
        missing = _find_missing(use.workspace, use.path)
        if _has_color(use) and all(name.lower().endswith(".mtl") for name in missing):
            continue
        if missing:
            found.append((use, missing))
    several = len(found) > together
    for use, missing in found[:1] if several else found:
        named = [names for _, names in found] if several else [missing]
        others = f" (and {len(found) - 1} more meshes)" if several else ""
        yield Problem(
            use.link,
            f"mesh '{use.uri}' refers to {quote(missing)}, but the file does not exist{others}",
            at=use.mesh.locate_attribute("filename"),
            severity=None if any(_has_shape(name) for one in named for name in one) else INFO,
            data={"uri": use.uri, "names": list(missing)},
            pedantic=all(name.lower().endswith(".mtl") for one in named for name in one),
        )


def _has_color(use: MeshUse) -> bool:
    """Tell whether a visual has a material, which counts instead of those of its mesh."""
    return isinstance(use.shape, Visual) and use.shape.material is not None


def _has_shape(name: str) -> bool:
    """Tell whether a file that a mesh refers to holds its vertices (a glTF buffer)."""
    return name.lower().endswith((".bin", ".glbin"))


@memoize_by_workspace
def _find_missing(workspace: Workspace, path: Path) -> tuple[str, ...]:
    """Find the missing files that a mesh refers to; cached for a run."""
    return tuple(_search_missing(workspace, path))


def _search_missing(workspace: Workspace, path: Path) -> Iterator[str]:
    ending = path.suffix.lower()
    pattern = {".obj": MTLLIB, ".dae": INIT_FROM, ".gltf": URI}.get(ending)
    if pattern is None:
        return
    try:
        with workspace.open(path) as file:
            data = file.read(_MOST if ending != ".obj" else 65536)
    except OSError:
        return
    for name in dict.fromkeys(match[1] for match in pattern.finditer(data)):
        text = unquote(name.decode("utf-8", "replace")).removeprefix("file://")
        if ending == ".dae" and _RELIEF.search(text):
            continue  # readers of robots use only the diffuse texture of COLLADA
        if text.startswith(("data:", "http:", "https:", "#")) or (
            ending == ".dae" and "." not in text
        ):
            continue  # embedded, remote, or the name of an embedded image
        if not workspace.exists(path.parent / text.replace("\\", "/")):
            yield text


def find_buffers(workspace: Workspace, path: Path) -> list[Path]:
    """List the files that a reader of a glTF file opens in addition to it."""
    if path.suffix.lower() != ".gltf":
        return []
    try:
        data = workspace.read_bytes(path)
    except OSError:
        return []
    names = (match[1].decode("utf-8", "replace") for match in URI.finditer(data))
    return [path.parent / unquote(name) for name in names if not name.startswith("data:")]
