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
from .settings import Rejected, Settings, get_number, is_set
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

if TYPE_CHECKING:
    from ..finding import Finding
    from ..source.description import Description
    from .tree import KinematicTree


@dataclass(slots=True)
class Inertia(Part):
    """Inertia tensor [kg·m²] about the center of mass, in the inertial frame."""

    ixx: float = 0.0
    ixy: float = 0.0
    ixz: float = 0.0
    iyy: float = 0.0
    iyz: float = 0.0
    izz: float = 0.0

    @property
    def moments(self) -> Vector:
        """Return the diagonal: ixx, iyy, izz."""
        return self.ixx, self.iyy, self.izz

    @property
    def products(self) -> Vector:
        """Return the off-diagonal elements: ixy, ixz, iyz."""
        return self.ixy, self.ixz, self.iyz

    @property
    def six(self) -> tuple[float, float, float, float, float, float]:
        """Return ixx, ixy, ixz, iyy, iyz, izz."""
        return self.ixx, self.ixy, self.ixz, self.iyy, self.iyz, self.izz


@dataclass(slots=True)
class Inertial(Part):
    """Mass [kg], pose of the inertial frame in the link frame, inertia; None if not written."""

    origin: Origin | None = None
    mass: float | None = None
    inertia: Inertia | None = None


@dataclass(slots=True)
class Material(Part):
    """Named color (``rgba``, each 0 to 1) or texture; both None for a reference by name."""

    name: str = ""
    color: tuple[float, float, float, float] | None = None
    texture: str | None = None


@dataclass(slots=True)
class Visual(Part):
    """Visual geometry of a link.

    Attributes:
        appearance: Settings of ``appearance.APPEARANCE`` in addition to the material.
        script: Material of an Ogre script that its reader does not know.
    """

    name: str | None = None
    origin: Origin | None = None
    geometry: Geometry | None = None
    material: Material | None = None
    appearance: Settings = field(default_factory=dict)
    script: str = ""


@dataclass(slots=True)
class Collision(Part):
    """Collision geometry of a link; ``surface`` has the settings of ``settings.SURFACE``."""

    name: str | None = None
    origin: Origin | None = None
    geometry: Geometry | None = None
    surface: Settings = field(default_factory=dict)


@dataclass(slots=True)
class Link(Part):
    """Link of a robot: a rigid body or a coordinate frame.

    Attributes:
        is_virtual: Whether a reader inserted it between two joints that the source writes between
            the same two bodies; it has no mass and no geometry.
        settings: Settings of ``settings.OF_LINKS``.
        surface: Settings that a URDF gives all its collisions.
        gazebo_material: Material of Gazebo that a ``<gazebo>`` block names; empty for none.
    """

    name: str = ""
    inertial: Inertial | None = None
    visuals: list[Visual] = field(default_factory=list)
    collisions: list[Collision] = field(default_factory=list)
    is_virtual: bool = False
    settings: Settings = field(default_factory=dict)
    surface: Settings = field(default_factory=dict)
    gazebo_material: str = ""

    @property
    def mass(self) -> float:
        """Return the mass [kg]; 0 if not written."""
        return (self.inertial.mass or 0.0) if self.inertial else 0.0

    @property
    def is_weightless(self) -> bool:
        """Tell whether gravity does not act on the link."""
        return not is_set(self.settings, "gravity", True)

    @property
    def is_frame(self) -> bool:
        """Tell whether the link has no visual, no collision and no inertial."""
        return not (self.visuals or self.collisions or self.inertial)


@dataclass(slots=True)
class Limit(Part):
    """Limits of a joint: position [rad or m], effort [N·m or N], velocity [rad/s or m/s].

    None if not written; readers replace a missing ``lower`` or ``upper`` by 0.
    """

    lower: float | None = None
    upper: float | None = None
    effort: float | None = None
    velocity: float | None = None


@dataclass(slots=True)
class Dynamics(Part):
    """Forces that depend on the motion of a joint; None if not written.

    Attributes:
        damping: Damping [N·m·s/rad or N·s/m].
        friction: Static friction [N·m or N].
        armature: Inertia of the rotor at the joint [kg·m² or kg] (MJCF).
    """

    damping: float | None = None
    friction: float | None = None
    armature: float | None = None


@dataclass(slots=True)
class Mimic(Part):
    """Dependence of a joint on another: ``multiplier * position + offset``."""

    joint: str = ""
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(slots=True)
class SafetyController(Part):
    """Soft limits of a joint and the gains that keep it within them."""

    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0
    k_position: float = 0.0
    k_velocity: float | None = None


@dataclass(slots=True)
class Calibration(Part):
    """Reference position of a joint."""

    rising: float | None = None
    falling: float | None = None
    reference_position: float | None = None


@dataclass(slots=True)
class Axis(Part):
    """Axis of a joint in the joint frame, as written (not normalized)."""

    xyz: Vector = (1.0, 0.0, 0.0)


MOVING_TYPES = frozenset(("revolute", "continuous", "prismatic", "floating", "planar"))
JOINT_TYPES = MOVING_TYPES | {"fixed"}

BALL_TYPES = frozenset(("spherical", "ball"))
"""Joint types that URDF does not have and several readers do."""


@dataclass(slots=True)
class Joint(Part):
    """Connection of a child link to a parent link.

    Attributes:
        type: Type as written; ``JOINT_TYPES`` are those of URDF. Readers of other formats also
            use ``ball``, three rotations about the origin, and ``screw``.
        parent: Name of the parent link; empty if not written.
        child: Name of the child link; empty if not written.
        parent_element: The ``<parent>`` element of URDF, if any.
        child_element: The ``<child>`` element of URDF, if any.
        axis: Axis; None if not written, which means x.
        thread_pitch: Translation along the axis [m] for each right-handed turn of a ``screw``.
        settings: Settings of ``settings.OF_JOINTS``.
    """

    name: str = ""
    type: str = ""
    parent: str = ""
    child: str = ""
    parent_element: Element | None = None
    child_element: Element | None = None
    origin: Origin | None = None
    axis: Axis | None = None
    limit: Limit | None = None
    dynamics: Dynamics | None = None
    mimic: Mimic | None = None
    safety_controller: SafetyController | None = None
    calibration: Calibration | None = None
    thread_pitch: float | None = None
    settings: Settings = field(default_factory=dict)

    @property
    def spring(self) -> tuple[float, float] | None:
        """Return stiffness [N·m/rad, N/m] and rest position [rad, m]; None without a spring."""
        stiffness = get_number(self.settings, "spring_stiffness")
        rest = get_number(self.settings, "spring_reference")
        return (stiffness, rest or 0.0) if stiffness else None

    @property
    def is_preserved(self) -> bool:
        """Tell whether Gazebo keeps the joint if it is fixed."""
        return is_set(self.settings, "preserved") or is_set(self.settings, "not_lumped")

    @property
    def is_fixed(self) -> bool:
        """Tell whether the type is ``fixed``."""
        return self.type == "fixed"

    @property
    def has_axis(self) -> bool:
        """Tell whether the type uses an axis."""
        return self.type in ("revolute", "continuous", "prismatic", "planar")

    @property
    def is_limited(self) -> bool:
        """Tell whether the type requires limits."""
        return self.type in ("revolute", "prismatic")

    def get_resistance(self, name: str) -> float:
        """Return ``damping``, ``friction`` or ``armature``; 0 if it is not written or negative."""
        return max(getattr(self.dynamics, name, None) or 0.0, 0.0)

    @property
    def turns_freely(self) -> bool:
        """Tell whether it is continuous, or revolute with a drive and no written bound.

        By the letter of URDF both bounds of the latter are zero, and it could not move; but an
        effort or a velocity is written for a joint that moves. Bounds that are written count.
        """
        limit = self.limit
        if self.type != "revolute" or limit is None:
            return self.type == "continuous"
        is_bounded = limit.lower is not None or limit.upper is not None
        return not is_bounded and bool(limit.effort or limit.velocity)


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
        lights: Lights on links.
        settings: Settings of ``settings.OF_ROBOT``.
        world: Settings of the world around it, of ``settings.OF_WORLD``.
        rejected_settings: Elements of settings whose text is not a value.
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
    lights: list[Light] = field(default_factory=list)
    settings: Settings = field(default_factory=dict)
    world: Settings = field(default_factory=dict)
    rejected_settings: list[Rejected] = field(default_factory=list)
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
        from .tree import KinematicTree

        return KinematicTree(self)

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
