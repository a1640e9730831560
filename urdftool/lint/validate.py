"""Decide whether a robot can be used for a purpose, by the rules of ``lint``.

A purpose is a tuple of requirements: rules none of whose problems it accepts. The rules run in
full: also what ``lint`` leaves to the finding of another rule keeps a robot from being exported.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

from ..diagnostic import Severity
from ..errors import ModelError
from ..finding import Finding
from ..model.elements import Joint, Link, Robot
from ..model.urdf_schema import VOCABULARY
from ..rules import get_rule
from ..rules.rule import Problem


class Requirement(NamedTuple):
    """A rule whose problems a purpose does not accept.

    Attributes:
        rule: Its name.
        where: Values that the data of a problem may have, by key; others are accepted.
        most: How many of its problems are reported; None for all.
    """

    rule: str
    where: Mapping[str, frozenset[object]] = MappingProxyType({})
    most: int | None = None


def _make_conditions(**values: Iterable[object]) -> Mapping[str, frozenset[object]]:
    return MappingProxyType({key: frozenset(allowed) for key, allowed in values.items()})


_NAMED = _make_conditions(has_name=(True,))
_DETACHED = _make_conditions(is_detached=(True,), has_root=(True,))
_NO_BALL = _make_conditions(is_ball=(False,))
_WRITTEN = _make_conditions(
    part=("link", "joint", "material"),
    attribute=tuple(
        name
        for tag, kind in VOCABULARY.items()
        for name in kind.numbers
        if name in kind.held and tag not in ("safety_controller", "calibration")
    ),
)
"""Numbers that an export writes."""

ENDS = tuple(
    map(Requirement, ("missing-parent-or-child", "unknown-parent-link", "unknown-child-link"))
)
"""Joints join two links of the robot."""

STRUCTURE = (
    Requirement("no-links"),
    Requirement("missing-name"),
    Requirement("duplicate-link-name", _NAMED),
    Requirement("duplicate-joint-name", _NAMED),
    *ENDS,
    Requirement("multiple-parents"),
    Requirement("no-root"),
    Requirement("multiple-roots"),
    Requirement("detached-cycle", _DETACHED, most=1),
    Requirement("not-a-number", _WRITTEN),
    Requirement("unknown-joint-type", _NO_BALL),
    Requirement("zero-axis"),
    Requirement("lower-above-upper"),
    Requirement("mimic-unknown-joint"),
    Requirement("mimic-cycle"),
    Requirement("immense-number"),
    Requirement("negative-mass"),
)
"""The links are one tree, by names that are unique, and the numbers can be used."""

_PHYSICS = tuple(
    map(
        Requirement,
        (
            *("zero-inertia", "inertia-not-positive-definite", "inertia-triangle-inequality"),
            *("inertia-component-typo", "inertia-off-by-power-of-ten"),
        ),
    )
)
"""Rigid bodies can have the inertia that is written."""

_IN_BLOCK = _make_conditions(is_loop=(True, False))
_NOT_IN_DRAKE = _make_conditions(is_in_drake=(False,))

PURPOSES: Mapping[str, tuple[Requirement, ...]] = MappingProxyType(
    {
        "links": (Requirement("no-links"),),
        "graph": (
            Requirement("multiple-roots"),
            Requirement("detached-cycle"),
            Requirement("multiple-parents", _NAMED),
            Requirement("duplicate-link-name"),
            Requirement("duplicate-joint-name"),
            Requirement("joint-to-itself"),
            *ENDS,
        ),
        "join": ENDS,
        "edit": (
            Requirement("not-a-number", _make_conditions(part=("link", "joint", "material"))),
        ),
        "export": STRUCTURE,
        "simulate": (
            Requirement("missing-collision"),
            Requirement("non-positive-dimension", _make_conditions(collides=(True,))),
            Requirement("zero-mass"),
            Requirement("missing-inertial"),
            Requirement("massless-root-body"),
            Requirement("massless-moving-body"),
            *_PHYSICS,
            Requirement("incomplete-inertial"),
            Requirement("placeholder-inertia"),
            Requirement("inertia-exceeds-geometry"),
            Requirement("radius-of-gyration"),
            Requirement("implausible-density", _make_conditions(is_too_large=(True,))),
            Requirement("mass-outlier"),
            Requirement("plugin-unknown-entity"),
            Requirement("mesh-in-millimeters"),
            Requirement("shape-in-millimeters"),
        ),
        "inertia": (
            Requirement("negative-mass"),
            Requirement("zero-mass"),
            *_PHYSICS,
            Requirement("singular-inertia"),
            Requirement("inertia-triangle-inequality-rounding"),
            Requirement("placeholder-inertia"),
        ),
        "inertia:lump": (Requirement("no-root"), Requirement("multiple-roots")),
        "export:sdf": (
            Requirement("empty-geometry"),
            Requirement("unsupported-shape"),
            Requirement("missing-limit"),
            Requirement("incomplete-inertial", _make_conditions(lacks_element=(True,))),
            Requirement("mimic-dof-mismatch", _make_conditions(type=("fixed",))),
            Requirement("not-a-number", _make_conditions(part=("robot",))),
            Requirement("unknown-sensor-type"),
            Requirement("plugin-without-filename", _make_conditions(has_filename=(False,))),
            Requirement("bad-extension-number"),
            Requirement("invalid-sdf-value", _IN_BLOCK),
        ),
        "export:mjcf": (
            Requirement("empty-geometry"),
            Requirement("unsupported-shape", _NOT_IN_DRAKE),
            Requirement("bad-extension-number", _make_conditions(kind=("number", "count"))),
            Requirement("invalid-sdf-value", _make_conditions(is_loop=(True,))),
            Requirement("bad-mujoco-value"),
        ),
        "export:usd": (Requirement("empty-geometry"), Requirement("unsupported-shape")),
    }
)
"""What each purpose requires of a robot, in the order in which it is reported.

``export:sdf``, ``export:mjcf`` and ``export:usd`` come on top of ``export``."""


def validate(robot: Robot, purpose: str) -> list[Finding]:
    """Report what keeps a robot from being used for a purpose of ``PURPOSES``, as errors."""
    return [as_error(rule, problem) for rule, problem in find_problems(robot, purpose)]


def require(robot: Robot, purpose: str) -> Robot:
    """Return a robot that can be used for a purpose, a key of ``PURPOSES``.

    Raises:
        ModelError: It cannot; the message is that of the first problem, the notes are the others.
    """
    first, *others = validate(robot, purpose) or (None,)
    if first is not None:
        raise ModelError(first.message, at=first.location, notes=[str(other) for other in others])
    return robot


def find_problems(robot: Robot, purpose: str) -> Iterator[tuple[str, Problem]]:
    """Yield the problems that a purpose does not accept, each with the name of its rule.

    Args:
        robot: Any robot; one that was not read from URDF is checked by the rules that need no text,
            because its reader has checked the values.
        purpose: A key of ``PURPOSES``.
    """
    for name, where, most in PURPOSES[purpose]:
        rule = get_rule(name)
        if robot.format not in rule.formats or (robot.xml is None and len(rule.formats) == 1):
            continue
        check = rule.full_check or rule.check
        number = 0
        for problem in check(robot):
            if all(problem.data.get(key) in values for key, values in where.items()):
                if number == most:
                    break
                number += 1
                yield name, problem


def as_error(rule: str, problem: Problem) -> Finding:
    """Make a finding of severity error of a rule's problem."""
    part, kind, name = problem.subject, problem.kind, problem.name
    if isinstance(part, Link | Joint):  # which may be renamed, or made of another element
        kind, name = "link" if isinstance(part, Link) else "joint", part.name
    return Finding(
        rule,
        Severity.ERROR,
        problem.message,
        problem.place,
        kind,
        name,
        hint=problem.hint,
        owner=problem.owner,
        data=problem.data,
    )
