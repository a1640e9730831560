"""Counts of the elements of a robot."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import fsum

from ..errors import PackageNotFound
from ..model.elements import Joint, Mesh, Robot
from ..model.mechanism import Camera, MountedSensor
from ..model.world import WORLD

FREEDOMS = {
    "revolute": 1,
    "continuous": 1,
    "prismatic": 1,
    "screw": 1,
    "planar": 3,
    "ball": 3,
    "floating": 6,
}
"""Degrees of freedom by joint type; a planar joint has two translations and one rotation."""


@dataclass(frozen=True)
class Named:
    """Plugin, sensor or hardware component: its name, and its library or type."""

    name: str
    what: str
    on: str | None
    """Link or joint to which it belongs; None for the robot."""


@dataclass
class Counts:
    """Counts of the elements of a robot.

    Attributes:
        links: Number of links.
        frames: Number of links without visual, collision and inertial.
        joints: Number of joints by type, the most frequent first.
        mimics: Number of mimic joints.
        freedom: Degrees of freedom of all joints that are not mimic joints.
        mass: Sum of the masses [kg].
        massless: Number of links with geometry or an inertial, but without a mass.
        roots: Names of links that are not the child of a joint.
        depth: Number of joints from the root to the farthest link.
        plugins: Gazebo plugins, with their libraries.
        sensors: Sensors of Gazebo and ros2_control, with their types.
        hardware: ``<ros2_control>`` blocks, with their plugins.
        transmissions: Names of the transmissions.
        packages: Folders of referenced packages by name; None if not found.
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
    """Count the elements of a robot."""
    types: dict[str, int] = {}
    for joint in robot.joints:
        types[joint.type] = types.get(joint.type, 0) + 1
    bodies = [link for link in robot.links if not link.is_frame]
    return Counts(
        links=len(robot.links),
        frames=len(robot.links) - len(bodies),
        joints=dict(sorted(types.items(), key=lambda item: -item[1])),
        mimics=sum(joint.mimic is not None for joint in robot.joints),
        freedom=count_degrees_of_freedom(robot.joints),
        mass=fsum(link.mass for link in robot.links),
        massless=sum(
            link.inertial is None or link.inertial.mass is None
            for link in bodies
            if link.name != WORLD or robot.xml is not None  # the world of SDF and MJCF has no mass
        ),
        roots=[link.name for link in robot.tree.roots],
        depth=_compute_depth(robot),
        plugins=_collect_plugins(robot),
        sensors=_collect_sensors(robot),
        hardware=[Named(c.name, c.plugin or "", None) for c in robot.ros2_controls],
        transmissions=[transmission.name for transmission in robot.transmissions],
        packages=_find_packages(robot),
    )


def count_degrees_of_freedom(joints: Iterable[Joint]) -> int:
    """Return the degrees of freedom of all joints that are not mimic joints."""
    return sum(FREEDOMS.get(joint.type, 0) for joint in joints if joint.mimic is None)


def _compute_depth(robot: Robot) -> int:
    depths: dict[str, int] = {}
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        depths[name] = 0 if joint is None else depths.get(joint.parent, -1) + 1
    return max(depths.values(), default=0)


def _collect_plugins(robot: Robot) -> list[Named]:
    return [Named(plugin.name, plugin.filename, plugin.reference) for plugin in robot.plugins]


def _collect_sensors(robot: Robot) -> list[Named]:
    parts: list[MountedSensor | Camera] = [
        *(s for s in robot.mounted_sensors if not s.quantities),
        *robot.cameras,
    ]
    if robot.xml is not None:
        parts.sort(key=lambda part: part.place.start)
    listed = [
        Named(part.name, part.type, part.link or getattr(part, "joint", "")) for part in parts
    ]
    return listed + [
        Named(component.name, "ros2_control", None)
        for control in robot.ros2_controls
        for component in control.components
        if component.kind == "sensor"
    ]


def _find_packages(robot: Robot) -> dict[str, str | None]:
    """Return the folders of packages used by xacro and by meshes; None if not found."""
    packages: dict[str, str | None] = {}
    if robot.source is not None:
        packages = {name: str(folder) for name, folder in robot.source.packages.used.items()}
    for _, shape in robot.shapes:
        if not isinstance(shape.geometry, Mesh):
            continue
        scheme, separator, rest = shape.geometry.filename.partition("://")
        name = rest.partition("/")[0]
        if not (separator and scheme in ("package", "model") and name) or name in packages:
            continue
        packages[name] = None
        if robot.source is not None:
            try:
                packages[name] = str(robot.source.packages.find(name))
            except PackageNotFound:
                continue
    return packages
