"""One mesh file as visual and as collision geometry of a link, at two places."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...model.elements import Collision, Link, Mesh, Robot, Vector, Visual
from ...model.pose import Pose, Rotation, matrix_product, pose_of, transpose
from ..fix import FixContext, Proposal, unsafe
from ..mesh.outlines import outline_of, reaches
from ..rule import UNSAFE, WARNING, Problem, rule
from ..shape_changes import copy_origin

APPLIES_TO = ("mesh",)

_SYMMETRY = 0.03
"""Largest difference of the extents of a mesh and of the mesh turned, relative to its diagonal, at
which the two are one shape; the extents are known to about one percent."""


class Displaced(NamedTuple):
    """A collision mesh and the visual of the same file that it should coincide with."""

    visual: Visual
    collision: Collision
    distance: float
    """Between their origins [m]."""
    angle: float
    """Between their orientations [rad]."""


@rule(
    WARNING,
    effects={"pybullet, mujoco": "make contact where the collision is, away from the visual"},
)
def collision_mesh_displaced(
    robot: Robot, *, distance: float = 1e-4, angle: float = 1e-3
) -> Iterator[Problem]:
    """A link uses one mesh file as visual and as collision geometry, at different places.

    The file has one frame, so both need the same ``<origin>``. Often the collision lost the
    ``<origin>`` of the visual, or an angle was written into its ``xyz``. Contacts then occur where
    nothing is drawn. A mesh that is only turned, and looks the same afterwards, such as a wheel, is
    ignored. ``distance`` [m] and ``angle`` [rad] are the differences that are ignored.
    """
    for link in robot.links:
        for found in displaced(robot, link, distance, angle):
            mesh = found.collision.geometry
            assert isinstance(mesh, Mesh)
            apart = []
            if found.distance > distance:
                apart.append(f"{found.distance:.3g} m away from it")
            if found.angle > angle:
                apart.append(f"turned by {math.degrees(found.angle):.3g}°")
            yield Problem(
                link,
                f"collision mesh of link '{link.name}' is the file of its visual, "
                f"but {' and '.join(apart)}; give both the same <origin>",
                at=found.collision.origin or found.collision,
                data={"distance": found.distance, "angle": found.angle},
            )


@collision_mesh_displaced.fix(UNSAFE)
def copy_origin_by_center_of_mass(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the origin of the one that the center of mass is at to the other."""
    link, robot = context.link(problem), context.robot
    found = next(
        (
            pair
            for pair in displaced(robot, link)
            if (pair.collision.origin or pair.collision).place == problem.place
        ),
        None,
    )
    com = link.inertial.origin.xyz if link.inertial and link.inertial.origin else None
    if found is None or com is None or not any(com):
        return None  # a center of mass at the frame may be missing as well
    boxes = [reaches(robot).shape(shape) for shape in (found.visual, found.collision)]
    if boxes[0] is None or boxes[1] is None:
        return None
    visual, collision = (math.dist(com, box.centre) for box in boxes if box is not None)
    if 2 * visual < collision:
        change = copy_origin(found.collision, found.visual)
        return unsafe("give it the <origin> of the visual", change)
    if 2 * collision < visual:
        change = copy_origin(found.visual, found.collision)
        return unsafe("give the visual the <origin> of the collision", change)
    return None


def displaced(
    robot: Robot, link: Link, distance: float = 1e-4, angle: float = 1e-3
) -> list[Displaced]:
    """List the collision meshes of a link that are not where the visual of the same file is.

    Each is paired with the nearest visual of that file without a collision of its own. A collision
    mesh without such a visual is a deliberate copy, and not listed.
    """
    free = [visual for visual in link.visuals if isinstance(visual.geometry, Mesh)]
    unmatched = []
    for collision in link.collisions:
        if not free or not isinstance(collision.geometry, Mesh):
            continue
        same = [visual for visual in free if _same_mesh(visual.geometry, collision.geometry)]
        match = next(
            (visual for visual in same if _coincide(robot, visual, collision, distance, angle)),
            None,
        )
        if match is not None:
            free.remove(match)
        elif same:
            unmatched.append(collision)
    found = []
    for collision in unmatched:
        pairs = [
            Displaced(visual, collision, *_difference(visual, collision))
            for visual in free
            if _same_mesh(visual.geometry, collision.geometry)
        ]
        if pairs:
            best = min(pairs, key=lambda pair: (pair.distance, pair.angle))
            free.remove(best.visual)
            found.append(best)
    return found


def _same_mesh(one: object, other: object) -> bool:
    return (
        isinstance(one, Mesh)
        and isinstance(other, Mesh)
        and one.filename == other.filename
        and one.scale == other.scale
    )


def _difference(visual: Visual, collision: Collision) -> tuple[float, float]:
    """Distance [m] and angle [rad] between two origins."""
    one, other = pose_of(visual.origin), pose_of(collision.origin)
    return math.dist(one.translation, other.translation), _angle(one.rotation, other.rotation)


def _angle(one: Rotation, other: Rotation) -> float:
    """Angle of the rotation between two orientations [rad], exact also where it is small."""
    (_, b, c), (d, _, f), (g, h, _) = between = matrix_product(transpose(one), other)
    cosine = (between[0][0] + between[1][1] + between[2][2] - 1) / 2
    return math.atan2(math.hypot(h - f, c - g, d - b) / 2, cosine)


def _coincide(
    robot: Robot, visual: Visual, collision: Collision, distance: float, angle: float
) -> bool:
    """Whether two uses of one mesh are one shape in one place.

    Of a mesh that cannot be read and is turned this cannot be known, and is assumed.
    """
    apart, turned = _difference(visual, collision)
    if turned <= angle:
        return apart <= distance
    use = reaches(robot).use_of(collision)
    outline = outline_of(use) if use is not None else None
    if use is None or outline is None:
        return True
    a, b, c = use.mesh.scale
    points: list[Vector] = [(a * x, b * y, c * z) for x, y, z in outline.points]
    one, other = pose_of(visual.origin), pose_of(collision.origin)
    diagonal = math.dist(*(tuple(map(f, zip(*points, strict=True))) for f in (min, max)))
    return all(
        abs(_extent(points, one, way) - _extent(points, other, way))
        <= max(distance, _SYMMETRY * diagonal)
        for way in _ways()
    )


def _ways() -> list[Vector]:
    from ...geometry.convex_points import directions

    return directions()


def _extent(points: list[Vector], pose: Pose, way: Vector) -> float:
    """How far a placed mesh extends along a direction [m]."""
    back = transpose(pose.rotation)
    a, b, c = (sum(x * y for x, y in zip(row, way, strict=True)) for row in back)
    offset = sum(x * y for x, y in zip(pose.translation, way, strict=True))
    return max(a * x + b * y + c * z for x, y, z in points) + offset
