"""Gains and ranges of actuators that a ``<ros2_control>`` block has as parameters.

``export urdf`` of an MJCF writes ``kp``, ``kv``, ``min`` and ``max`` of a command interface, so an
export of that URDF has the same actuators as the MJCF.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...model.elements import Robot
from ...model.extensions import Interface
from ...model.read import parse_numbers
from .actuator_config import JointSettings, read_actuator_config


def list_described_gains(robot: Robot) -> dict[str, JointSettings]:
    """Return the settings of the joints whose command interface has gains, by joint name."""
    found = {}
    for block in robot.ros2_controls:
        for part in block.joints:
            for interface in part.command_interfaces[:1]:
                settings = _read_gains(interface)
                if settings is not None:
                    found[part.name] = settings
    return found


def choose_joint_settings(
    robot: Robot, names: Iterable[str], config: Path | None
) -> dict[str, JointSettings]:
    """Choose the settings of joints, by name: those of the user, then those of the description.

    Raises:
        ConfigError: The file cannot be read, or has settings for a joint that does not move.
    """
    settings = dict.fromkeys(names, JointSettings())
    if config is not None:
        settings = read_actuator_config(config).match_joints(settings)
    described = list_described_gains(robot)
    return {name: own.override(described.get(name, own)) for name, own in settings.items()}


def _read_gains(interface: Interface) -> JointSettings | None:
    """Read the gains of an interface; None without any that counts."""
    kp, kv, low, high = (_read(interface, name) for name in ("kp", "kv", "min", "max"))
    ends = (low, high) if low is not None and high is not None and low < high else None
    if interface.name == "position" and kp:
        return JointSettings(kp=kp, kd=kv or 0.0, command_range=ends)
    if interface.name == "velocity" and kv:
        return JointSettings(kd=kv, command_range=ends)
    return None


def _read(interface: Interface, name: str) -> float | None:
    """Read a parameter; None if it is missing or not a number from zero on, or infinite."""
    numbers = parse_numbers(interface.params.get(name), 1)
    if numbers is None or (name in ("kp", "kv") and numbers[0] < 0):
        return None
    return numbers[0]
