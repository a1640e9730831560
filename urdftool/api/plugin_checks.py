"""Findings of lint rules on the plugins of a robot, which exports report as losses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..diagnostic import Severity
from ..errors import ConfigError
from ..finding import Finding
from ..model.elements import Robot
from .lint import check

PLUGIN_RULES = (
    "plugin-unknown-entity",
    "plugin-class-mismatch",
    "unknown-extension",
    "duplicate-plugin-name",
    "drive-size-mismatch",
    "drive-direction-mismatch",
)
"""Lint rules on parameters with which a simulator loads a plugin that then does not work."""

NAME_RULES = ("plugin-unknown-entity",)
"""Lint rules on the names of joints and links in plugins."""


def check_plugin_names(robot: Robot) -> list[Finding]:
    """Report the joints and links that plugins name and the robot does not have, as warnings.

    The exports to MJCF and USD read from plugins which joints are driven.
    """
    return check_plugins(robot, "gz", NAME_RULES)


def check_plugins(robot: Robot, target: str, rules: Sequence[str] = PLUGIN_RULES) -> list[Finding]:
    """Check the parameters of the plugins of a robot by lint rules.

    Args:
        robot: The robot.
        target: ``gz`` or ``gazebo-classic``.
        rules: Names of the rules.

    Returns:
        Findings as warnings, each with its place in the description.
    """
    if robot.source is None or not robot.plugins:
        return []
    try:
        findings = check(robot, select=rules, targets=(target,))
    except ConfigError:  # of the lint configuration, reported by lint
        return []
    return [replace(f, severity=Severity.WARNING) for f in findings if _is_of_plugin(robot, f)]


def _is_of_plugin(robot: Robot, finding: Finding) -> bool:
    place = finding.location
    return any(
        plugin.place.path == place.path and plugin.element.start <= place.start < plugin.element.end
        for plugin in robot.plugins
    )
