"""Robot, Link, Joint and what is in them, on one page.

Lengths are in meters, angles in radians, masses in kilograms. A part knows where it was written
(``provenance``): for URDF that is its XML element, for another format a place in its file; a part
that a program made has none. Values that are not written have the default of the specification;
numbers that cannot be read have it too (the rules of the ``xml`` family report these). Nothing here
is changed after reading.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Union

from ..source.document import Element
from ..source.location import Place
from ..workspace import Memo
from .provenance import NOWHERE

if TYPE_CHECKING:
    from ..source.description import Description
    from .provenance import Provenance
    from .tree import KinematicTree

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)


@dataclass(slots=True)
class Part:
    """A part of a robot.

    Attributes:
        provenance: Where it was written; None for a part that a program made.
    """

    provenance: Provenance | None = None

    @property
    def element(self) -> Element:
        """Get the URDF element that the part was read from.

        Raises:
            TypeError: It was not read from URDF.
        """
        element = self.provenance
        if isinstance(element, Element):
            return element
        raise TypeError(f"this {type(self).__name__} was not read from URDF")

    @property
    def place(self) -> Place:
        """Get the span of its start tag in the source; ``NOWHERE`` for a part without one."""
        return NOWHERE if self.provenance is None else self.provenance.place


@dataclass(slots=True)
class Origin(Part):
    """A pose: ``xyz`` [m] and fixed-axis ``rpy`` [rad], of the child in the parent's frame.

    ``quaternion`` is ``(x, y, z, w)`` where URDF 1.1's ``quat_xyzw`` is written.
    """

    xyz: Vector = ZERO
    rpy: Vector = ZERO
    quaternion: tuple[float, float, float, float] | None = None


@dataclass(slots=True)
class Inertia(Part):
    """Moments and products of inertia [kg·m²] about the centre of mass, in the inertial frame."""

    ixx: float = 0.0
    ixy: float = 0.0
    ixz: float = 0.0
    iyy: float = 0.0
    iyz: float = 0.0
    izz: float = 0.0

    @property
    def moments(self) -> Vector:
        """The diagonal: ixx, iyy, izz."""
        return self.ixx, self.iyy, self.izz

    @property
    def products(self) -> Vector:
        """Off the diagonal: ixy, ixz, iyz."""
        return self.ixy, self.ixz, self.iyz

    @property
    def six(self) -> tuple[float, float, float, float, float, float]:
        """All of them, row by row: ixx, ixy, ixz, iyy, iyz, izz."""
        return self.ixx, self.ixy, self.ixz, self.iyy, self.iyz, self.izz


@dataclass(slots=True)
class Inertial(Part):
    """Mass [kg], its pose in the link frame, and inertia; None for what is not written."""

    origin: Origin | None = None
    mass: float | None = None
    inertia: Inertia | None = None


@dataclass(slots=True)
class Box(Part):
    """A box centred on its origin; ``size`` [m] along x, y, z."""

    size: Vector = ZERO


@dataclass(slots=True)
class Cylinder(Part):
    """A cylinder about z, centred on its origin [m]."""

    radius: float = 0.0
    length: float = 0.0


@dataclass(slots=True)
class Sphere(Part):
    """A sphere centred on its origin [m]."""

    radius: float = 0.0


@dataclass(slots=True)
class Capsule(Part):
    """A capsule about z, centred; ``length`` [m] is that of its cylinder alone (URDF 1.1)."""

    radius: float = 0.0
    length: float = 0.0


@dataclass(slots=True)
class Mesh(Part):
    """A mesh file and the factors it is scaled by."""

    filename: str = ""
    scale: Vector = (1.0, 1.0, 1.0)


@dataclass(slots=True)
class UnknownShape(Part):
    """A shape that URDF does not have; its name is the element's tag."""


Geometry = Union[Box, Cylinder, Sphere, Capsule, Mesh, UnknownShape]  # noqa: UP007 -- runtime alias


@dataclass(slots=True)
class Material(Part):
    """A named colour (``rgba``, each 0 to 1) or texture; both None where it only names another."""

    name: str = ""
    color: tuple[float, float, float, float] | None = None
    texture: str | None = None


@dataclass(slots=True)
class Visual(Part):
    """What is seen of a link."""

    name: str | None = None
    origin: Origin | None = None
    geometry: Geometry | None = None
    material: Material | None = None


@dataclass(slots=True)
class Collision(Part):
    """What of a link touches."""

    name: str | None = None
    origin: Origin | None = None
    geometry: Geometry | None = None


@dataclass(slots=True)
class Link(Part):
    """A rigid body."""

    name: str = ""
    inertial: Inertial | None = None
    visuals: list[Visual] = field(default_factory=list)
    collisions: list[Collision] = field(default_factory=list)

    @property
    def mass(self) -> float:
        """Its mass [kg]; 0 where none is written."""
        return (self.inertial.mass or 0.0) if self.inertial else 0.0

    @property
    def is_frame(self) -> bool:
        """Whether it is a mere frame: nothing is seen of it, touches or weighs."""
        return not (self.visuals or self.collisions or self.inertial)


@dataclass(slots=True)
class Limit(Part):
    """Bounds of a joint: position [rad or m], effort [N·m or N], velocity [rad/s or m/s].

    None for what is not written; readers take a missing ``lower`` or ``upper`` for 0.
    """

    lower: float | None = None
    upper: float | None = None
    effort: float | None = None
    velocity: float | None = None


@dataclass(slots=True)
class Dynamics(Part):
    """Damping [N·m·s/rad or N·s/m] and static friction [N·m or N] of a joint."""

    damping: float | None = None
    friction: float | None = None


@dataclass(slots=True)
class Mimic(Part):
    """This joint follows another: ``multiplier * position + offset``."""

    joint: str = ""
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(slots=True)
class SafetyController(Part):
    """Soft limits of a joint and the gains that hold it in them."""

    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0
    k_position: float = 0.0
    k_velocity: float | None = None


@dataclass(slots=True)
class Calibration(Part):
    """Where a joint's reference position is."""

    rising: float | None = None
    falling: float | None = None
    reference_position: float | None = None


@dataclass(slots=True)
class Axis(Part):
    """The axis of a joint in its own frame, as written."""

    xyz: Vector = (1.0, 0.0, 0.0)


MOVING_TYPES = frozenset(("revolute", "continuous", "prismatic", "floating", "planar"))
JOINT_TYPES = MOVING_TYPES | {"fixed"}


@dataclass(slots=True)
class Joint(Part):
    """A child link joined to its parent.

    Attributes:
        type: As written; ``JOINT_TYPES`` are those that URDF knows.
        parent: Name of the parent link; empty where it is not written.
        child: Name of the child link; empty where it is not written.
        parent_element: The ``<parent>`` element of URDF, if there is one.
        child_element: The ``<child>`` element of URDF, if there is one.
        axis: None where it is not written; it is x then.
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

    @property
    def is_fixed(self) -> bool:
        """Whether it is of type ``fixed``."""
        return self.type == "fixed"

    @property
    def has_axis(self) -> bool:
        """Whether its type turns about or slides along an axis."""
        return self.type in ("revolute", "continuous", "prismatic", "planar")

    @property
    def is_limited(self) -> bool:
        """Whether its type needs limits."""
        return self.type in ("revolute", "prismatic")


@dataclass(slots=True)
class TransmissionJoint(Part):
    """A joint in a transmission, with the hardware interfaces written there."""

    name: str = ""
    hardware_interfaces: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Actuator(Part):
    """An actuator in a transmission."""

    name: str = ""
    mechanical_reduction: float | None = None
    hardware_interfaces: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Transmission(Part):
    """A ``<transmission>`` of ros_control."""

    name: str = ""
    type: str = ""
    joints: list[TransmissionJoint] = field(default_factory=list)
    actuators: list[Actuator] = field(default_factory=list)


@dataclass(slots=True)
class Plugin(Part):
    """A ``<plugin>`` of Gazebo: its library is ``filename``."""

    name: str = ""
    filename: str = ""


@dataclass(slots=True)
class Sensor(Part):
    """A ``<sensor>`` of Gazebo, with the plugins in it."""

    name: str = ""
    type: str = ""
    plugins: list[Plugin] = field(default_factory=list)


@dataclass(slots=True)
class GazeboExtension(Part):
    """A ``<gazebo>`` block; ``reference`` names a link or joint, None is the robot."""

    reference: str | None = None
    sensors: list[Sensor] = field(default_factory=list)
    plugins: list[Plugin] = field(default_factory=list)

    def value(self, keyword: str) -> str | None:
        """What a keyword is set to, as text or as a ``value`` attribute; None if it is not set."""
        child = self.element.child(keyword)
        if child is None:
            return None
        return (child.get("value") or child.text).strip()


@dataclass(slots=True)
class Interface(Part):
    """A command or state interface of ros2_control, with its parameters."""

    name: str = ""
    params: dict[str, str] = field(default_factory=dict)


@dataclass(slots=True)
class ControlComponent(Part):
    """A joint, sensor or gpio of a ``<ros2_control>`` block."""

    kind: str = ""
    name: str = ""
    mimic: str | None = None
    command_interfaces: list[Interface] = field(default_factory=list)
    state_interfaces: list[Interface] = field(default_factory=list)
    params: dict[str, str] = field(default_factory=dict)


@dataclass(slots=True)
class Ros2Control(Part):
    """A ``<ros2_control>`` block: one piece of hardware."""

    name: str = ""
    type: str = ""
    plugin: str | None = None
    components: list[ControlComponent] = field(default_factory=list)

    @property
    def joints(self) -> list[ControlComponent]:
        """The joints in it."""
        return [component for component in self.components if component.kind == "joint"]


@dataclass
class Robot(Part):
    """A robot, however broken: every link and joint that is written, also those of one name.

    Attributes:
        name: Its name; empty where none is written.
        version: The URDF version as written.
        links: In the order of the file.
        joints: In the order of the file.
        materials: Those at the top level.
        gazebo: All ``<gazebo>`` blocks.
        source: The description it was read from; None for a robot made of a bare element.
        memo: What several rules need to know of it, computed once.
    """

    name: str = ""
    version: str | None = None
    links: list[Link] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    materials: list[Material] = field(default_factory=list)
    transmissions: list[Transmission] = field(default_factory=list)
    gazebo: list[GazeboExtension] = field(default_factory=list)
    ros2_controls: list[Ros2Control] = field(default_factory=list)
    source: Description | None = field(default=None, repr=False)
    memo: Memo = field(default_factory=Memo, init=False, repr=False, compare=False)

    @cached_property
    def link(self) -> dict[str, Link]:
        """Links by name; the first of one name."""
        found: dict[str, Link] = {}
        for link in self.links:
            found.setdefault(link.name, link)
        return found

    @cached_property
    def joint(self) -> dict[str, Joint]:
        """Joints by name; the first of one name."""
        found: dict[str, Joint] = {}
        for joint in self.joints:
            found.setdefault(joint.name, joint)
        return found

    @cached_property
    def moving_joints(self) -> list[Joint]:
        """Joints of a type that moves."""
        return [joint for joint in self.joints if joint.type in MOVING_TYPES]

    @cached_property
    def tree(self) -> KinematicTree:
        """Who is whose parent."""
        from .tree import KinematicTree

        return KinematicTree(self)

    @cached_property
    def extensions(self) -> dict[str | None, list[GazeboExtension]]:
        """``<gazebo>`` blocks by what they refer to."""
        found: dict[str | None, list[GazeboExtension]] = {}
        for block in self.gazebo:
            found.setdefault(block.reference, []).append(block)
        return found

    @cached_property
    def plugins(self) -> list[Plugin]:
        """Every Gazebo plugin, those of sensors included."""
        return [
            plugin
            for block in self.gazebo
            for plugin in (*block.plugins, *(p for sensor in block.sensors for p in sensor.plugins))
        ]

    @cached_property
    def old_plugins(self) -> list[str]:
        """Libraries in the ``plugin`` attribute of elements in ``<gazebo>``, as of 2010.

        ``<controller:gazebo_ros_laser plugin="libgazebo_ros_laser.so">`` is one.
        """
        return [
            element.attributes["plugin"]
            for block in self.gazebo
            for element in block.element.walk()
            if "plugin" in element.attributes
        ]

    @property
    def shapes(self) -> Iterator[tuple[Link, Visual | Collision]]:
        """Every visual and collision with its link, in the order of the file."""
        for link in self.links:
            for visual in link.visuals:
                yield link, visual
            for collision in link.collisions:
                yield link, collision
