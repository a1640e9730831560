"""What has been read of a robot's meshes, kept as long as that robot is looked at.

Engines are given hulls of what touches, and verdicts hold what is seen against them, trial after
trial; a mesh is read once for all of that, and for all links that use it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from pathlib import Path
from typing import TypeVar, cast

import numpy as np

from ..errors import UrdftoolError
from ..meshes.extremes import extreme_points
from ..meshes.load import load_named
from ..meshes.mesh import Mesh as Triangles
from ..meshes.mesh import Points
from ..meshes.outline import outline
from ..model.elements import Mesh, Robot
from .kept import Cloud, kept

T = TypeVar("T")

_last: tuple[Robot, dict[Hashable, object]] | None = None


def remembered(robot: Robot, key: Hashable, make: Callable[[], T]) -> T:
    """What ``make`` returns, made once for a robot and a key; errors are not kept."""
    global _last
    kept = _last  # another thread may put its own robot there
    if kept is None or kept[0] is not robot:
        kept = _last = robot, {}
    known = kept[1]
    if key not in known:
        known[key] = make()
    return cast(T, known[key])


def triangles_of(robot: Robot, geometry: Mesh) -> Triangles:
    """The mesh of a geometry [m].

    Raises:
        UrdftoolError: It is not found or cannot be read.
    """
    source = robot.source
    assert source is not None
    return remembered(
        robot,
        ("triangles", geometry.filename, geometry.scale),
        lambda: load_named(source, geometry.filename, geometry.scale),
    )


def mesh_points(robot: Robot, geometry: Mesh) -> Points | None:
    """The outermost points of a mesh [m], shape (n, 3); None where it is not found or not read.

    The box around them is that around the mesh, and their hull all but as large.
    """

    def make() -> list[Cloud]:
        assert robot.source is not None
        found = outline(robot.source.resolve(geometry.filename), robot.source.gltf_up)
        if found is not None:
            points = np.array(found.points) * geometry.scale
        else:
            points = extreme_points(triangles_of(robot, geometry).vertices)
        return [(points, np.zeros((0, 3), dtype=np.int64))]

    def read() -> Points | None:
        if robot.source is None:
            return None
        try:
            ((points, _),) = kept(*kept_by(robot, geometry, "points"), make)
        except UrdftoolError:
            return None
        return points

    return remembered(robot, ("points", geometry.filename, geometry.scale), read)


def kept_by(robot: Robot, geometry: Mesh, what: str) -> tuple[Path, tuple[object, ...]]:
    """The file of a mesh, and what else that hangs on which is kept of it.

    Raises:
        UrdftoolError: It is not found.
    """
    assert robot.source is not None
    path = Path(robot.source.resolve(geometry.filename))
    up = robot.source.gltf_up if path.suffix.lower() == ".glb" else ""
    return path, (what, geometry.scale, up)
