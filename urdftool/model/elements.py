"""Elements of a robot: links, joints and their parts.

Lengths are in meters, angles in radians, masses in kilograms. A part refers to its source
(``provenance``): the XML element of URDF, or a location in a file of another format; None for a
generated part. Missing values have the default of the specification, also numbers that cannot be
parsed (rules of the ``xml`` family report them). Parts do not change after reading.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from ..memo import Memo
from ..source.document import Element
from .contradiction import Contradiction
from .conversions import RobotConversions
from .extensions import Actuator as Actuator
from .extensions import ControlComponent as ControlComponent
from .extensions import GazeboExtension as GazeboExtension
from .extensions import Interface as Interface
from .extensions import Plugin as Plugin
from .extensions import Ros2Control as Ros2Control
from .extensions import Sensor as Sensor
from .extensions import Transmission as Transmission
from .extensions import TransmissionJoint as TransmissionJoint
from .joint import BALL_TYPES as BALL_TYPES
from .joint import JOINT_TYPES as JOINT_TYPES
from .joint import MOVING_TYPES as MOVING_TYPES
from .joint import Axis as Axis
from .joint import Calibration as Calibration
from .joint import Dynamics as Dynamics
from .joint import Joint as Joint
from .joint import Limit as Limit
from .joint import Mimic as Mimic
from .joint import SafetyController as SafetyController
from .link import Collision as Collision
from .link import Inertia as Inertia
from .link import Inertial as Inertial
from .link import Link as Link
from .link import Material as Material
from .link import Visual as Visual
from .mechanism import (
    Base,
    Camera,
    Closure,
    Configuration,
    ContactExclusion,
    Frame,
    JointActuator,
    Light,
    MountedPlugin,
    MountedSensor,
    NativeElement,
)
from .part import ZERO as ZERO
from .part import Origin as Origin
from .part import Part as Part
from .part import Vector as Vector
from .settings import Rejected, Settings
from .shapes import Box as Box
from .shapes import Capsule as Capsule
from .shapes import Cone as Cone
from .shapes import Cylinder as Cylinder
from .shapes import Ellipsoid as Ellipsoid
from .shapes import Geometry as Geometry
from .shapes import Mesh as Mesh
from .shapes import Plane as Plane
from .shapes import Sphere as Sphere
from .shapes import UnknownShape as UnknownShape
from .tree import KinematicTree

if TYPE_CHECKING:
    from ..finding import Finding
    from ..source.description import Description


@dataclass
class Robot(RobotConversions, Part):
    """Robot, possibly invalid: all links and joints as written, including duplicate names.

    Attributes:
        name: Name; empty if not written.
        format: Name of the format of its source.
        version: URDF version as written.
        links: Links in the order of the file.
        joints: Joints in the order of the file.
        materials: Materials at the top level.
        gazebo: All ``<gazebo>`` blocks.
        base: Attachment of the root to the world; None if the format does not specify it.
        closures: Connections of links beyond the tree, which close loops.
        frames: Named frames on links.
        joint_actuators: Actuators of joints, with their gains.
        exclusions: Pairs of links whose contact is ignored.
        configurations: Named joint positions.
        cameras: Cameras on links.
        mounted_sensors: Sensors of links and joints.
        mounted_plugins: Plugins of Gazebo that are not in a sensor.
        sensor_plugins: Plugins in sensors, except those of which ``sensors`` reads the data; their
            owner is the sensor.
        lights: Lights on links.
        settings: Settings of ``settings.OF_ROBOT``.
        world: Settings of the world around it, of ``world_settings``.
        rejected_settings: Elements of settings whose text is not a value.
        contradictions: Attributes of a stage for different simulators that differ.
        native: Elements that a writer of the format of its source copies.
        unread: What the robot does not hold of its source, once for each kind.
        source: Description from which it was read; None if it was read from a bare element.
        memo: Values shared by several rules, computed once.
    """

    name: str = ""
    version: str | None = None
    links: list[Link] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    materials: list[Material] = field(default_factory=list)
    transmissions: list[Transmission] = field(default_factory=list)
    gazebo: list[GazeboExtension] = field(default_factory=list)
    ros2_controls: list[Ros2Control] = field(default_factory=list)
    base: Base | None = None
    closures: list[Closure] = field(default_factory=list)
    frames: list[Frame] = field(default_factory=list)
    joint_actuators: list[JointActuator] = field(default_factory=list)
    exclusions: list[ContactExclusion] = field(default_factory=list)
    configurations: list[Configuration] = field(default_factory=list)
    cameras: list[Camera] = field(default_factory=list)
    mounted_sensors: list[MountedSensor] = field(default_factory=list)
    mounted_plugins: list[MountedPlugin] = field(default_factory=list)
    sensor_plugins: list[MountedPlugin] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    settings: Settings = field(default_factory=dict)
    world: Settings = field(default_factory=dict)
    rejected_settings: list[Rejected] = field(default_factory=list)
    contradictions: list[Contradiction] = field(default_factory=list)
    format: str = "urdf"
    native: Sequence[NativeElement] = field(default=(), repr=False)
    unread: Sequence[Finding] = field(default=(), repr=False)
    source: Description | None = field(default=None, repr=False)
    memo: Memo = field(default_factory=Memo, init=False, repr=False, compare=False)

    @cached_property
    def link(self) -> dict[str, Link]:
        """Return links by name; the first of duplicates."""
        found: dict[str, Link] = {}
        for link in self.links:
            found.setdefault(link.name, link)
        return found

    @cached_property
    def joint(self) -> dict[str, Joint]:
        """Return joints by name; the first of duplicates."""
        found: dict[str, Joint] = {}
        for joint in self.joints:
            found.setdefault(joint.name, joint)
        return found

    @cached_property
    def moving_joints(self) -> list[Joint]:
        """Return the joints of a movable type."""
        return [joint for joint in self.joints if joint.type in MOVING_TYPES]

    @cached_property
    def tree(self) -> KinematicTree:
        """Return the kinematic tree."""
        return KinematicTree(self.link, self.joints)

    @cached_property
    def extensions(self) -> dict[str | None, list[GazeboExtension]]:
        """Return ``<gazebo>`` blocks by their reference."""
        found: dict[str | None, list[GazeboExtension]] = {}
        for block in self.gazebo:
            found.setdefault(block.reference, []).append(block)
        return found

    @cached_property
    def block_elements(self) -> dict[str, list[Element]]:
        """Return the children of ``<gazebo>`` blocks by reference; the robot's by an empty one."""
        found: dict[str, list[Element]] = {}
        for block in self.gazebo:
            found.setdefault(block.reference or "", []).extend(block.element.children)
        return found

    @cached_property
    def sensors(self) -> list[Sensor]:
        """Return all ``<sensor>`` elements of ``<gazebo>`` blocks, as they are written."""
        return [sensor for block in self.gazebo for sensor in block.sensors]

    @cached_property
    def plugins(self) -> list[Plugin]:
        """Return all Gazebo plugins, including those of sensors."""
        return [
            plugin
            for block in self.gazebo
            for plugin in (*block.plugins, *(p for sensor in block.sensors for p in sensor.plugins))
        ]

    @cached_property
    def old_plugins(self) -> list[Element]:
        """Return elements of ``<gazebo>`` blocks whose ``plugin`` is a library, a syntax of 2010.

        Example: ``<controller:gazebo_ros_laser plugin="libgazebo_ros_laser.so">``.
        """
        return [
            element
            for block in self.gazebo
            for element in block.element.walk()
            if "plugin" in element.attributes
        ]

    @property
    def shapes(self) -> Iterator[tuple[Link, Visual | Collision]]:
        """Yield every visual and collision with its link, in the order of the file."""
        for link in self.links:
            for visual in link.visuals:
                yield link, visual
            for collision in link.collisions:
                yield link, collision
