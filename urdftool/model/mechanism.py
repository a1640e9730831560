"""Parts of a robot that SDF, MJCF and USD have, and URDF only in ``<gazebo>`` and other blocks.

Names refer to links and joints of the same robot. Lengths are in meters, angles in radians.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ..source.location import Place
from .part import ZERO, Origin, Part, Vector
from .settings import Settings


@dataclass(slots=True)
class Base(Part):
    """Attachment of the root link to the world.

    Attributes:
        is_free: Whether the root moves freely; False if it is fixed.
        origin: Pose of the root in the world of the source; None for the identity.
    """

    is_free: bool = False
    origin: Origin | None = None


@dataclass(slots=True)
class Frame(Part):
    """Named frame on a link, without mass.

    Attributes:
        kind: ``site`` (MJCF), ``frame`` (SDF), or ``body`` for the frame in which the source
            writes the link, if the link's own frame is at its joint instead.
        origin: Pose in the frame of the link.
    """

    name: str = ""
    link: str = ""
    kind: str = "frame"
    origin: Origin | None = None


@dataclass(slots=True)
class Closure(Part):
    """Connection of two links beyond the tree, which closes a loop.

    Attributes:
        type: ``weld``, ``connect`` (a common point), or the type of an SDF joint.
        parent: Name of one link.
        child: Name of the other.
        origin: Frame of the connection in the frame of ``parent``.
        child_origin: Frame of the connection in the frame of ``child``.
        axis: Axis of an SDF joint in the frame of the connection.
        is_active: Whether it acts at the start.
        is_limited: Whether its position has limits.
        has_dynamics: Whether it has resistance or a spring.
    """

    name: str = ""
    type: str = ""
    parent: str = ""
    child: str = ""
    origin: Origin | None = None
    child_origin: Origin | None = None
    axis: Vector | None = None
    is_active: bool = True
    is_limited: bool = False
    has_dynamics: bool = False


@dataclass(slots=True)
class JointActuator(Part):
    """Actuator of a joint with an affine control law.

    The force at the joint [N or N·m] is ``gear * (gain * control + bias[0] + bias[1] * length +
    bias[2] * velocity)``, where length and velocity are those of the joint times ``gear``.

    Attributes:
        mode: ``motor``, ``position``, ``velocity`` or ``general``.
        control_range: Lower and upper limit of the control; None if not limited.
        force_range: Limits of the force before ``gear`` [N or N·m]; None if not limited.
        damping_ratio: Ratio of the damping of a servo to the critical one, of which MuJoCo computes
            ``bias[2]``; None if the source gives ``bias[2]``.
    """

    name: str = ""
    joint: str = ""
    mode: str = "general"
    gear: float = 1.0
    gain: float = 1.0
    bias: Vector = (0.0, 0.0, 0.0)
    control_range: tuple[float, float] | None = None
    force_range: tuple[float, float] | None = None
    damping_ratio: float | None = None


@dataclass(slots=True)
class ContactExclusion(Part):
    """Pair of links between which no contact is computed."""

    link: str = ""
    other: str = ""


@dataclass(slots=True)
class Configuration(Part):
    """Named positions of joints [rad or m], such as a keyframe of MJCF.

    Joints with several positions and the pose of a free base are omitted.
    """

    name: str = ""
    positions: dict[str, float] = field(default_factory=dict)


@dataclass(slots=True)
class Camera(Part):
    """Camera on a link.

    Attributes:
        origin: Pose of the camera in the frame of the link: x forward, z up.
        vertical_fov: Vertical field of view [rad]; None if not written.
        resolution: Width and height [pixels]; None if not written.
        type: Type as the source names it.
        settings: Settings of ``sensors.SETTINGS``, such as ``rate``, and others by their path.
    """

    name: str = ""
    link: str = ""
    origin: Origin | None = None
    vertical_fov: float | None = None
    resolution: tuple[int, int] | None = None
    type: str = "camera"
    settings: Settings = field(default_factory=dict)


@dataclass(slots=True)
class Light(Part):
    """Light on a link.

    Attributes:
        type: ``point``, ``directional`` or ``spot``.
        position: Position in the frame of the link [m].
        direction: Direction in the frame of the link, not of a ``point``.
        diffuse: Red, green and blue, each 0 to 1; None if not written.
        specular: Red, green and blue, each 0 to 1; None if not written.
        cutoff: Half of the angle of a ``spot`` [rad]; None if not written.
        casts_shadow: Whether it casts shadows.
    """

    name: str = ""
    link: str = ""
    type: str = "point"
    position: Vector = ZERO
    direction: Vector | None = None
    diffuse: Vector | None = None
    specular: Vector | None = None
    cutoff: float | None = None
    casts_shadow: bool = True


@dataclass(slots=True)
class MountedSensor(Part):
    """Sensor of a link or joint, other than a camera of MJCF.

    Attributes:
        type: Type as the source names it.
        link: Name of the link; empty for a sensor of a joint.
        joint: Name of the joint; empty for a sensor of a link.
        origin: Pose in the frame of the link; None for the identity.
        settings: Settings of ``sensors.SETTINGS``, such as ``rate``, and others by their path.
        quantities: Sensors of MJCF that a sensor of ros2_control stands for; empty for others.
        site: Name of the frame at which a sensor of MJCF measures; empty for none.
    """

    name: str = ""
    type: str = ""
    link: str = ""
    joint: str = ""
    origin: Origin | None = None
    settings: Settings = field(default_factory=dict)
    quantities: tuple[str, ...] = ()
    site: str = ""


@dataclass(slots=True)
class MountedPlugin(Part):
    """Plugin of Gazebo that is not in a sensor.

    Attributes:
        library: Library without folder, ``lib`` and ``.so``.
        owner: Name of its link or joint; empty for one of the robot.
        settings: Parameters as texts, by their path.
    """

    name: str = ""
    library: str = ""
    owner: str = ""
    settings: Settings = field(default_factory=dict)


@dataclass(slots=True)
class NativeElement(Part):
    """Element of a format that a writer of the same format copies, with what compiles from it.

    Attributes:
        section: Tag of the section that contains it; ``default``; empty for attributes of a part
            that the robot has; in SDF ``model``, or ``link`` or ``joint`` with its name.
        tag: Its tag.
        attributes: Its attributes as written.
        text: Its text.
        children: Its child elements.
        values: Values that the format's library computes of it, by name.
        held: Attributes of it that another part of the robot has as values; None if there is none.
        is_xml: Whether it is an element; otherwise its tag says what it is.
    """

    section: str = ""
    tag: str = ""
    attributes: dict[str, str] = field(default_factory=dict)
    text: str = ""
    children: list[NativeElement] = field(default_factory=list)
    values: dict[str, tuple[float, ...]] = field(default_factory=dict)
    held: frozenset[str] | None = None
    is_xml: bool = True

    @property
    def name(self) -> str:
        """Return its name; empty without one."""
        return self.get("name") or ""

    def get(self, name: str) -> str | None:
        """Return an attribute as written; None without it."""
        return self.attributes.get(name)

    def list_leaves(self) -> Iterator[tuple[str, Place]]:
        """Yield the path below it, and the place, of each element in it without children."""
        for child in self.children:
            if not child.children:
                yield child.tag, child.place
            for path, place in child.list_leaves():
                yield f"{child.tag}/{path}", place
