"""Determine the axle of a wheel from its joint, shapes, inertia and position."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from ...mechanics.spatial_inertia import combine_links
from ...mechanics.tensor import compute_principal_moments
from ...model.attached import Attached, find_attached_links
from ...model.elements import Collision, Cylinder, Joint, Link, Mesh, Robot, Vector, Visual
from ...model.kinematics import get_limits
from ...model.pose import compute_dot, compute_norm, make_pose, rotate, transpose
from ...model.read import parse_numbers
from ..mesh.link_extents import get_extents
from ..symmetry import get_sides

_WHEEL = re.compile(r"wheel|tire|tyre|caster", re.IGNORECASE)
_STEERS = re.compile(r"steer|swivel|rotation|yaw", re.IGNORECASE)
TWIN_POSITION = "the position of its twin"
VISUAL = "its visual"
_ROUND = 0.05
"""Relative difference of two equal lengths or moments of a wheel. Chosen, no source."""


class AxleDirection(NamedTuple):
    """A source of the direction of a wheel's axle.

    Attributes:
        what: Name of the source.
        along: Direction of the axle, of length 1, in the frame of the wheel's link.
    """

    what: str
    along: Vector


class Wheel(NamedTuple):
    """A wheel with one cylinder to roll on."""

    joint: Joint
    link: Link
    shape: Cylinder
    kind: Visual | Collision
    axis: AxleDirection
    cylinder: AxleDirection
    others: list[AxleDirection]


def get_wheel(robot: Robot, joint: Joint) -> Wheel | None:
    """Get the wheel of a joint; None if the joint has none, or nothing can be compared."""
    link = robot.link.get(joint.child)
    if link is None or not _is_continuous(joint) or _STEERS.search(link.name + joint.name):
        return None
    written = None if joint.axis is None else joint.axis.xml
    if written is not None and parse_numbers(written.get("xyz"), 3) is None:
        return None  # an unreadable axis, which the default replaces
    members = find_attached_links(robot, link)
    if not any(_WHEEL.search(member.name + joint.name) for member, _ in members):
        return None
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    discs = [
        (member, shape, collision, rotate((pose @ make_pose(collision.origin)).rotation, _Z))
        for member, pose in members
        for collision in member.collisions
        if isinstance(shape := collision.geometry, Cylinder)
    ]
    if (
        compute_norm(axis) < 1e-6
        or len(discs) != 1
        or sum(len(m.collisions) for m, _ in members) != 1
    ):
        return None
    member, shape, collision, along = discs[0]
    if shape.length > 4 * shape.radius:
        return None
    others = [
        _get_visual_direction(robot, members),
        _get_inertia_direction(members),
        _get_position_direction(robot, joint),
    ]
    return Wheel(
        joint,
        member,
        shape,
        collision,
        AxleDirection(f"the axis of '{joint.name}'", _normalize(axis)),
        AxleDirection("its collision", along),
        [saying for saying in others if saying is not None],
    )


_Z: Vector = (0.0, 0.0, 1.0)
"""Axis of a cylinder in its own frame."""


def compute_angle(one: Vector, other: Vector) -> float:
    """Compute the angle between two lines [degrees], at most 90."""
    return math.degrees(math.acos(min(1.0, abs(compute_dot(one, other)))))


def select_agreeing(
    sayings: Sequence[AxleDirection], along: Vector, within: float
) -> list[AxleDirection]:
    """Select the sources whose direction is within an angle [degrees] of a direction."""
    return [saying for saying in sayings if compute_angle(saying.along, along) <= within]


def is_upright(robot: Robot, joint: Joint, along: Vector) -> bool:
    """Tell whether a line of a joint's child points up in the root frame, with joints at zero."""
    rotation = make_pose(joint.origin).rotation
    line = rotate(rotation, along)
    name, seen = joint.parent, {joint.child}
    above = robot.tree.get_parent_joint(name)
    while above is not None and name not in seen:
        seen.add(name)
        line = rotate(make_pose(above.origin).rotation, line)
        name = above.parent
        above = robot.tree.get_parent_joint(name)
    return abs(line[2]) > 0.9


def _is_continuous(joint: Joint) -> bool:
    """Tell whether a joint is continuous, or revolute without limits."""
    if joint.type == "continuous":
        return True
    if joint.type != "revolute":
        return False
    limit = joint.limit
    if limit is None or limit.lower is None or limit.upper is None:
        return True
    lower, upper = get_limits(joint)
    return upper <= lower or upper - lower >= 2 * math.pi


def _get_visual_direction(robot: Robot, members: Attached) -> AxleDirection | None:
    """Get the direction of the only visual of a wheel: a cylinder, or a round mesh."""
    shown = [(member, pose, visual) for member, pose in members for visual in member.visuals]
    discs = [one for one in shown if isinstance(one[2].geometry, Cylinder)]
    if len(discs) == 1:
        _, pose, visual = discs[0]
        assert isinstance(visual.geometry, Cylinder)
        if visual.geometry.length > 4 * visual.geometry.radius:
            return None
        return AxleDirection(VISUAL, rotate((pose @ make_pose(visual.origin)).rotation, _Z))
    if len(shown) != 1 or not isinstance(shown[0][2].geometry, Mesh):
        return None
    member, pose, _ = shown[0]
    box = get_extents(robot).get_shapes_box(member.visuals)
    axis = _find_odd_length(box.size, 0.8) if box is not None else None
    return (
        None
        if axis is None
        else AxleDirection(VISUAL, rotate(pose.rotation, _get_unit_vector(axis)))
    )


def _get_inertia_direction(members: Attached) -> AxleDirection | None:
    """Get the direction of a wheel's inertia: two moments are equal, and the third is larger."""
    body = combine_links(members)
    six = body.tensor
    if not body.mass or max(map(abs, (six[1], six[2], six[4]))) > _ROUND * max(
        compute_principal_moments(six)
    ):
        return None
    x, y, z = six[0], six[3], six[5]
    if min(x, y, z) <= 0:
        return None
    axis = _find_odd_length((1 / x, 1 / y, 1 / z), 0.9)
    return None if axis is None else AxleDirection("its inertia", _get_unit_vector(axis))


def _get_position_direction(robot: Robot, joint: Joint) -> AxleDirection | None:
    """Get the direction from a wheel to the wheel on the other side of the robot."""
    known = get_sides(robot)
    for pair in known.pairs:
        if joint.child not in (pair.left.name, pair.right.name):
            continue
        if pair.left.name not in known.poses or pair.right.name not in known.poses:
            return None
        a, b = (known.poses[one.name].translation for one in (pair.left, pair.right))
        offset = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
        length = compute_norm(offset)
        if length < 1e-3 or max(map(abs, offset)) < 0.95 * length:
            return None
        turn = transpose(known.poses[joint.child].rotation)
        return AxleDirection(TWIN_POSITION, _normalize(rotate(turn, offset)))
    return None


def _find_odd_length(lengths: Vector, most: float) -> int | None:
    """Find the axis of the one length that is less than two equal ones."""
    for axis, length in enumerate(lengths):
        one, other = (value for i, value in enumerate(lengths) if i != axis)
        if abs(one - other) <= _ROUND * max(one, other) and length < most * min(one, other):
            return axis
    return None


def _normalize(vector: Vector) -> Vector:
    length = compute_norm(vector)
    x, y, z = vector
    return x / length, y / length, z / length


def _get_unit_vector(axis: int) -> Vector:
    return float(axis == 0), float(axis == 1), float(axis == 2)
