"""Plugins that drive on wheels, beside the wheels that the robot has."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

from ...model.bounds import Bounds
from ...model.elements import Joint, Plugin, Robot, Vector
from ...model.kinematics import link_poses
from ...model.pose import Pose, dot, norm, rotate
from ...source.document import Element
from ..mesh.outlines import reaches
from ..rule import GAZEBO, WARNING, Problem, rule
from ..sides import sides
from .contact import contact_role

_SKIDS = re.compile(r"skid[-_]steer")
_DRIVES = re.compile(r"diff[-_]drive|skid[-_]steer")
_ROLLS = re.compile(r"diff[-_]drive|skid[-_]steer|mecanum[-_]drive")
_LEFT = (
    *("left_joint", "leftJoint", "leftFrontJoint", "leftRearJoint"),
    *("front_left_joint", "back_left_joint"),
)
_SEPARATION = ("wheel_separation", "wheelSeparation")
_RADIUS = ("wheel_radius", "wheelRadius")
_DIAMETER = ("wheel_diameter", "wheelDiameter")
_SLIP = 2.5  # a base that skids is often told of a wider track, since it turns less than it rolls


class _Wheel(NamedTuple):
    """A wheel as it stands where all joints are at zero, in the frame of the root [m]."""

    joint: Joint
    pose: Pose
    axis: Vector

    @property
    def name(self) -> str:
        return self.joint.child


@rule(
    WARNING,
    on=GAZEBO,
    effects={"gazebo": "drives and turns by other amounts than told, and its odometry is off"},
)
def drive_size_mismatch(
    robot: Robot, *, apart: float = 0.05, round: float = 0.15
) -> Iterator[Problem]:
    """A drive plugin is told of other wheels than the robot has.

    The plugin works out from the distance of the wheels and from their radius how fast each has to
    turn, and where the robot is. Half the distance, or a diameter written for a radius, is a factor
    of two in both. A distance is let pass from the inner edges of the wheels to the outer, and
    beyond by the part ``apart``, a radius by the part ``round``; the distance of wheels that skid
    may be more than that.
    """
    for plugin, pairs in _drives(robot, _ROLLS):
        skids = len(pairs) > 1 or bool(_SKIDS.search(plugin.filename))
        for index, element in enumerate(_named(plugin, _SEPARATION)):
            pair = pairs[min(index, len(pairs) - 1)]
            yield from _separation(robot, plugin, element, pair, apart, _SLIP if skids else 1.0)
        for names, per_radius in ((_RADIUS, 1), (_DIAMETER, 2)):
            for index, element in enumerate(_named(plugin, names)):
                pair = pairs[min(index, len(pairs) - 1)]
                yield from _radius(robot, plugin, element, pair[0], per_radius, round)


@rule(
    WARNING,
    on=GAZEBO,
    effects={"gazebo": "turns on the spot when it is told to go ahead, or the wrong way"},
)
def drive_direction_mismatch(robot: Robot) -> Iterator[Problem]:
    """The wheels of a drive do not turn the way that its plugin takes for ahead.

    To go ahead the plugin gives the joints of both sides the same velocity, and takes them to turn
    about an axis to the left. With the axes against each other the robot turns on the spot; with
    both to the right, or the sides exchanged, it turns the wrong way. A wheel that is turned over
    by the ``rpy`` of its joint has its axis turned with it. Of simulated ``<ros2_control>``, where
    the sides are told by the names of the wheels, only axes against each other are told.
    """
    for plugin, pairs in _drives(robot, _DRIVES):
        for left, right in pairs:
            to_the_left = _between(right, left)
            length = norm(to_the_left)
            if length < 1e-6:
                continue
            one, other = (dot(wheel.axis, to_the_left) / length for wheel in (left, right))
            if min(abs(one), abs(other)) < 0.7:
                continue
            if (one > 0) != (other > 0):
                yield _against(left, right, one, f"plugin '{plugin.name}'")
            elif one < 0:
                yield Problem(
                    plugin.element,
                    f"plugin '{plugin.name}' takes '{left.joint.name}' for the left wheel, and "
                    "both axes point to the other side; exchange the two, or turn both axes",
                    at=_joint_elements(plugin)[0],
                )
                break
    for left, right in _commanded(robot):
        if dot(left.axis, right.axis) < -0.7:
            ahead = dot(left.axis, _between(right, left))
            yield _against(left, right, ahead, "a diff_drive_controller")


def _between(one: _Wheel, other: _Wheel) -> Vector:
    (a, b, c), (d, e, f) = one.pose.translation, other.pose.translation
    return d - a, e - b, f - c


def _against(left: _Wheel, right: _Wheel, to_the_left: float, driver: str) -> Problem:
    wrong = left if to_the_left < 0 else right
    return Problem(
        wrong.joint,
        f"axes of '{left.joint.name}' and '{right.joint.name}' point against each other, so "
        f"{driver} turns the robot where it should go ahead; turn that of '{wrong.joint.name}' "
        "to the left of the robot",
        at=wrong.joint.axis or wrong.joint,
    )


def _commanded(robot: Robot) -> Iterator[tuple[_Wheel, _Wheel]]:
    """A left and a right wheel that simulated ros2_control sets the velocity of."""
    driven = {
        part.name
        for control in robot.ros2_controls
        if "_ros2_control/" in (control.plugin or "")
        for part in control.components
        if any(interface.name == "velocity" for interface in part.command_interfaces)
    }
    if len(driven) < 2:
        return
    poses = link_poses(robot)
    for pair in sides(robot).pairs:
        wheels = [_wheel(robot, poses, j.name) for j in (pair.left_joint, pair.right_joint)]
        rolls = all(contact_role(robot, link) == "wheel" for link in (pair.left, pair.right))
        named = {pair.left_joint.name, pair.right_joint.name} <= driven
        if rolls and named and wheels[0] is not None and wheels[1] is not None:
            yield wheels[0], wheels[1]


def _drives(
    robot: Robot, kind: re.Pattern[str]
) -> Iterator[tuple[Plugin, list[tuple[_Wheel, _Wheel]]]]:
    """The plugins of a kind, each with its pairs of a left and a right wheel."""
    poses: dict[str, Pose] = {}
    for plugin in robot.plugins:
        if not kind.search(plugin.filename.rpartition("/")[2]):
            continue
        poses = poses or link_poses(robot)
        lefts = [(child.tag, child.text.strip()) for child in _joint_elements(plugin)]
        rights = {
            tag: [child.text.strip() for child in plugin.element.all(tag)]
            for tag in {_mirrored(tag) for tag, _ in lefts}
        }
        pairs = []
        for tag, name in lefts:
            others = rights[_mirrored(tag)]
            other = others.pop(0) if others else ""
            wheels = [_wheel(robot, poses, joint) for joint in (name, other)]
            if wheels[0] is not None and wheels[1] is not None:
                pairs.append((wheels[0], wheels[1]))
        if pairs:
            yield plugin, pairs


def _joint_elements(plugin: Plugin) -> list[Element]:
    return _named(plugin, _LEFT)


def _named(plugin: Plugin, names: tuple[str, ...]) -> list[Element]:
    return [child for child in plugin.element.children if child.tag in names]


def _mirrored(tag: str) -> str:
    return tag.replace("left", "right")


def _wheel(robot: Robot, poses: dict[str, Pose], name: str) -> _Wheel | None:
    joint = robot.joint.get(name)
    if joint is None or joint.child not in poses or joint.is_fixed:
        return None
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = norm(axis)
    if not length:
        return None
    pose = poses[joint.child]
    x, y, z = rotate(pose.rotation, axis)
    return _Wheel(joint, pose, (x / length, y / length, z / length))


def _separation(
    robot: Robot,
    plugin: Plugin,
    element: Element,
    pair: tuple[_Wheel, _Wheel],
    tolerance: float,
    slip: float,
) -> Iterator[Problem]:
    told, along = _number(element), pair[0].axis
    if told is None or abs(dot(along, pair[1].axis)) < 0.95:
        return
    joints = [dot(along, wheel.pose.translation) for wheel in pair]
    between = abs(joints[0] - joints[1])
    middles, inner, outer = between, between, between
    spans = [_span(robot, wheel, along) for wheel in pair]
    if spans[0] is not None and spans[1] is not None:
        (a, b), (c, d) = sorted((spans[0], spans[1]))
        middles, inner, outer = (c + d - a - b) / 2, min(between, c - b), max(between, d - a)
    if inner * (1 - tolerance) <= abs(told) <= outer * slip * (1 + tolerance) or middles < 1e-6:
        return
    half = "; that is half of it" if abs(told - middles / 2) < 0.05 * middles else ""
    yield Problem(
        plugin.element,
        f"<{element.tag}> of plugin '{plugin.name}' is {told:.4g} m, and wheels '{pair[0].name}' "
        f"and '{pair[1].name}' are {middles:.4g} m apart{half}; write {middles:.4g}",
        at=element,
    )


def _radius(
    robot: Robot, plugin: Plugin, element: Element, wheel: _Wheel, per_radius: int, part: float
) -> Iterator[Problem]:
    told, link = _number(element), robot.link[wheel.name]
    axis = wheel.joint.axis.xyz if wheel.joint.axis is not None else (1.0, 0.0, 0.0)
    reach = reaches(robot)
    boxes = [reach.shapes(link.collisions), reach.shapes(link.visuals)]
    found = [radius for box in boxes if box and (radius := _radius_about(box, axis))]
    if told is None or not found:
        return
    if any(abs(told / per_radius - radius) <= part * radius for radius in found):
        return
    right = found[0] * per_radius
    word, other = ("diameter", "radius") if per_radius == 2 else ("radius", "diameter")
    mistaken = found[0] * (3 - per_radius)
    also = f"; that is its {other}" if abs(told - mistaken) <= 0.05 * mistaken else ""
    yield Problem(
        plugin.element,
        f"<{element.tag}> of plugin '{plugin.name}' is {told:.4g} m, and wheel '{wheel.name}' has "
        f"a {word} of {right:.4g} m{also}; write {right:.4g}",
        at=element,
    )


def _span(robot: Robot, wheel: _Wheel, along: Vector) -> tuple[float, float] | None:
    """From where to where a wheel lies along a direction of the root's frame [m]."""
    link = robot.link[wheel.name]
    reach = reaches(robot)
    box = reach.shapes(link.collisions) or reach.shapes(link.visuals)
    if box is None:
        return None
    (a, b, c), (d, e, f) = box
    corners = product((a, d), (b, e), (c, f))
    places = [dot(along, wheel.pose.transform(corner)) for corner in corners]
    return min(places), max(places)


def _radius_about(box: Bounds, axis: Vector) -> float | None:
    """Half of how large a box is across an axis [m]; None where it is not round, or lies askew."""
    along = max(range(3), key=lambda i: abs(axis[i]))
    if abs(axis[along]) < 0.99 * norm(axis):
        return None
    one, other = (size for i, size in enumerate(box.size) if i != along)
    return (one + other) / 4 if abs(one - other) <= 0.1 * max(one, other) else None


def _number(element: Element) -> float | None:
    try:
        return float(element.text)
    except ValueError:
        return None
