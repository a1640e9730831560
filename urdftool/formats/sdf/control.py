"""Transmissions and ros2_control, which SDF cannot express."""

from __future__ import annotations

from ...model.elements import Ros2Control, Transmission
from .translation import Translation
from .xml import Node, append_comment

HARDWARE = {
    "gz": ("gz_ros2_control/GazeboSimSystem", "ign_ros2_control/IgnitionSystem"),
    "gazebo-classic": ("gazebo_ros2_control/GazeboSystem",),
}
"""Hardware plugins that work in each target."""


def keep_control(model: Node, t: Translation) -> None:
    """Keep transmissions and ros2_control as comments, and report them."""
    if t.options.classic:
        use = "ros_control reads it from robot_description"
    elif t.robot.ros2_controls:
        use = "gz drives its joints by the <ros2_control> block of robot_description"
    else:
        use = "gz requires a <ros2_control> block in robot_description instead"
    for transmission in t.robot.transmissions:
        append_comment(model, _format_comment(transmission))
        joints = ", ".join(f"'{joint.name}'" for joint in transmission.joints) or "no joint"
        t.report_loss(
            "transmission",
            f"transmission '{transmission.name}' of {joints} has no counterpart; it stays as a "
            f"comment, and {use}",
            transmission,
        )
    for system in t.robot.ros2_controls:
        _add_ros2_control(model, t, system)


def _format_comment(transmission: Transmission) -> str:
    parts = [f"transmission {transmission.name}: {transmission.type}"]
    parts += [
        f"joint {joint.name} {' '.join(joint.hardware_interfaces)}".rstrip()
        for joint in transmission.joints
    ]
    for actuator in transmission.actuators:
        reduction = actuator.mechanical_reduction
        text = "" if reduction is None else f" mechanicalReduction {reduction:g}"
        parts.append(f"actuator {actuator.name}{text}")
    return "; ".join(parts)


def _add_ros2_control(model: Node, t: Translation, system: Ros2Control) -> None:
    joints = ", ".join(joint.name for joint in system.joints)
    append_comment(
        model, f"ros2_control {system.name}: {system.plugin or 'no plugin'}; joints {joints}"
    )
    right = HARDWARE[t.options.target]
    at = system.element.find_child("hardware") or system.element
    if system.plugin and system.plugin not in right and "azebo" in system.plugin:
        t.report_loss(
            "ros2-control",
            (
                f"hardware '{system.plugin}' of <ros2_control> '{system.name}' is for another "
                "version "
                "of Gazebo"
            ),
            at,
            hint=f"for {t.options.target} it is {right[0]}",
        )
    plugins = {plugin.filename for plugin in t.robot.plugins}
    if not any("ros2_control" in name or "ros_control" in name for name in plugins):
        t.report_loss(
            "ros2-control",
            f"<ros2_control> '{system.name}' is read from robot_description by a plugin of Gazebo, "
            "and the robot has none",
            system,
            hint="add the plugin gz_ros2_control-system in a <gazebo> block",
        )
    else:
        text = (
            f"<ros2_control> '{system.name}' is read from robot_description by its plugin, not "
            "from SDF"
        )
        t.report_note("ros2-control", text, system)
