"""Read controllers of ros_control and ros2_control YAML, as Gazebo applies them to a robot.

Every controller is commanded to hold the pose. A trajectory controller without a trajectory does
the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..errors import ConfigError
from ..model.controllers import DRIVES, Controller, list_controllers
from ..model.elements import Robot
from ..source.yaml_tree import Node, read_yaml
from ..suggestions import suggest_name
from .control import NONE, POSITION, SERVO, VELOCITY, Control, Pid

_SILENT = ("Broadcaster", "StateController", "SensorController")
"""Suffixes of controllers that only publish states."""

_POSITION = ("JointPositionController", "JointGroupPositionController")
_VELOCITY = ("JointVelocityController", "JointGroupVelocityController")
_EFFORT = ("JointEffortController", "JointGroupEffortController")
_FORWARD = ("ForwardCommandController", "MultiInterfaceForwardCommandController")
_TRAJECTORY = (
    *("JointTrajectoryController", "ScaledJointTrajectoryController"),
    *("GripperActionController", "ParallelGripperActionController"),
)
_PID = ("PidController",)
KNOWN = (*_POSITION, *_VELOCITY, *_EFFORT, *_FORWARD, *_TRAJECTORY, *_PID, *DRIVES)

_INTERFACES = ("position", "velocity", "effort")


@dataclass(frozen=True)
class Controls:
    """Contents of a controller file."""

    joints: dict[str, Control]
    notes: tuple[str, ...]


def read_controllers(path: str, robot: Robot, *, strict: bool = False) -> Controls:
    """Read the controllers of a robot from a file.

    Without ``strict``, joints of a controller of unknown type are not actuated.

    Raises:
        ConfigError: The file has no controllers; a controller has no joints or gains, or a joint is
            unknown or has a different interface; or, if ``strict``, a type is unknown.
        SourceError: The file cannot be read.
    """
    root = read_yaml(path)
    controllers = list(list_controllers(root))
    if not controllers:
        raise ConfigError(
            "has no controller; add a mapping with a 'type', such as "
            "effort_controllers/JointPositionController",
            path=path,
            line=1,
        )
    gains = _read_simulated_gains(root, robot)
    joints: dict[str, Control] = {}
    notes = list(_list_replaced_keys(root))
    for controller in controllers:
        if unknown := _explain_unknown_type(controller):
            if strict:
                raise controller.type.make_error(unknown)
            notes.append(f"{controller.type.place}: {unknown}; its joints are not actuated")
            continue
        for node, control in _list_claims(controller, robot, gains):
            name = (node.text or "").rpartition("/")[2]
            if name in joints:
                notes.append(
                    f"{node.place}: controllers '{joints[name].controller}' and "
                    f"'{control.controller}' both drive joint '{name}'; the first is used"
                )
                continue
            joints[name] = control
    for name, pid in gains.items():
        if name not in joints:
            notes.append(f"{pid.place}: gains of joint '{name}', which no controller drives")
    return Controls(joints, tuple(notes))


def _list_replaced_keys(root: Node) -> Iterator[str]:
    """List a message for each key whose earlier value is replaced."""
    for _, node in root.walk():
        for name, value in (node.fields or {}).items():
            if value.replaced:
                earlier = ", ".join(str(one.place.line) for one in value.replaced)
                yield f"{value.place}: '{name}' replaces the value in line {earlier}"


def _explain_unknown_type(controller: Controller) -> str:
    """Explain that the type of a controller is unknown; empty if it is known."""
    kind = controller.kind
    if kind.endswith(_SILENT) or kind in KNOWN:
        return ""
    hint = suggest_name(kind, KNOWN, 0.8)
    return (
        f"controller '{controller.name}' is of type '{controller.type.text}', which is not a "
        f"controller of ros_controllers or ros2_controllers that drives joints{hint}"
    )


def _read_simulated_gains(root: Node, robot: Robot) -> dict[str, Node]:
    """Read ``gazebo_ros_control/pid_gains`` by joint."""
    found: dict[str, Node] = {}
    for path, node in root.walk():
        if path and path[-1].rpartition("/")[2] == "pid_gains":
            for name, gains in (node.fields or {}).items():
                _check_joints_exist(gains, name, robot)
                found[name] = gains
    return found


def _list_claims(
    controller: Controller, robot: Robot, simulated: dict[str, Node]
) -> Iterator[tuple[Node, Control]]:
    """List each joint that a controller drives, with its control."""
    kind = controller.kind
    if kind.endswith(_SILENT):
        return
    for node, interface in _list_joints(controller):
        joint = (node.text or "").rpartition("/")[2]
        _check_joints_exist(node, joint, robot)
        _check_interface(controller, node, joint, interface, robot)
        yield node, _make_control(controller, node, joint, interface, simulated)


def _list_joints(controller: Controller) -> Iterator[tuple[Node, str]]:
    """List the joints of a controller, each with its command interface."""
    kind, parameters = controller.kind, controller.parameters
    if kind in DRIVES:
        wheels, steered = DRIVES[kind]
        found = False
        for names, interface in ((wheels, "velocity"), (steered, "position")):
            for name in names:
                node = parameters.find(name)
                if node is not None and (node.text or node.items):
                    found = True
                    yield from ((one, interface) for one in node.list_names(name))
        if not found:
            raise controller.type.make_error(
                f"controller '{controller.name}' names no wheels; write {wheels[0]}"
            )
        return
    interface = _get_interface(controller)
    for name in ("joints", "joint", "dof_names", "dof_name"):
        node = parameters.find(name)
        if node is not None:
            named = node.list_names(name)
            if not named:
                raise node.make_error(f"controller '{controller.name}' has an empty list of {name}")
            yield from ((one, interface) for one in named)
            return
    raise controller.type.make_error(
        f"controller '{controller.name}' names no joint; write joint: NAME or joints: [NAME, …]"
    )


def _get_interface(controller: Controller) -> str:
    """Return the interface that a controller commands: position, velocity or effort."""
    for word in _INTERFACES:
        if controller.package == f"{word}_controllers":
            return word
    if controller.kind in _POSITION:
        return "position"
    if controller.kind in _VELOCITY:
        return "velocity"
    if controller.kind in _EFFORT:
        return "effort"
    for name in ("command_interfaces", "interface_name", "interface_names", "command_interface"):
        node = controller.parameters.find(name)
        if node is None:
            continue
        words = [(one.text or "").rpartition("/")[2] for one in node.list_names(name)]
        for word in _INTERFACES:
            if word in words:
                return word
        raise node.make_error(
            f"{name} of controller '{controller.name}' is {node.described}; use one of "
            + ", ".join(_INTERFACES)
        )
    if controller.kind in _FORWARD or controller.kind in _PID:
        raise controller.type.make_error(
            f"controller '{controller.name}' has no command interface; write interface_name or "
            "command_interface"
        )
    return "position"


def _check_joints_exist(node: Node, joint: str, robot: Robot) -> None:
    if joint in robot.joint:
        if robot.joint[joint].is_fixed:
            raise node.make_error(f"joint '{joint}' is fixed; no controller can move it")
        return
    hint = suggest_name(joint, robot.joint, 0.5) or "; see 'urdftool graph'"
    if "$(" in joint:
        hint = "; a launch file replaces this expression, so write the name of the joint"
    raise node.make_error(f"the robot has no joint '{joint}'{hint}")


def _check_interface(
    controller: Controller, node: Node, joint: str, interface: str, robot: Robot
) -> None:
    """Refuse a joint whose hardware has other command interfaces, as controller managers do."""
    there = [
        word.rpartition("/")[2].lower()
        for part in robot.transmissions
        if joint in {one.name for one in part.joints}
        for words in (
            *(one.hardware_interfaces for one in part.joints if one.name == joint),
            *(one.hardware_interfaces for one in part.actuators),
        )
        for word in words
    ]
    there += [
        command.name.lower()
        for block in robot.ros2_controls
        for one in block.joints
        if one.name == joint
        for command in one.command_interfaces
    ]
    known = [word for word in there if any(one in word for one in _INTERFACES)]
    if known and not any(interface in word for word in known):
        raise node.make_error(
            f"controller '{controller.name}' commands the {interface} of joint '{joint}', whose "
            f"interface in the description is {', '.join(dict.fromkeys(known))}; the controller "
            "does not start"
        )


def _make_control(
    controller: Controller, node: Node, joint: str, interface: str, simulated: dict[str, Node]
) -> Control:
    kind = controller.kind
    if interface == "effort":
        by_velocity = kind in _VELOCITY or _measures_velocity(controller)
        if kind in _EFFORT or kind in _FORWARD:
            return Control(controller.name, NONE, None, node.at)
        gains = _build_gains(controller, joint)
        how = VELOCITY if by_velocity else POSITION
        return Control(controller.name, how, _read_pid(gains), gains.at)
    if joint in simulated:
        how = POSITION if interface == "position" else VELOCITY
        return Control(controller.name, how, _read_pid(simulated[joint]), simulated[joint].at)
    return Control(controller.name, SERVO, None, node.at)


def _measures_velocity(controller: Controller) -> bool:
    node = controller.parameters.find("reference_and_state_interfaces")
    words = [] if node is None else [one.text for one in node.list_names(node.key)]
    return bool(words) and "position" not in words


def _build_gains(controller: Controller, joint: str) -> Node:
    parameters = controller.parameters
    for keys in (("pid",), (joint, "pid"), ("gains", joint), ("gains",)):
        found = parameters.find(*keys)
        if found is not None and (keys != ("gains",) or found.find("p") is not None):
            return found
    expected = "pid: {p: …, i: …, d: …}"
    if controller.kind in (*_TRAJECTORY, *_PID):
        expected = f"gains: {{{joint}: {{p: …, i: …, d: …}}}}"
    elif "Group" in controller.kind:
        expected = f"{joint}: {{pid: {{p: …, i: …, d: …}}}}"
    raise controller.type.make_error(
        f"controller '{controller.name}' has no gains of joint '{joint}'; write {expected}"
    )


def _read_pid(node: Node) -> Pid:
    """Read the gains of a mapping, with the defaults of control_toolbox."""
    if node.fields is None:
        raise node.make_error(f"gains are {node.described}; write {{p: …, i: …, d: …}}")
    if "p" not in node.fields:
        raise node.make_error("gains have no p; write {p: …, i: …, d: …}")

    def number(*names: str) -> float | None:
        for name in names:
            if name in (node.fields or {}):
                return (node.fields or {})[name].read_number(name)
        return None

    clamp = abs(number("i_clamp") or 0.0)
    low, high = number("i_clamp_min", "i_min"), number("i_clamp_max", "i_max")
    windup = node.fields.get("antiwindup")
    low, high = 0.0 - clamp if low is None else low, clamp if high is None else high
    return Pid(
        number("p") or 0.0,
        number("i") or 0.0,
        number("d") or 0.0,
        low,
        high,
        windup is not None and windup.read_boolean("antiwindup"),
    )
