"""The controllers of a file, for ``urdftool simulate``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from ..console import Console

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..simulation.settings import Settings


def controlled(
    console: Console, settings: Settings, robot: Robot, path: str | None, *, strict: bool = False
) -> Settings:
    """Settings under which the controllers of a file drive the joints.

    Args:
        console: What is passed over in the file is said there.
        settings: Others.
        robot: The robot.
        path: The file; None for none, which leaves the settings as they are.
        strict: Refuse controllers of an unknown type.

    Raises:
        ConfigError: The file does not suit the robot.
        SourceError: It cannot be read.
        UsageError: The joints are to be held or limp as well.
    """
    if path is None:
        return settings
    if settings.hold != "all":
        raise click.UsageError(
            "--controllers says what holds the joints; leave out --limp and --hold-actuated"
        )
    from ..simulation.controllers import read_controllers

    controls = read_controllers(path, robot, strict=strict)
    for note in controls.notes:
        console.note(note)
    return replace(settings, controls=controls.joints)
