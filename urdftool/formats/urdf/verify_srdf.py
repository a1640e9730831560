"""Check of the SRDF next to an export to URDF against its source, after reading it back."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from ...compare.check import Check
from ...model.elements import Robot
from ..common.losses import DeclaredLosses
from ..common.srdf import read_srdf
from ..written import Written

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
        known = declared.has_for(("lossy-exclusion",), pair.link)
        check.compare(0.0 if both in disabled else math.inf, item, known=known)
    for configuration in robot.configurations:
        state = read.states.get(configuration.name, {})
        for joint, value in configuration.positions.items():
            if joint in robot.joint and robot.joint[joint].mimic is None:
                written = state.get(names.get(("joint", joint), joint), math.inf)
                check.compare(abs(written - value), f"'{configuration.name}': joint '{joint}'")
    return check
