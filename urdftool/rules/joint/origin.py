"""Rules on the rotation of an ``<origin>``."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.angles import format_angles
from ...model.elements import Robot
from ..fix import FixContext, Proposal, find_attribute, set_attribute, unsafe
from ..rule import INFO, UNSAFE, WARNING, Problem, rule
from ..xml.owner import describe_owner
from ..xml.vocabulary_table import get_census

_DEGREES = frozenset(map(float, (*range(30, 361, 30), *range(45, 361, 45))))


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic": "take it as radians, without a message",
    },
    pedantic="angles that are not common in degrees, as of exporters that keep turns",
)
def rpy_in_degrees(robot: Robot, *, largest: float = 2 * math.pi + 0.01) -> Iterator[Problem]:
    """A rotation of an ``<origin>`` is more than one turn.

    Roll, pitch and yaw are in radians. 90 means 90 rad, which is the same rotation as 116.6°, so
    the part has a wrong orientation. An angle that is not common in degrees is an info: some
    exporters do not reduce angles to one turn. ``largest`` [rad] is the largest angle that is not
    reported.
    """
    for element in get_census(robot).known["origin"]:
        text = element.attributes.get("rpy")
        if not text:
            continue
        try:
            angles = [float(word) for word in text.split()]
        except ValueError:
            continue
        angle = max(angles, key=abs, default=0.0)
        if abs(angle) <= largest or not math.isfinite(angle):
            continue
        data: dict[str, object] = {"angle": angle}
        if abs(angle) in _DEGREES:
            data |= {"degrees": True, "write": format_angles(map(math.radians, angles))}
            shown = format_angles(map(math.radians, angles), 6)
            what = f"has {angle:g} in its rpy, apparently degrees; write {shown} in radians"
        else:
            turned = math.degrees(math.remainder(angle, 2 * math.pi))
            what = f"has {angle:g} rad in its rpy, the same as {turned:.4g}°; is it in degrees?"
        around = element.parent.tag if element.parent is not None else "robot"
        whose = (
            describe_owner(element)
            if around == "joint"
            else f"the <{around}> of {describe_owner(element)}"
        )
        yield Problem(
            element,
            f"{whose} {what}",
            at=element.locate_attribute("rpy"),
            severity=WARNING if "degrees" in data else INFO,
            data=data,
            pedantic="degrees" not in data,
        )


@rpy_in_degrees.fix(UNSAFE)
def write_angles_in_radians(problem: Problem, _context: FixContext) -> Proposal | None:
    """Write the same angles in radians."""
    found = find_attribute(problem)
    if found is None or "degrees" not in problem.data:
        return None
    text = problem.data["write"]
    return unsafe(f'write rpy="{text}"', set_attribute(*found, text))
