"""Find mesh files that are visual and collision geometry of a link at two places."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...model.elements import Collision, Link, Mesh, Robot, Vector, Visual
from ...model.pose import Pose, Rotation, make_pose, multiply_matrices, transpose
from ..fix import FixContext, Proposal, unsafe
from ..mesh.link_extents import get_convex_points, get_extents
from ..rule import ANY_FORMAT, UNSAFE, WARNING, Problem, rule
from ..shape_changes import copy_origin

APPLIES_TO = ("mesh",)

_SYMMETRY = 0.03
"""Largest difference in extent between a mesh and the same mesh rotated, relative to its diagonal,
at which the two count as one shape; the extents are known to about one percent."""


class DisplacedMesh(NamedTuple):
    """A collision mesh and the visual of the same file that it should coincide with."""

    visual: Visual
    collision: Collision
    distance: float
    """Distance between their origins [m]."""
    angle: float
    """Angle between their orientations [rad]."""


@rule(
    WARNING,
    effects={"pybullet, mujoco": "make contact at the collision, away from the visual"},
    formats=ANY_FORMAT,
)
def collision_mesh_displaced(
    robot: Robot, *, distance: float = 1e-4, angle: float = 1e-3
) -> Iterator[Problem]:
    """A link uses one mesh file as visual and as collision geometry, at different places.

    The file has one frame, so both need the same ``<origin>``. Usually the collision lost the
    ``<origin>`` of the visual, or an angle was written into its ``xyz``. Contacts then occur away
    from the visible geometry. A mesh that looks the same after its rotation, such as a wheel, is
    ignored. ``distance`` [m] and ``angle`` [rad] are the tolerated differences.
    """
    for link in robot.links:
        for found in find_displaced(robot, link, distance, angle):
            mesh = found.collision.geometry
            assert isinstance(mesh, Mesh)
            differences = []
            if found.distance > distance:
                differences.append(f"offset by {found.distance:.3g} m")
            if found.angle > angle:
                differences.append(f"rotated by {math.degrees(found.angle):.3g}°")
            pose = "<origin>" if link.xml is not None else "pose"
            yield Problem(
                link,
                f"collision of link '{link.name}' uses the mesh of its visual, but is "
                f"{' and '.join(differences)}; give both the same {pose}",
                at=found.collision.origin or found.collision,
                data={"distance": found.distance, "angle": found.angle},
            )


@collision_mesh_displaced.fix(UNSAFE)
def copy_origin_by_center_of_mass(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the origin that agrees with the center of mass to the other geometry."""
    link, robot = context.get_link(problem), context.robot
    found = next(
        (
            pair
            for pair in find_displaced(robot, link)
            if (pair.collision.origin or pair.collision).place == problem.place
        ),
        None,
    )
    com = link.inertial.origin.xyz if link.inertial and link.inertial.origin else None
    if found is None or com is None or not any(com):
        return None  # the origin of the center of mass may be missing too
    boxes = [get_extents(robot).get_shape_box(shape) for shape in (found.visual, found.collision)]
    if boxes[0] is None or boxes[1] is None:
        return None
    visual, collision = (math.dist(com, box.center) for box in boxes if box is not None)
    if 2 * visual < collision:
        change = copy_origin(found.collision, found.visual)
        return unsafe("copy the <origin> of the visual", change)
    if 2 * collision < visual:
        change = copy_origin(found.visual, found.collision)
        return unsafe("copy the <origin> of the collision to the visual", change)
    return None


def find_displaced(
    robot: Robot, link: Link, distance: float = 1e-4, angle: float = 1e-3
) -> list[DisplacedMesh]:
    """List the collision meshes of a link that are away from the visual of the same file.

    Each is paired with the nearest visual of that file without a collision of its own. A collision
    mesh without such a visual is an intended copy, and not listed.
    """
    free = [visual for visual in link.visuals if isinstance(visual.geometry, Mesh)]
    unmatched = []
    for collision in link.collisions:
        if not free or not isinstance(collision.geometry, Mesh):
            continue
        same = [visual for visual in free if _is_same_mesh(visual.geometry, collision.geometry)]
        match = next(
            (
                visual
                for visual in same
                if _is_coincident(robot, visual, collision, distance, angle)
            ),
            None,
        )
        if match is not None:
            free.remove(match)
        elif same:
            unmatched.append(collision)
    found = []
    for collision in unmatched:
        pairs = [
            DisplacedMesh(visual, collision, *_compute_difference(visual, collision))
            for visual in free
            if _is_same_mesh(visual.geometry, collision.geometry)
        ]
        if pairs:
            best = min(pairs, key=lambda pair: (pair.distance, pair.angle))
            free.remove(best.visual)
            found.append(best)
    return found


def _is_same_mesh(one: object, other: object) -> bool:
    return (
        isinstance(one, Mesh)
        and isinstance(other, Mesh)
        and one.filename == other.filename
        and one.scale == other.scale
    )


def _compute_difference(visual: Visual, collision: Collision) -> tuple[float, float]:
    """Compute distance [m] and angle [rad] between two origins."""
    one, other = make_pose(visual.origin), make_pose(collision.origin)
    return math.dist(one.translation, other.translation), _compute_angle(
        one.rotation, other.rotation
    )


def _compute_angle(one: Rotation, other: Rotation) -> float:
    """Compute the angle between two orientations [rad], accurate for small angles too."""
    (_, b, c), (d, _, f), (g, h, _) = between = multiply_matrices(transpose(one), other)
    cosine = (between[0][0] + between[1][1] + between[2][2] - 1) / 2
    return math.atan2(math.hypot(h - f, c - g, d - b) / 2, cosine)


def _is_coincident(
    robot: Robot, visual: Visual, collision: Collision, distance: float, angle: float
) -> bool:
    """Tell whether two uses of one mesh look the same.

    For a mesh that is rotated and unreadable this is assumed.
    """
    offset, turned = _compute_difference(visual, collision)
    if turned <= angle:
        return offset <= distance
    use = get_extents(robot).get_use(collision)
    outline = get_convex_points(use) if use is not None else None
    if use is None or outline is None:
        return True
    a, b, c = use.mesh.scale
    points: list[Vector] = [(a * x, b * y, c * z) for x, y, z in outline.points]
    one, other = make_pose(visual.origin), make_pose(collision.origin)
    diagonal = math.dist(*(tuple(map(f, zip(*points, strict=True))) for f in (min, max)))
    return all(
        abs(_compute_extent(points, one, way) - _compute_extent(points, other, way))
        <= max(distance, _SYMMETRY * diagonal)
        for way in _make_directions()
    )


def _make_directions() -> list[Vector]:
    from ...geometry.convex_points import compute_directions

    return compute_directions()


def _compute_extent(points: list[Vector], pose: Pose, way: Vector) -> float:
    """Compute the extent of a placed mesh along a direction [m]."""
    back = transpose(pose.rotation)
    a, b, c = (sum(x * y for x, y in zip(row, way, strict=True)) for row in back)
    offset = sum(x * y for x, y in zip(pose.translation, way, strict=True))
    return max(a * x + b * y + c * z for x, y, z in points) + offset
