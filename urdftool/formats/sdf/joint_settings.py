"""Joint settings of an actuator file, as far as SDF can express them."""

from __future__ import annotations

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.kinematics import MOVABLE
from ...model.numbers import number_text
from ..common.actuator_config import JointSettings, read_actuator_config
from ..written import Written
from .options import Options

_OF_CONTROLLERS = ("kp", "kd", "armature", "type")


def choose_joint_settings(
    robot: Robot, options: Options, written: Written
) -> dict[str, JointSettings]:
    """Choose the settings of each movable joint, by name.

    In Gazebo, gains and the kind of actuator belong to a controller, and SDF has no armature: such
    settings are reported as lost. An effort limit of SDF applies in both directions.

    Raises:
        ConfigError: The file cannot be read, or has settings for a joint that does not move.
    """
    if options.actuator_config is None:
        return {}
    names = [joint.name for joint in robot.joints if joint.type in MOVABLE]
    found = read_actuator_config(options.actuator_config).match_joints(names)
    for name, settings in found.items():
        texts = []
        left = [word for word in _OF_CONTROLLERS if getattr(settings, word) is not None]
        if left:
            texts.append(f"{', '.join(left)} of joint '{name}' cannot be expressed in SDF")
        low, high = settings.force_range or (0.0, 0.0)
        if abs(low) != abs(high):
            most = number_text(get_effort(settings.force_range))
            texts.append(
                f"force range of joint '{name}' is {low:g} to {high:g}; SDF gets {most} both ways"
            )
        if texts:
            _report_settings(robot, name, "; ".join(texts), written)
    return found


def get_effort(force_range: tuple[float, float] | None) -> float:
    """Return the effort limit of a force range [N·m or N]."""
    return max(map(abs, force_range or (0.0,)))


def _report_settings(robot: Robot, name: str, text: str, written: Written) -> None:
    place = robot.joint[name].place
    written.report_loss(
        "actuator-config", text, place, kind="joint", name=name, severity=Severity.INFO
    )
