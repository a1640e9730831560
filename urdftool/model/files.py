"""Files of a robot: its description, included files, meshes and textures."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ..errors import UrdftoolError
from ..source.document import STDIN
from .elements import Mesh, Robot


def list_sources(robot: Robot) -> set[str]:
    """Return the paths of the files, including missing meshes; without standard input."""
    if robot.source is None:
        return set()
    found = {file.path for file in robot.source.files}
    if robot.source.expansion is not None:
        found.update(robot.source.expansion.dependencies)
    for uri in _list_uris(robot):
        try:
            path = robot.source.resolve(uri)
        except (UrdftoolError, ValueError):
            continue
        found.add(str(path))
        if path.suffix.lower() == ".obj":
            found.add(str(path.with_suffix(".mtl")))
    return {path for path in found if path not in ("", "-", STDIN) and _is_path(path)}


def _list_uris(robot: Robot) -> Iterator[str]:
    """Yield the URIs of meshes and textures."""
    for _, shape in robot.shapes:
        if isinstance(shape.geometry, Mesh) and shape.geometry.filename:
            yield shape.geometry.filename
    for material in (
        *robot.materials,
        *(visual.material for link in robot.links for visual in link.visuals),
    ):
        if material is not None and material.texture:
            yield material.texture


def _is_path(path: str) -> bool:
    return "\0" not in path and not os.path.isdir(Path(path))
