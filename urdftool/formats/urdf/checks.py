"""Checks of an export to URDF, which is read back after it is written."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from ...compare.check import Check
from ...compare.difference import EXISTENCE
from ...compare.proof import Claims, Excuse, prove
from ...compare.rows import EQUIPMENT_ROWS, ROWS
from ...model.elements import Robot
from ..common.directory import place_export
from ..common.losses import DeclaredLosses
from ..common.srdf import read_srdf
from ..written import Written
from .options import Options
from .read import read

NOT_COMPARED = ("contact bits", "solver and other settings of the world", "closed loops")
"""Parts of a description that no check compares."""

_EXCUSES = (
    Excuse(("tree",), frozenset(("lossy-ball", "lossy-screw")), ends=("_x", "_y", "_z")),
    Excuse(("collisions", "visuals"), frozenset(("lossy-shape",))),
    Excuse(("surface",), frozenset(("lossy-surface",))),
    Excuse(("looks",), frozenset(("lossy-appearance",))),
    Excuse(("joint physics",), frozenset(("lossy-spring",))),
    Excuse(("sensors",), frozenset(("lossy-sensor",))),
    Excuse(("sensors",), frozenset(("lossy-optical-frame",)), properties=("frame",)),
    Excuse(("actuators",), frozenset(("lossy-actuator",))),
    Excuse(("simulator data",), frozenset(("lossy-addition",))),
    Excuse(
        ("simulator data",), frozenset(("lossy-other-element",)), "robot", properties=(EXISTENCE,)
    ),
)
"""Rows whose differences a loss explains."""

_EXTENSIONS = {
    "urdf": ("simulator data",),
    "sdf": ("sensors",),
    "mjcf": ("sensors", "actuators"),
    "usd": ("actuators",),
}
"""Rows of extensions by the format of the source."""


def check_output(
    robot: Robot, options: Options, written: Written, output: str | Path | None
) -> list[Check]:
    """Read an export back and compare it with its source.

    Without an output, it is a temporary copy.
    """
    name = options.file or "robot"
    with place_export(written, output, name, single=bool(options.file)) as path:
        return _compare(robot, written, path if options.file else path / written.main)


def _drop_rotors(robot: Robot, written: Written) -> Robot:
    """Return the robot without the armature of its joints, if the export declares that loss."""
    if all(loss.code != "lossy-armature" for loss in written.losses):
        return robot
    joints = [
        joint
        if joint.dynamics is None
        else replace(joint, dynamics=replace(joint.dynamics, armature=None))
        for joint in robot.joints
    ]
    return replace(robot, joints=joints)


def _compare(robot: Robot, written: Written, path: Path) -> list[Check]:
    reading = read(path)
    robot = written.planned or robot
    claims = Claims(written.losses, written.renamed, _EXCUSES, reading.losses)
    more = _EXTENSIONS.get(robot.format, ())
    rows = [row for row in ROWS if row.name not in EQUIPMENT_ROWS or row.name in more]
    checks = prove(_drop_rotors(robot, written), reading.robot, claims, rows=rows)
    if robot.xml is None:  # the extensions of a URDF source are copied
        declared = DeclaredLosses.from_findings(written.losses)
        checks.append(check_srdf(robot, reading.robot, path, written.renamed, declared))
    return checks


_TOLERANCE = 1e-6
"""Largest difference of positions [rad, m]; chosen, no source."""


def check_srdf(
    robot: Robot,
    result: Robot,
    path: Path,
    names: Mapping[tuple[str, str], str],
    declared: DeclaredLosses,
) -> Check:
    """Compare excluded contacts and named positions."""
    check = Check("srdf", "excluded contacts, named joint positions [rad, m]", _TOLERANCE)
    check.is_empty = not (robot.exclusions or robot.configurations)
    if check.is_empty:
        return check
    file, problems = path.with_suffix(".srdf"), Written(path.name)
    if not file.is_file():
        known = declared.has_any("lossy-exclusion", "lossy-configuration")
        check.compare(math.inf, "the SRDF file", known=known)
        return check
    read = read_srdf(file, result, problems, None)
    for problem in problems.losses:
        check.compare(math.inf, problem.message)
    disabled = {frozenset(pair) for pair in read.disabled}
    for pair in robot.exclusions:
        both = frozenset(names.get(("link", name), name) for name in (pair.link, pair.other))
        item = f"contact of '{pair.link}' and '{pair.other}'"
        known = declared.has_for(("lossy-exclusion",), pair.link, pair.other)
        check.compare(0.0 if both in disabled else math.inf, item, known=known)
    for configuration in robot.configurations:
        state = read.states.get(configuration.name, {})
        for joint, value in configuration.positions.items():
            if joint in robot.joint and robot.joint[joint].mimic is None:
                written = state.get(names.get(("joint", joint), joint), math.inf)
                check.compare(abs(written - value), f"'{configuration.name}': joint '{joint}'")
    return check
