"""Content of a new SRDF."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from ..model.elements import Robot
from ..model.kinematics import find_movable_joints
from ..model.semantic import DisabledPair, SemanticDescription
from .groups import GivenGroup, add_groups, find_groups
from .verdicts import ADJACENT, ALWAYS, DEFAULT, NEVER, Verdict, Verdicts
from .write import format_position

REASONS = {ADJACENT: "Adjacent", NEVER: "Never", ALWAYS: "Always", DEFAULT: "Default"}
"""Reason that an SRDF has for each kind of disabled pairs."""


def make_semantic(
    robot: Robot, verdicts: Verdicts, given: Sequence[GivenGroup] = ()
) -> SemanticDescription:
    """Make the semantic description of a robot: groups, states, pairs that need no check.

    Raises:
        ConfigError: A given group is not a chain of the robot.
    """
    content = SemanticDescription(None, robot.name, disabled=list_disabled(verdicts))
    add_groups(content, find_groups(robot, given))
    return content


def list_disabled(
    verdicts: Verdicts, kinds: Collection[str] = tuple(REASONS)
) -> list[DisabledPair]:
    """List the pairs that need no check, with the proof as comment."""
    return [
        DisabledPair(None, v.link1, v.link2, REASONS[v.kind], describe_proof(v))
        for v in verdicts.pairs
        if v.kind in REASONS and v.kind in kinds
    ]


def describe_proof(verdict: Verdict) -> str:
    """Describe why a pair is disabled; empty if its reason suffices."""
    if verdict.kind == NEVER:
        return f"proved, {verdict.boxes} boxes" if verdict.boxes > 1 else "proved"
    if verdict.kind == ALWAYS:
        return "fixed to each other, in contact"
    return ""


def describe_ranges(robot: Robot, verdicts: Verdicts) -> str:
    """Describe the joint values for which a proof holds; joints without limits make one turn."""
    movable = find_movable_joints(robot)
    parts = []
    for name, (lower, upper) in verdicts.ranges.items():
        unit = "m" if name in movable and movable[name].type == "prismatic" else "rad"
        parts.append(f"{name} {format_position(lower)} to {format_position(upper)} {unit}")
    return ", ".join(parts)


def list_comments(robot: Robot, verdicts: Verdicts) -> Iterator[str]:
    """Yield the comments at the start of an SRDF: how the pairs were decided."""
    yield "Written by urdftool srdf. Never: proved for all joint values in these ranges."
    if verdicts.ranges:
        yield describe_ranges(robot, verdicts)


def format_positions(positions: Mapping[str, float]) -> str:
    """Format joint positions as ``joint value`` with four decimals, separated by commas."""
    return ", ".join(f"{name} {value + 0.0:.4f}" for name, value in positions.items())
