"""Quality of a robot's existing collision geometry, compared with its visuals, by link."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import MeshError, UrdftoolError
from ..geometry.load import FARTHEST
from ..geometry.mesh import Points
from ..geometry.tessellate import tessellate
from ..model.elements import Box, Capsule, Cone, Cylinder, Ellipsoid, Link, Mesh, Robot, Sphere
from ..model.pose import Pose, make_pose
from ..parallel import Loss, count_cores, map_tasks
from ..source.description import GltfUp
from .convex import compute_hull, compute_planes, measure_plane_distance
from .links import Shape
from .measure import ReferenceSurface, measure
from .parallel import Progress
from .piece import Piece, make_mesh_piece, make_primitive
from .surface import Prepared, prepare, read_surface

# chosen, no source, where a line gives none
_CONVEX = 1e-3
"""Depth of a corner below its hull, relative to the size, up to which a mesh is convex; chosen, no
source."""
_FEW = 500  # midpoints that are tested first


@dataclass(frozen=True)
class Checked:
    """Quality of a link's collision geometry.

    Attributes:
        link: Name of the link.
        measures: As :meth:`Measures.as_dict`, with each mesh as written; None if there is nothing
            to compare.
        trouble: Reason why it was not measured, or empty.
        max_error: Largest acceptable error, relative to the size.
        lacks_collision: Whether that is the reason: the link has no collision geometry.
        concave: Number of collision meshes that are not convex.
        hull_error: Error if engines use the hulls of those, as PyBullet and MuJoCo do for moving
            bodies; None if there are none.
    """

    link: str
    measures: dict[str, Any] | None
    trouble: str = ""
    concave: int = 0
    hull_error: float | None = None
    lacks_collision: bool = False
    max_error: float = 0.05

    @property
    def is_good(self) -> bool:
        """Tell whether the link has collision geometry within the error of its visual."""
        return self.measures is not None and self.measures["error"] <= self.max_error

    @property
    def is_above(self) -> bool:
        """Tell whether the link has collision geometry with a larger error."""
        return self.measures is not None and not self.is_good

    @property
    def is_unmeasured(self) -> bool:
        """Tell whether nothing is known: shapes of the link could not be read or measured."""
        return self.measures is None and not self.lacks_collision


@dataclass(frozen=True)
class Part:
    """A shape in the frame of its link: kind and lengths [m] of a primitive, or a mesh file."""

    pose: Pose
    kind: str
    size: tuple[float, ...]
    path: Path | None = None
    gltf_up: GltfUp = "y"


@dataclass(frozen=True)
class Look:
    """Shapes of a link to be measured, in a form that can be sent to another process."""

    link: str
    visuals: tuple[Part, ...]
    collisions: tuple[Part, ...]
    trouble: str = ""
    max_error: float = 0.05

    @property
    def lacks_collision(self) -> bool:
        """Tell whether the link has visuals, and no collision geometry."""
        return bool(self.visuals) and not self.collisions


def look_at(robot: Robot, link: Link, max_error: float = 0.05) -> Look | None:
    """Collect the shapes of a link to be measured; None if it has no visual."""
    try:
        visuals = tuple(part for shape in link.visuals for part in _list_parts(robot, shape))
        collisions = tuple(part for shape in link.collisions for part in _list_parts(robot, shape))
    except UrdftoolError as error:
        return Look(link.name, (), (), str(error), max_error)
    if not visuals:
        return None
    if not collisions:
        shapeless = "its collisions have no shape" if link.collisions else "it has no collision"
        return Look(link.name, visuals, (), shapeless, max_error)
    return Look(link.name, visuals, collisions, max_error=max_error)


def check_all(
    looks: Sequence[Look], *, jobs: int | None = None, progress: Progress | None = None
) -> list[Checked]:
    """Measure the collision geometry of links, several at a time."""

    def under_way(done: int, now: Sequence[Look]) -> None:
        if progress is not None:
            progress(done, len(looks), [look.link for look in now])

    found: list[Checked | None] = [None] * len(looks)
    workers = jobs or count_cores()
    for index, checked in map_tasks(
        check_link, looks, workers=workers, on_lost=_make_failure, on_progress=under_way
    ):
        found[index] = checked
    return [checked for checked in found if checked is not None]


def _make_failure(look: Look, _: Loss) -> Checked:
    return Checked(look.link, None, "the process that measured it was killed twice")


def check_link(look: Look) -> Checked:
    """Measure the collision geometry of a link; errors become ``Checked.trouble``."""
    return replace(_measure_link(look), max_error=look.max_error)


def _measure_link(look: Look) -> Checked:
    if look.trouble:
        return Checked(look.link, None, look.trouble, lacks_collision=look.lacks_collision)
    try:
        visual = _prepare_visual(look.visuals)
        if visual is None:
            return Checked(look.link, None, "its visuals have no area")
        target = ReferenceSurface(visual)
        pieces = [_convert_part(part) for part in look.collisions]
        found = measure(target, pieces).as_dict()
        concave = sum(piece.kind == "mesh" for piece in pieces)
        if not concave:
            return Checked(look.link, found)
        hulls = [
            make_mesh_piece(*compute_hull(p.vertices)) if p.kind == "mesh" else p for p in pieces
        ]
        return Checked(look.link, found, "", concave, measure(target, hulls).error)
    except UrdftoolError as error:
        return Checked(look.link, None, str(error))
    except (MemoryError, RecursionError) as error:
        return Checked(look.link, None, f"it is too large to be measured ({type(error).__name__})")


def _prepare_visual(parts: Sequence[Part]) -> Prepared | None:
    vertices, faces, first = [], [], 0
    for part in parts:
        piece = _convert_part(part, told=False)
        vertices.append(piece.vertices)
        faces.append(piece.faces + first)
        first += len(piece.vertices)
    return prepare(np.concatenate(vertices), np.concatenate(faces))


def convert_shape(robot: Robot, shape: Shape) -> list[Piece]:
    """Convert a shape to pieces in the link's frame; a mesh counts as concave.

    Raises:
        UrdftoolError: Its mesh cannot be read.
    """
    return [_convert_part(part, told=False) for part in _list_parts(robot, shape)]


def _list_parts(robot: Robot, shape: Shape) -> Iterator[Part]:
    """Yield a shape as written; nothing if its geometry is missing or unknown."""
    geometry, pose = shape.geometry, make_pose(shape.origin)
    if isinstance(geometry, Box):
        yield Part(pose, "box", geometry.size)
    elif isinstance(geometry, Cylinder):
        yield Part(pose, "cylinder", (geometry.radius, geometry.length))
    elif isinstance(geometry, Capsule):
        yield Part(pose, "capsule", (geometry.radius, geometry.length))
    elif isinstance(geometry, Sphere):
        yield Part(pose, "sphere", (geometry.radius,))
    elif isinstance(geometry, Ellipsoid):
        yield Part(pose, "ellipsoid", geometry.radii)
    elif isinstance(geometry, Cone):
        yield Part(pose, "cone", (geometry.radius, geometry.length))
    elif isinstance(geometry, Mesh):
        assert robot.source is not None
        path = Path(robot.source.resolve(geometry.filename))
        yield Part(pose, "mesh", geometry.scale, path, robot.source.gltf_up)


def _convert_part(part: Part, *, told: bool = True) -> Piece:
    """Convert a shape to a piece in the link's frame.

    Args:
        part: The shape.
        told: Whether to test a mesh for convexity, which is slow; if not, it counts as concave.

    Raises:
        MeshError: The mesh cannot be read, or the shape is too large.
    """
    rotation = np.array(part.pose.rotation, dtype=np.float64)
    xyz = np.array(part.pose.translation, dtype=np.float64)
    far = max(map(abs, (*part.pose.translation, *(() if part.path else part.size))))
    if not far < FARTHEST:
        raise MeshError(f"its {part.kind} reaches {far:.3g} m, which is not measured")
    if part.kind in ("ellipsoid", "cone"):
        return make_mesh_piece(*tessellate(part.kind, part.size)).transform(rotation, xyz)
    if part.path is None:
        return make_primitive(part.kind, part.size, rotation, xyz)
    x, y, z = part.size
    surface = read_surface(part.path, (x, y, z), part.gltf_up)
    piece = make_mesh_piece(surface.vertices, surface.faces, convex=told and _is_convex(surface))
    return piece.transform(rotation, xyz)


def _is_convex(surface: Prepared) -> bool:
    """Tell whether a closed surface is its own convex hull."""
    if not surface.closed:
        return False
    try:
        sides = compute_planes(*compute_hull(surface.vertices))
    except UrdftoolError:
        return False
    middles: Points = surface.corners.mean(axis=1)
    some = middles[:: max(1, len(middles) // _FEW)]  # a few points reject most concave meshes
    most = -_CONVEX * surface.size
    return all(measure_plane_distance(points, sides).min() > most for points in (some, middles))
