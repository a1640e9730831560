"""What has been read of a robot's meshes, kept as long as that robot is looked at.

Engines are given hulls of what touches, and verdicts hold what is seen against them, trial after
trial; a mesh is read once for all of that, and for all links that use it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager, suppress
from threading import Thread
from typing import TypeVar, cast

import numpy as np

from ..errors import UrdftoolError
from ..meshes.extremes import extreme_points
from ..meshes.load import load_named
from ..meshes.mesh import Mesh as Triangles
from ..meshes.mesh import Points
from ..meshes.outline import outline
from ..model.elements import Mesh, Robot

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
        _triangles_key(geometry),
        lambda: load_named(source, geometry.filename, geometry.scale),
    )


def mesh_points(robot: Robot, geometry: Mesh) -> Points | None:
    """The outermost points of a mesh [m], shape (n, 3); None where it is not found or not read.

    The box around them is that around the mesh, and their hull all but as large.
    """

    def read() -> Points | None:
        if robot.source is None:
            return None
        try:
            if _is_remembered(robot, _triangles_key(geometry)):
                return extreme_points(triangles_of(robot, geometry).vertices)
            found = outline(robot.source.resolve(geometry.filename), robot.source.gltf_up)
            if found is not None:
                return np.array(found.points) * geometry.scale
            return extreme_points(triangles_of(robot, geometry).vertices)
        except UrdftoolError:
            return None

    return remembered(robot, ("points", geometry.filename, geometry.scale), read)


@contextmanager
def reading_looks(robot: Robot) -> Iterator[None]:
    """Read what is seen of a robot meanwhile: an engine is waited for, and then judged by that."""
    looks = [
        look.geometry
        for link in robot.links
        for look in link.visuals
        if isinstance(look.geometry, Mesh)
    ]

    def read() -> None:
        with suppress(Exception):  # who asks for it meets it, too
            for look in looks:
                mesh_points(robot, look)

    thread = Thread(target=read, daemon=True)
    if looks:
        thread.start()
    yield
    if looks:
        thread.join()


def _triangles_key(geometry: Mesh) -> Hashable:
    return "triangles", geometry.filename, geometry.scale


def _is_remembered(robot: Robot, key: Hashable) -> bool:
    return _last is not None and _last[0] is robot and key in _last[1]
