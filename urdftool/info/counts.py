"""What is written in a robot, counted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import fsum

from ..errors import PackageNotFound
from ..model.elements import Joint, Mesh, Robot

FREEDOMS = {"revolute": 1, "continuous": 1, "prismatic": 1, "planar": 3, "floating": 6}
"""Coordinates of a joint of each type; a planar one slides two ways and turns, as in MoveIt."""


@dataclass(frozen=True)
class Named:
    """A plugin, sensor or piece of hardware: its name, and its library or type."""

    name: str
    what: str
    on: str | None
    """The link or joint it is on; None for the robot."""


@dataclass
class Counts:
    """What is written in a robot.

    Attributes:
        links: How many links.
        frames: How many of them are mere frames.
        joints: How many joints of each type, the most frequent first.
        mimics: How many joints follow another.
        freedom: Degrees of freedom: coordinates of all joints that follow no other.
        mass: The masses that are written, summed [kg].
        massless: How many links that are no mere frames have no mass.
        roots: Names of links that are no joint's child.
        depth: Joints between the root and the link farthest from it.
        plugins: Of Gazebo, with their libraries.
        sensors: Of Gazebo and ros2_control, with their types.
        hardware: ``<ros2_control>`` blocks, with their plugins.
        transmissions: Names of the transmissions.
        packages: Folders of the packages that are named, by name; None where one is not found.
    """

    links: int
    frames: int
    joints: dict[str, int]
    mimics: int
    freedom: int
    mass: float
    massless: int
    roots: list[str]
    depth: int
    plugins: list[Named]
    sensors: list[Named]
    hardware: list[Named]
    transmissions: list[str]
    packages: dict[str, str | None] = field(default_factory=dict)


def count(robot: Robot) -> Counts:
    """Count what is written in a robot."""
    types: dict[str, int] = {}
    for joint in robot.joints:
        types[joint.type] = types.get(joint.type, 0) + 1
    bodies = [link for link in robot.links if not link.is_frame]
    return Counts(
        links=len(robot.links),
        frames=len(robot.links) - len(bodies),
        joints=dict(sorted(types.items(), key=lambda item: -item[1])),
        mimics=sum(joint.mimic is not None for joint in robot.joints),
        freedom=degrees_of_freedom(robot.joints),
        mass=fsum(link.mass for link in robot.links),
        massless=sum(link.inertial is None or link.inertial.mass is None for link in bodies),
        roots=[link.name for link in robot.tree.roots],
        depth=_depth(robot),
        plugins=_plugins(robot),
        sensors=_sensors(robot),
        hardware=[Named(c.name, c.plugin or "", None) for c in robot.ros2_controls],
        transmissions=[transmission.name for transmission in robot.transmissions],
        packages=_packages(robot),
    )


def degrees_of_freedom(joints: Iterable[Joint]) -> int:
    """Coordinates of all joints that follow no other."""
    return sum(FREEDOMS.get(joint.type, 0) for joint in joints if joint.mimic is None)


def _depth(robot: Robot) -> int:
    depths: dict[str, int] = {}
    for name in robot.tree.order:
        joint = robot.tree.parent_joint(name)
        depths[name] = 0 if joint is None else depths.get(joint.parent, -1) + 1
    return max(depths.values(), default=0)


def _plugins(robot: Robot) -> list[Named]:
    return [
        Named(plugin.name, plugin.filename, block.reference)
        for block in robot.gazebo
        for plugin in (*block.plugins, *(p for sensor in block.sensors for p in sensor.plugins))
    ]


def _sensors(robot: Robot) -> list[Named]:
    simulated = [
        Named(sensor.name, sensor.type, block.reference)
        for block in robot.gazebo
        for sensor in block.sensors
    ]
    return simulated + [
        Named(component.name, "ros2_control", None)
        for control in robot.ros2_controls
        for component in control.components
        if component.kind == "sensor"
    ]


def _packages(robot: Robot) -> dict[str, str | None]:
    """Those that xacro looked for, and those that meshes are in."""
    found: dict[str, str | None] = {}
    if robot.source is not None:
        found = {name: str(folder) for name, folder in robot.source.packages.used.items()}
    for _, shape in robot.shapes:
        if not isinstance(shape.geometry, Mesh):
            continue
        scheme, separator, rest = shape.geometry.filename.partition("://")
        name = rest.partition("/")[0]
        if not (separator and scheme in ("package", "model") and name) or name in found:
            continue
        found[name] = None
        if robot.source is not None:
            try:
                found[name] = str(robot.source.packages.find(name))
            except PackageNotFound:
                continue
    return found
