"""What URDF files hold for Gazebo, ros_control and ros2_control, as it is written."""

from __future__ import annotations

from dataclasses import dataclass, field

from .part import Part


@dataclass(slots=True)
class TransmissionJoint(Part):
    """Joint of a transmission, with its hardware interfaces."""

    name: str = ""
    hardware_interfaces: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Actuator(Part):
    """Actuator of a transmission."""

    name: str = ""
    mechanical_reduction: float | None = None
    hardware_interfaces: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Transmission(Part):
    """``<transmission>`` of ros_control."""

    name: str = ""
    type: str = ""
    joints: list[TransmissionJoint] = field(default_factory=list)
    actuators: list[Actuator] = field(default_factory=list)


@dataclass(slots=True)
class Plugin(Part):
    """``<plugin>`` of Gazebo.

    Attributes:
        filename: Its library.
        reference: Link or joint that its ``<gazebo>`` block names; None is the robot.
    """

    name: str = ""
    filename: str = ""
    reference: str | None = None


@dataclass(slots=True)
class Sensor(Part):
    """``<sensor>`` of Gazebo, as it is written in a ``<gazebo>`` block.

    Attributes:
        plugins: Plugins in it.
        reference: Link or joint that the block names; None is the robot.
    """

    name: str = ""
    type: str = ""
    plugins: list[Plugin] = field(default_factory=list)
    reference: str | None = None


@dataclass(slots=True)
class GazeboExtension(Part):
    """``<gazebo>`` block; ``reference`` names a link or joint, None is the robot."""

    reference: str | None = None
    sensors: list[Sensor] = field(default_factory=list)
    plugins: list[Plugin] = field(default_factory=list)

    def get_value(self, keyword: str) -> str | None:
        """Return the ``value`` attribute or the text of a child element; None if absent."""
        child = self.element.find_child(keyword)
        if child is None:
            return None
        return (child.get("value") or child.text).strip()


@dataclass(slots=True)
class Interface(Part):
    """Command or state interface of ros2_control, with its parameters."""

    name: str = ""
    params: dict[str, str] = field(default_factory=dict)


@dataclass(slots=True)
class ControlComponent(Part):
    """Joint, sensor or gpio of a ``<ros2_control>`` block."""

    kind: str = ""
    name: str = ""
    mimic: str | None = None
    command_interfaces: list[Interface] = field(default_factory=list)
    state_interfaces: list[Interface] = field(default_factory=list)
    params: dict[str, str] = field(default_factory=dict)


@dataclass(slots=True)
class Ros2Control(Part):
    """``<ros2_control>`` block: one hardware component."""

    name: str = ""
    type: str = ""
    plugin: str | None = None
    components: list[ControlComponent] = field(default_factory=list)

    @property
    def joints(self) -> list[ControlComponent]:
        """Return the joints of the block."""
        return [component for component in self.components if component.kind == "joint"]
