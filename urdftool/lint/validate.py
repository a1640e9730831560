"""Decide whether a robot can be used for a purpose, by the rules of ``lint``.

A purpose is a tuple of requirements: rules none of whose problems it accepts. The rules run in
full: also what ``lint`` leaves to the finding of another rule keeps a robot from being exported.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

from ..finding import Finding, Severity
from ..model.elements import Robot
from ..rules import get_rule
from ..rules.rule import Problem


class Requirement(NamedTuple):
    """A rule whose problems a purpose does not accept.

    Attributes:
        rule: Its name.
        where: Values that the data of a problem must have; others are accepted.
        most: How many of its problems are reported; None for all.
    """

    rule: str
    where: Mapping[str, object] = MappingProxyType({})
    most: int | None = None


_ENDS = tuple(
    map(Requirement, ("missing-parent-or-child", "unknown-parent-link", "unknown-child-link"))
)
_NAMED = MappingProxyType({"has_name": True})

PURPOSES: Mapping[str, tuple[Requirement, ...]] = MappingProxyType(
    {
        "graph": (
            Requirement("multiple-roots"),
            Requirement("detached-cycle"),
            Requirement("multiple-parents", _NAMED),
            Requirement("duplicate-link-name"),
            Requirement("duplicate-joint-name"),
            Requirement("joint-to-itself"),
            *_ENDS,
        ),
    }
)
"""What each purpose requires of a robot, in the order in which it is reported."""


def validate(robot: Robot, purpose: str) -> list[Finding]:
    """Report what keeps a robot from being used for a purpose, as errors.

    Args:
        robot: Any robot; one that was not read from a description, too.
        purpose: A key of ``PURPOSES``.
    """
    return [as_error(rule, problem) for rule, problem in find_problems(robot, purpose)]


def find_problems(robot: Robot, purpose: str) -> Iterator[tuple[str, Problem]]:
    """Yield the problems that a purpose does not accept, each with the name of its rule.

    Args:
        robot: Any robot.
        purpose: A key of ``PURPOSES``.
    """
    for name, where, most in PURPOSES[purpose]:
        rule = get_rule(name)
        check = rule.full_check or rule.check
        number = 0
        for problem in check(robot):
            if all(problem.data.get(key) == value for key, value in where.items()):
                if number == most:
                    break
                number += 1
                yield name, problem


def as_error(rule: str, problem: Problem) -> Finding:
    """Make a finding of severity error of a rule's problem."""
    return Finding(
        rule,
        Severity.ERROR,
        problem.message,
        problem.place,
        problem.kind,
        problem.name,
        hint=problem.hint,
        data=problem.data,
    )
