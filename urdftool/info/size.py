"""Bounding box of all geometry at the zero pose, and meshes with their triangles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from ..errors import UrdftoolError
from ..model.bounds import Bounds, compute_bounds_at
from ..model.elements import Collision, Mesh, Plane, Robot, Vector, Visual
from ..model.kinematics import compute_link_poses
from ..model.pose import Pose, make_pose

Progress = Callable[[int, int, str], None]


@dataclass
class MeshFile:
    """Mesh file of a robot.

    Attributes:
        uri: URI as written.
        path: Path of the file; None if not found.
        triangles: Number of triangles; None if it cannot be read.
        visuals: Number of visuals that use it.
        collisions: Number of collisions that use it.
        reason: Reason why it cannot be read; empty if it can.
    """

    uri: str
    path: str | None = None
    triangles: int | None = None
    visuals: int = 0
    collisions: int = 0
    reason: str = ""


@dataclass
class Measured:
    """Dimensions of the geometry of a robot.

    Attributes:
        bounds: Bounding box at the zero pose, along the axes of the root [m]; None if no
            geometry can be read, or a length is not finite.
        left_out: Number of shapes that the bounding box lacks: their mesh or dimensions could not
            be read, or their link has no pose; planes, which have no bounds, are not counted.
        meshes: Mesh files, in the order of their first reference.
    """

    bounds: Bounds | None = None
    left_out: int = 0
    meshes: list[MeshFile] = field(default_factory=list)

    def count_triangles(self, kind: str) -> int:
        """Return the number of triangles of all ``visuals`` or ``collisions``; each use counts."""
        return sum((mesh.triangles or 0) * getattr(mesh, kind) for mesh in self.meshes)


def measure(robot: Robot, progress: Progress = lambda *_: None) -> Measured:
    """Compute the bounding box of a robot at the zero pose, and read its meshes.

    At the zero pose, all joints are at 0, and mimic joints follow them.
    """
    poses = compute_link_poses(robot)
    measured = Measured()
    boxes: list[Bounds] = []
    uses: dict[str, list[tuple[Pose | None, Visual | Collision]]] = {}
    for link, shape in robot.shapes:
        at = poses.get(link.name)
        if isinstance(shape.geometry, Mesh):
            uses.setdefault(shape.geometry.filename, []).append((at, shape))
        elif not isinstance(shape.geometry, Plane):
            box = None if at is None else _compute_primitive_bounds(shape, at)
            boxes += [] if box is None else [box]
            measured.left_out += box is None
    for number, (uri, shapes) in enumerate(uses.items(), 1):
        progress(number, len(uses), uri)
        mesh = MeshFile(uri)
        mesh.visuals = sum(isinstance(shape, Visual) for _, shape in shapes)
        mesh.collisions = len(shapes) - mesh.visuals
        measured.meshes.append(mesh)
        read: list[Bounds] = []
        try:
            read += _read(robot, mesh, shapes)
        except UrdftoolError as error:
            mesh.reason = error.message
        boxes += read
        measured.left_out += len(shapes) - len(read)
    for box in boxes:
        measured.bounds = box if measured.bounds is None else measured.bounds.join(box)
    if measured.bounds is not None and not all(map(math.isfinite, measured.bounds.size)):
        measured.bounds = None  # overflow
    return measured


def _compute_primitive_bounds(shape: Visual | Collision, at: Pose) -> Bounds | None:
    """Return the bounding box of a primitive in the frame of the link pose."""
    return compute_bounds_at(shape.geometry, at @ make_pose(shape.origin))


def _read(
    robot: Robot, mesh: MeshFile, shapes: list[tuple[Pose | None, Visual | Collision]]
) -> Iterator[Bounds]:
    """Read a mesh at each scale; yield the bounding box of each use.

    Raises:
        UrdftoolError: It is not found or cannot be read.
    """
    from ..geometry.load import load_mesh

    if robot.source is None:
        return
    path = robot.source.resolve(mesh.uri)
    mesh.path = str(path)
    by_scale: dict[Vector, list[tuple[Pose | None, Visual | Collision]]] = {}
    for at, shape in shapes:
        assert isinstance(shape.geometry, Mesh)
        by_scale.setdefault(shape.geometry.scale, []).append((at, shape))
    for scale, same in by_scale.items():
        read = load_mesh(path, scale, gltf_up=robot.source.gltf_up)
        mesh.triangles = len(read.faces)
        for at, shape in same:
            if at is not None:
                pose = at @ make_pose(shape.origin)
                yield _compute_bounds(read.vertices, pose)


def _compute_bounds(vertices: Any, pose: Pose) -> Bounds:
    """Return the bounding box of points, an array of shape (n, 3), at a pose [m]."""
    low, high = [], []
    for row, shift in zip(pose.rotation, pose.translation, strict=True):
        along = vertices @ row
        low.append(float(along.min()) + shift)
        high.append(float(along.max()) + shift)
    return Bounds((low[0], low[1], low[2]), (high[0], high[1], high[2]))
