"""What lint knows of a robot's file, in its own words: one fact is not told in two ways.

A simulation decides whether a defect matters in this run. What the defect is, and which rule
explains it, is said as ``urdftool lint`` says it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from ..errors import UrdftoolError
from ..model.elements import Robot
from .fault import Fault
from .mesh_cache import cached_for

RULES = {
    "impossible-inertia": (
        *("zero-inertia", "inertia-not-positive-definite", "inertia-triangle-inequality"),
        *("inertia-component-slip", "inertia-off-by-power-of-ten"),
    ),
    "inertia-too-large": (
        *("placeholder-inertia", "inertia-off-by-power-of-ten", "inertia-exceeds-geometry"),
        "radius-of-gyration",
    ),
    "too-dense": ("implausible-density", "implausible-mass"),
    "no-mass": ("zero-mass", "missing-inertial"),
}
"""Lint rules that report what a kind of fault is, the one that says most first."""


def in_lint_words(robot: Robot, faults: Iterable[Fault]) -> Iterator[Fault]:
    """Yield faults with the message and rule of lint's finding on the same link, if any.

    Args:
        robot: The robot, which was read from a description.
        faults: Of its file.
    """
    for fault in faults:
        rules = RULES.get(fault.kind, ())
        known = _findings(robot) if rules and robot.source is not None else {}
        rule = next((rule for rule in rules if (rule, fault.name) in known), None)
        yield fault if rule is None else replace(fault, message=known[rule, fault.name], rule=rule)


def _findings(robot: Robot) -> dict[tuple[str, str], str]:
    """Return messages of lint by rule and link; none if its configuration cannot be read."""

    def run() -> dict[tuple[str, str], str]:
        from ..lint.run import check

        try:
            found = check(
                robot, select=sorted({name for names in RULES.values() for name in names})
            )
        except UrdftoolError:
            return {}
        return {(finding.rule, finding.name): finding.message for finding in reversed(found)}

    return cached_for(robot, "lint", run)
