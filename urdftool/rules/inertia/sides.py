"""The left and the right of a robot."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Robot
from ..rule import INFO, Problem, rule

_LEFT = re.compile(r"(?<![a-z])(left|Left|l|L|FL|RL|HL|fl|rl|hl)(?![a-z])")
_RIGHT = {"left": "right", "Left": "Right", "l": "r", "L": "R", "FL": "FR", "RL": "RR"} | {
    "HL": "HR",
    "fl": "fr",
    "rl": "rr",
    "hl": "hr",
}


@rule(INFO, effects={"every simulator": "the robot leans to one side"}, default=False)
def left_right_asymmetry(
    robot: Robot, *, mass_difference: float = 0.01, com_difference: float = 1e-3
) -> Iterator[Problem]:
    """A link and its mirror image differ in mass or centre of mass.

    They are told by their names, such as ``left_arm`` and ``right_arm``. One of the two was changed
    alone, or copied without turning a sign.
    """
    for link in robot.links:
        match = _LEFT.search(link.name.replace("_", " "))
        if match is None or link.inertial is None:
            continue
        name = link.name[: match.start()] + _RIGHT[match[1]] + link.name[match.end() :]
        other = robot.link.get(name)
        if other is None or other.inertial is None:
            continue
        if abs(link.mass - other.mass) > mass_difference * max(link.mass, other.mass):
            yield Problem(
                other,
                f"link '{other.name}' weighs {other.mass:g} kg and '{link.name}' {link.mass:g} kg; "
                "mirror images weigh the same",
                at=other.inertial,
            )
            continue
        one = link.inertial.origin.xyz if link.inertial.origin else (0.0, 0.0, 0.0)
        two = other.inertial.origin.xyz if other.inertial.origin else (0.0, 0.0, 0.0)
        if any(abs(abs(a) - abs(b)) > com_difference for a, b in zip(one, two, strict=True)):
            yield Problem(
                other,
                f"centre of mass of link '{other.name}' does not mirror that of '{link.name}'",
                at=other.inertial.origin or other.inertial,
            )
