"""Rules on wheel drives, compared with the wheels of the robot."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from ...model.elements import Robot, Vector
from ...model.kinematics import get_zero_poses
from ...model.pose import compute_dot, compute_norm
from ..mesh.link_extents import ShapeKind, get_extents
from ..rule import GAZEBO, ROS, WARNING, Problem, rule
from ..symmetry import get_sides
from .contact import is_wheel
from .drive_wheels import ConfiguredLength, Drive, Pair, Wheel, find_drives, get_wheel
from .wheel_pair import compute_radius

APPLIES_TO = ("plugin", "ros2_control", "transmission")

_SLIP = 2.5
"""Factor of the separation up to which a skid-steer base is not reported: its wheels slip, so it is
often configured with a larger one. Chosen, no source.
"""


@rule(
    WARNING,
    on=(*ROS, *GAZEBO),
    effects={
        "gz, gazebo-classic": (
            "pass the sizes on as written: the robot drives and turns by other amounts than "
            "commanded"
        ),
    },
)
def drive_size_mismatch(
    robot: Robot, *, apart: float = 0.05, round: float = 0.15
) -> Iterator[Problem]:
    """The wheel separation or radius of a drive differs from the wheels of the robot.

    The drive computes wheel velocities and odometry from them. Common mistakes are half the
    separation, or the diameter in place of the radius: both are a factor of two. The separation is
    accepted between the inner and the outer edges of the wheels, with a tolerance of ``apart`` (a
    part of it); the radius with a tolerance of ``round``. The separation of skid-steer drives may
    be larger, because the wheels slip. Links that are fixed to a wheel, such as a tire, are part of
    it. Checked are plugins, and ``diff_drive_controller`` in the controller files of the robot (see
    ``controller-unknown-joint``), with its multipliers.
    """
    for drive in find_drives(robot):
        for length, pair in drive.separations:
            yield from _check_separation(
                robot, drive, length, pair, apart, _SLIP if drive.skids else 1.0
            )
        for length, wheel in drive.sizes:
            yield from _check_radius(robot, drive, length, wheel, round)


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "keep the axis as written: the wheels turn in opposite directions",
    },
)
def drive_direction_mismatch(robot: Robot) -> Iterator[Problem]:
    """The wheels of a drive turn in a different direction than the drive assumes.

    To move ahead, the plugin, or a ``diff_drive_controller`` in Gazebo, gives the joints of both
    sides the same velocity, and assumes axes that point to the left of the robot. If the axes point
    in opposite directions, the robot turns on the spot; if both point to the right, or left and
    right are exchanged, it moves backward. The ``rpy`` of a joint also rotates its axis. If the
    controller file of simulated ``<ros2_control>`` is unknown, left and right are recognized by
    wheel names, and only opposite axes are reported.
    """
    seen: set[str] = set()
    for drive in find_drives(robot):
        if not drive.turns:
            continue
        for left, right in drive.pairs:
            seen |= {left.joint.name, right.joint.name}
            to_the_left = _get_offset(right, left)
            length = compute_norm(to_the_left)
            if length < 1e-6:
                continue
            one, other = (compute_dot(wheel.axis, to_the_left) / length for wheel in (left, right))
            if min(abs(one), abs(other)) < 0.7:
                continue
            if (one > 0) != (other > 0):
                yield _report_opposite_axes(left, right, one, drive.name)
            elif one < 0:
                yield Problem(
                    drive.subject,
                    f"{drive.name} has '{left.joint.name}' as left wheel, but both axes point to "
                    "the right; exchange the wheels, or reverse both axes",
                    at=drive.named,
                )
                break
    for left, right in _find_commanded_pairs(robot):
        if left.joint.name not in seen and compute_dot(left.axis, right.axis) < -0.7:
            ahead = compute_dot(left.axis, _get_offset(right, left))
            yield _report_opposite_axes(left, right, ahead, "a diff_drive_controller")


def _get_offset(one: Wheel, other: Wheel) -> Vector:
    (a, b, c), (d, e, f) = one.pose.translation, other.pose.translation
    return d - a, e - b, f - c


def _report_opposite_axes(left: Wheel, right: Wheel, to_the_left: float, driver: str) -> Problem:
    wrong = left if to_the_left < 0 else right
    return Problem(
        wrong.joint,
        f"axes of '{left.joint.name}' and '{right.joint.name}' point in opposite directions, so "
        f"{driver} turns the robot on the spot; reverse the axis of '{wrong.joint.name}'",
        at=wrong.joint.axis or wrong.joint,
    )


def _find_commanded_pairs(robot: Robot) -> Iterator[Pair]:
    """Yield left and right wheels whose velocity simulated ros2_control commands."""
    driven = {
        part.name
        for control in robot.ros2_controls
        if "_ros2_control/" in (control.plugin or "")
        for part in control.components
        if any(interface.name == "velocity" for interface in part.command_interfaces)
    }
    if len(driven) < 2:
        return
    poses = get_zero_poses(robot)
    for pair in get_sides(robot).pairs:
        wheels = [get_wheel(robot, poses, j.name) for j in (pair.left_joint, pair.right_joint)]
        rolls = is_wheel(robot, pair.left) and is_wheel(robot, pair.right)
        named = {pair.left_joint.name, pair.right_joint.name} <= driven
        if rolls and named and wheels[0] is not None and wheels[1] is not None:
            yield wheels[0], wheels[1]


def _check_separation(
    robot: Robot, drive: Drive, length: ConfiguredLength, pair: Pair, tolerance: float, slip: float
) -> Iterator[Problem]:
    along = pair[0].axis
    if abs(compute_dot(along, pair[1].axis)) < 0.95:
        return
    joints = [compute_dot(along, wheel.pose.translation) for wheel in pair]
    between = abs(joints[0] - joints[1])
    middles, inner, outer = between, between, between
    spans = [_compute_extent(robot, wheel, along) for wheel in pair]
    if spans[0] is not None and spans[1] is not None:
        (a, b), (c, d) = sorted((spans[0], spans[1]))
        middles, inner, outer = (c + d - a - b) / 2, min(between, c - b), max(between, d - a)
    low, high = inner * (1 - tolerance), outer * slip * (1 + tolerance)
    if any(low <= abs(one) <= high for one in (length.value, length.meant)) or middles < 1e-6:
        return
    half = ", twice that" if abs(length.value - middles / 2) < 0.05 * middles else ""
    yield Problem(
        drive.subject,
        f"{length.word} of {drive.name} is {length.value:.4g} m, but wheels '{pair[0].name}' "
        f"and '{pair[1].name}' are {middles:.4g} m apart{half}; write {middles:.4g}",
        at=length.place,
        data={"parameter": length.word.strip("<>"), "written": length.value, "measured": middles},
    )


def _check_radius(
    robot: Robot, drive: Drive, length: ConfiguredLength, wheel: Wheel, part: float
) -> Iterator[Problem]:
    link, per_radius = robot.link[wheel.name], length.per_radius
    axis = wheel.joint.axis.xyz if wheel.joint.axis is not None else (1.0, 0.0, 0.0)
    reach = get_extents(robot)
    kinds: tuple[ShapeKind, ...] = ("collisions", "visuals")
    boxes = [reach.get_body_box(link, kind) for kind in kinds]
    found = [radius for box in boxes if box and (radius := compute_radius(box, axis))]
    if not found:
        return
    # a hub may have a cap, or carry a part that is not round
    members = reach.get_attached(link)
    for member in members if len(members) > 1 else ():
        for kind in kinds:
            box = reach.get_body_box(link, kind, [member])
            radius = compute_radius(box, axis) if box is not None else None
            found += [] if radius is None else [radius]
    written = {length.value / per_radius, length.meant / per_radius}
    if any(abs(one - radius) <= part * radius for radius in found for one in written):
        return
    right = found[0] * per_radius
    word, other = ("diameter", "radius") if per_radius == 2 else ("radius", "diameter")
    mistaken = found[0] * (3 - per_radius)
    also = f"; the value is its {other}" if abs(length.value - mistaken) <= 0.05 * mistaken else ""
    yield Problem(
        drive.subject,
        f"{length.word} of {drive.name} is {length.value:.4g} m, but wheel '{wheel.name}' has "
        f"a {word} of {right:.4g} m{also}; write {right:.4g}",
        at=length.place,
        data={"parameter": length.word.strip("<>"), "written": length.value, "measured": right},
    )


def _compute_extent(robot: Robot, wheel: Wheel, along: Vector) -> tuple[float, float] | None:
    """Compute the extent of a wheel along a direction of the root's frame [m]."""
    link = robot.link[wheel.name]
    reach = get_extents(robot)
    box = reach.get_body_box(link, "collisions") or reach.get_body_box(link, "visuals")
    if box is None:
        return None
    (a, b, c), (d, e, f) = box
    corners = product((a, d), (b, e), (c, f))
    places = [compute_dot(along, wheel.pose.transform(corner)) for corner in corners]
    return min(places), max(places)
