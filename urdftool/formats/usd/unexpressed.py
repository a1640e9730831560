"""Losses of parts of a description for which the schemas of physics have no place."""

from __future__ import annotations

from collections.abc import Iterator

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.part import Part
from ...model.settings import SPRING, Setting
from ..common.unexpressed import (
    report_blocks,
    report_looks,
    report_unexpressed,
    report_unwritten_settings,
)
from ..written import Written

EXPRESSED = (
    "closure",
    "joint-actuator",
    "exclusion",
    "frame",
    "base",
    "joint-spring",
    "joint-armature",
    "setting",
)
"""Codes of parts of SDF and MJCF that an export to USD writes, or reports itself."""


def report_losses(robot: Robot, written: Written) -> None:
    """Report each part that is not written."""
    report_unexpressed(robot, written, expressed=EXPRESSED)
    report_unwritten_settings(robot, written, _is_written)
    report_blocks(robot, written)
    report_looks(robot, written)
    for code, what, part, name in _list_parts(robot):
        written.report_loss(
            code,
            f"{what} is not written",
            part.place,
            kind="joint" if name else "",
            name=name,
            severity=Severity.INFO,
        )


def _is_written(row: Setting) -> bool:
    """Tell whether an export writes a setting, or reports it itself."""
    return bool(row.usd) or row.name in (*SPRING, "self_collide")


def _list_parts(robot: Robot) -> Iterator[tuple[str, str, Part, str]]:
    for joint in robot.joints:
        if joint.safety_controller is not None:
            what = f"<safety_controller> of joint '{joint.name}'"
            yield "safety-controller", what, joint.safety_controller, joint.name
        if joint.calibration is not None:
            what = f"<calibration> of joint '{joint.name}'"
            yield "calibration", what, joint.calibration, joint.name
    for transmission in robot.transmissions:
        yield "transmission", f"transmission '{transmission.name}'", transmission, ""
    for control in robot.ros2_controls:
        yield "ros2-control", f"<ros2_control> '{control.name}'", control, ""
    inside = {id(plugin) for sensor in robot.sensors for plugin in sensor.plugins}
    for plugin in robot.plugins:
        if id(plugin) not in inside:
            yield "plugin", f"plugin '{plugin.filename or plugin.name}'", plugin, ""
    for sensor in robot.sensors:
        yield "sensor", f"sensor '{sensor.name}' of type {sensor.type}", sensor, ""
