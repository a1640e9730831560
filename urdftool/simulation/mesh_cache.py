"""Meshes of a robot, read once for all trials, checks and links that use them."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from pathlib import Path
from typing import TypeVar, cast

import numpy as np

from ..errors import UrdftoolError
from ..geometry.convex_points import extreme_points, read_convex_points
from ..geometry.load import load_named
from ..geometry.mesh import Mesh as Triangles
from ..geometry.mesh import Points
from ..model.elements import Mesh, Robot
from .hull_cache import Cloud, get_or_compute

T = TypeVar("T")

_last: tuple[Robot, dict[Hashable, object]] | None = None


def compute_once(robot: Robot, key: Hashable, make: Callable[[], T]) -> T:
    """Return the result for a robot and a key, computed once; errors are not cached."""
    global _last
    memo = _last  # another thread may put its own robot there
    if memo is None or memo[0] is not robot:
        memo = _last = robot, {}
    known = memo[1]
    if key not in known:
        known[key] = make()
    return cast(T, known[key])


def load_triangles(robot: Robot, geometry: Mesh) -> Triangles:
    """Load the mesh of a geometry [m].

    Raises:
        UrdftoolError: It is not found or cannot be read.
    """
    source = robot.source
    assert source is not None
    return compute_once(
        robot,
        ("triangles", geometry.filename, geometry.scale),
        lambda: load_named(source, geometry.filename, geometry.scale),
    )


def get_outermost_points(robot: Robot, geometry: Mesh) -> Points | None:
    """Return the outermost points of a mesh [m], shape (n, 3); None if it cannot be read.

    Their bounding box is that of the mesh, and their hull almost as large.
    """

    def make() -> list[Cloud]:
        assert robot.source is not None
        found = read_convex_points(robot.source.resolve(geometry.filename), robot.source.gltf_up)
        if found is not None:
            points = np.array(found.points) * geometry.scale
        else:
            points = extreme_points(load_triangles(robot, geometry).vertices)
        return [(points, np.zeros((0, 3), dtype=np.int64))]

    def read() -> Points | None:
        if robot.source is None:
            return None
        try:
            ((points, _),) = get_or_compute(*get_mesh_key(robot, geometry, "points"), make)
        except UrdftoolError:
            return None
        return points

    return compute_once(robot, ("points", geometry.filename, geometry.scale), read)


def get_mesh_key(robot: Robot, geometry: Mesh, what: str) -> tuple[Path, tuple[object, ...]]:
    """Return the file of a mesh, and what else the cached result depends on.

    Raises:
        UrdftoolError: It is not found.
    """
    assert robot.source is not None
    path = Path(robot.source.resolve(geometry.filename))
    up = robot.source.gltf_up if path.suffix.lower() == ".glb" else ""
    return path, (what, geometry.scale, up)
