"""The files a robot is made of: its description, what that includes, meshes and images."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ..errors import UrdftoolError
from ..source.document import STDIN
from .elements import Mesh, Robot


def sources(robot: Robot) -> set[str]:
    """Paths of the files, also of meshes that are not there; standard input is none."""
    if robot.source is None:
        return set()
    found = {file.path for file in robot.source.files}
    if robot.source.expansion is not None:
        found.update(robot.source.expansion.dependencies)
    for uri in _named(robot):
        try:
            path = robot.source.resolve(uri)
        except (UrdftoolError, ValueError):
            continue
        found.add(str(path))
        if path.suffix.lower() == ".obj":
            found.add(str(path.with_suffix(".mtl")))
    return {path for path in found if path not in ("", "-", STDIN) and _is_path(path)}


def _named(robot: Robot) -> Iterator[str]:
    """URIs of meshes and of images."""
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
