"""Meshes of a robot, read once for all trials, checks and links that use them."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from pathlib import Path
from typing import TypeVar

import numpy as np

from ..errors import UrdftoolError
from ..geometry.convex_points import read_convex_points, select_extreme_points
from ..geometry.load import load_named
from ..geometry.mesh import Mesh as Triangles
from ..geometry.mesh import Points
from ..model.elements import Mesh, Robot
from ..storage import cache_folder
from .hull_cache import Cloud, HullCache

T = TypeVar("T")

_CACHE = "cache of hulls"


def compute_once(robot: Robot, key: Hashable, make: Callable[[], T]) -> T:
    """Return the result for a robot and a key, computed once; errors are not cached."""
    return robot.memo.get(("simulation", key), make)


def set_cache_folder(robot: Robot, folder: str | Path | None) -> None:
    """Cache hulls of a robot's meshes in a folder, and not in the user's cache.

    Args:
        robot: The robot, none of whose meshes has been read yet.
        folder: The folder; None caches nothing on disk.
    """
    compute_once(robot, _CACHE, lambda: HullCache(folder))


def get_cached_hulls(
    robot: Robot, geometry: Mesh, what: str, make: Callable[[], list[Cloud]]
) -> list[Cloud]:
    """Return the cached result for a mesh, also of an earlier run, or compute it.

    Raises:
        UrdftoolError: The mesh is not found, or ``make`` failed.
    """

    def read() -> list[Cloud]:
        cache = compute_once(robot, _CACHE, lambda: HullCache(cache_folder("simulate")))
        return cache.get_or_compute(*_get_mesh_key(robot, geometry, what), make)

    return compute_once(robot, (what, geometry.filename, geometry.scale), read)


def load_triangles(robot: Robot, geometry: Mesh) -> Triangles:
    """Load the mesh of a geometry [m].

    Raises:
        UrdftoolError: The file is not found or cannot be read.
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
    found = _read_outermost_points(robot, geometry)
    return None if isinstance(found, UrdftoolError) else found


def explain_unread(robot: Robot, geometry: Mesh) -> UrdftoolError | None:
    """Return the error for which the outermost points of a mesh are not known; None if they are."""
    found = _read_outermost_points(robot, geometry)
    return found if isinstance(found, UrdftoolError) else None


def _read_outermost_points(robot: Robot, geometry: Mesh) -> Points | UrdftoolError:
    """Read the outermost points of a mesh once, or return the error."""

    def make() -> list[Cloud]:
        assert robot.source is not None
        found = read_convex_points(robot.source.resolve(geometry.filename), robot.source.gltf_up)
        if found is not None:
            points = np.array(found.points) * geometry.scale
        else:
            points = select_extreme_points(load_triangles(robot, geometry).vertices)
        return [(points, np.zeros((0, 3), dtype=np.int64))]

    def read() -> Points | UrdftoolError:
        if robot.source is None:
            return UrdftoolError("the robot was not read from a file")
        try:
            ((points, _),) = get_cached_hulls(robot, geometry, "points", make)
        except UrdftoolError as error:
            return error
        return points

    return compute_once(robot, ("outermost", geometry.filename, geometry.scale), read)


def _get_mesh_key(robot: Robot, geometry: Mesh, what: str) -> tuple[Path, tuple[object, ...]]:
    """Return the file of a mesh, and other values that the cached result depends on.

    Raises:
        UrdftoolError: The file is not found.
    """
    assert robot.source is not None
    path = Path(robot.source.resolve(geometry.filename))
    up = robot.source.gltf_up if path.suffix.lower() == ".glb" else ""
    return path, (what, geometry.scale, up)
