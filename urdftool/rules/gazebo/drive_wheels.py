"""Find wheel drives, plugins and controllers, with their wheels and configured lengths."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from ...model.elements import Joint, Plugin, Robot, Vector
from ...model.kinematics import get_zero_poses
from ...model.pose import Pose, compute_norm, rotate
from ...model.read import number
from ...source.document import Element
from ...source.location import Place

if TYPE_CHECKING:
    from ...model.controllers import Controller
    from ...source.description import Description
    from ...source.yaml_tree import Node

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


class Wheel(NamedTuple):
    """A wheel in the frame of the root [m], with all joints at 0."""

    joint: Joint
    pose: Pose
    axis: Vector

    @property
    def name(self) -> str:
        """Name of the link."""
        return self.joint.child


Pair = tuple[Wheel, Wheel]
"""A left wheel and the right one."""


class ConfiguredLength(NamedTuple):
    """A length in the parameters of a drive.

    Attributes:
        word: Name of the parameter.
        value: The length [m].
        meant: The length with its multipliers [m].
        place: Location in the file.
        per_radius: 2 for the diameter of a wheel, 1 for its radius.
    """

    word: str
    value: float
    meant: float
    place: Place
    per_radius: int = 1


class Drive(NamedTuple):
    """A plugin or controller that drives wheels.

    Attributes:
        name: Its name, with its kind.
        subject: The element or joint of its findings.
        pairs: The wheels that it drives.
        named: Location of its first wheel name.
        skids: Whether its wheels slip sideways when it turns.
        turns: Whether the robot moves ahead if the wheels of both sides have the same velocity.
        separations: Configured distances, each with its pair of wheels.
        sizes: Configured radii and diameters, each with its wheel.
    """

    name: str
    subject: Element | Joint
    pairs: list[Pair]
    named: Place
    skids: bool
    turns: bool
    separations: list[tuple[ConfiguredLength, Pair]]
    sizes: list[tuple[ConfiguredLength, Wheel]]


def find_drives(robot: Robot) -> Iterator[Drive]:
    """Yield the drives of a robot with known wheels."""
    poses: dict[str, Pose] = {}
    for plugin in robot.plugins:
        if _ROLLS.search(plugin.filename.rpartition("/")[2]):
            poses = poses or get_zero_poses(robot)
            yield from _make_plugin_drive(robot, plugin, poses)
    if robot.source is None or not (robot.ros2_controls or robot.transmissions):
        return
    yield from _find_controller_drives(robot, robot.source, poses)


def _make_plugin_drive(robot: Robot, plugin: Plugin, poses: dict[str, Pose]) -> Iterator[Drive]:
    elements = _find_children(plugin, _LEFT)
    rights = {
        tag: [child.text.strip() for child in plugin.element.list_children(tag)]
        for tag in {_mirror_tag(child.tag) for child in elements}
    }
    pairs = []
    for child in elements:
        others = rights[_mirror_tag(child.tag)]
        other = others.pop(0) if others else ""
        wheels = [get_wheel(robot, poses, name) for name in (child.text.strip(), other)]
        if wheels[0] is not None and wheels[1] is not None:
            pairs.append((wheels[0], wheels[1]))
    if not pairs:
        return
    yield Drive(
        f"plugin '{plugin.name}'",
        plugin.element,
        pairs,
        elements[0].place,
        len(pairs) > 1 or bool(_SKIDS.search(plugin.filename)),
        bool(_DRIVES.search(plugin.filename.rpartition("/")[2])),
        [
            (length, pairs[min(index, len(pairs) - 1)])
            for index, length in _read_lengths(plugin, _SEPARATION, 1)
        ],
        [
            (length, pairs[min(index, len(pairs) - 1)][0])
            for names, per_radius in ((_RADIUS, 1), (_DIAMETER, 2))
            for index, length in _read_lengths(plugin, names, per_radius)
        ],
    )


def _read_lengths(
    plugin: Plugin, names: tuple[str, ...], per_radius: int
) -> Iterator[tuple[int, ConfiguredLength]]:
    for index, element in enumerate(_find_children(plugin, names)):
        value = number(element.text)
        if value is not None:
            yield (
                index,
                ConfiguredLength(f"<{element.tag}>", value, value, element.place, per_radius),
            )


def _find_children(plugin: Plugin, names: tuple[str, ...]) -> list[Element]:
    return [child for child in plugin.element.children if child.tag in names]


def _mirror_tag(tag: str) -> str:
    return tag.replace("left", "right")


def get_wheel(robot: Robot, poses: dict[str, Pose], name: str) -> Wheel | None:
    """Get the wheel that a joint turns; None if there is no such joint, or it is fixed."""
    joint = robot.joint.get(name)
    if joint is None or joint.child not in poses or joint.is_fixed:
        return None
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = compute_norm(axis)
    if not length:
        return None
    pose = poses[joint.child]
    x, y, z = rotate(pose.rotation, axis)
    return Wheel(joint, pose, (x / length, y / length, z / length))


def _find_controller_drives(
    robot: Robot, description: Description, poses: dict[str, Pose]
) -> Iterator[Drive]:
    """Yield the controllers with known wheels, from the controller files of a robot."""
    from ..control.controller_files import get_package

    for file in get_package(robot, description).controller_files:
        for controller in file.controllers:
            if controller.kind == "DiffDriveController":
                poses = poses or get_zero_poses(robot)
                yield from _make_controller_drive(robot, controller, poses)


def _make_controller_drive(
    robot: Robot, controller: Controller, poses: dict[str, Pose]
) -> Iterator[Drive]:
    from ...model.controllers import extract_joint

    sides = [
        [
            (node, get_wheel(robot, poses, extract_joint(node)))
            for end in ("_names", "")
            for node in controller.list_scalars(f"{side}_wheel{end}")
        ]
        for side in ("left", "right")
    ]
    pairs = [
        (left, right)
        for (_, left), (_, right) in zip(*sides, strict=False)
        if left is not None and right is not None
    ]
    if not pairs:
        return
    yield Drive(
        f"controller '{controller.name}'",
        pairs[0][0].joint,
        pairs,
        sides[0][0][0].place,
        len(pairs) > 1 or (_read_value(controller, "wheels_per_side") or 1) > 1,
        _is_simulated(robot),
        [
            (length, pairs[0])
            for length in _read_length(
                controller, "wheel_separation", "wheel_separation_multiplier"
            )
        ],
        [
            (length, pairs[0][0])
            for length in _read_length(
                controller,
                "wheel_radius",
                "wheel_radius_multiplier",
                "left_wheel_radius_multiplier",
            )
        ],
    )


def _read_length(
    controller: Controller, name: str, *multipliers: str
) -> Iterator[ConfiguredLength]:
    for node in controller.list_scalars(name):
        value = _read_number(node)
        if value is not None:
            scaled = value * math.prod(_read_value(controller, word) or 1.0 for word in multipliers)
            yield ConfiguredLength(name, value, scaled, node.place)


def _read_value(controller: Controller, name: str) -> float | None:
    return next((_read_number(node) for node in controller.list_scalars(name)), None)


def _read_number(node: Node) -> float | None:
    return None if node.quoted else number(node.text or "")


def _is_simulated(robot: Robot) -> bool:
    """Tell whether a simulator turns the wheels about their axes, unlike real hardware."""
    return any("_ros2_control/" in (block.plugin or "") for block in robot.ros2_controls) or any(
        "gazebo_ros_control" in plugin.filename for plugin in robot.plugins
    )
