"""What keeps a robot from leaving in any language: one finding a defect, with its place.

Each bears the name that the linter gives it. Those in ``FATAL`` leave no robot to write; past the
others an exporter can go on if it is told to, and says what it did instead.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ..errors import ModelError
from ..finding import Finding, Severity
from ..lint.validate import validate
from ..model.elements import Robot
from ..model.read import numbers
from ..model.world import with_world
from ..source.document import Element
from ..source.location import Place

ENORMOUS = 1e30
"""No mass, size or distance is larger; beyond, squares of numbers end in infinity."""

FATAL = frozenset(
    ("no-links", "no-root", "multiple-roots", "multiple-parents", "duplicate-link-name",
     "duplicate-joint-name", "unknown-parent-link", "unknown-child-link", "missing-parent-or-child",
     "missing-name", "detached-cycle", "immense-number")
)  # fmt: skip

_SIZES: dict[str, dict[str, int]] = {
    "origin": {"xyz": 3, "rpy": 3, "quat_xyzw": 4},
    "mass": {"value": 1},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), 1),
    "box": {"size": 3},
    "cylinder": {"radius": 1, "length": 1},
    "capsule": {"radius": 1, "length": 1},
    "sphere": {"radius": 1},
    "mesh": {"scale": 3},
    "color": {"rgba": 4},
    "axis": {"xyz": 3},
    "mimic": {"multiplier": 1, "offset": 1},
}
"""Numbers of masses, sizes and distances, and how many an attribute takes, by its element."""


class Refused(ModelError):  # noqa: N818 -- reads as what happened
    """The robot has defects past which it cannot be written.

    Attributes:
        findings: One for each defect.
    """

    def __init__(self, findings: Sequence[Finding]) -> None:
        """Take the findings, of which there is at least one."""
        first, *others = findings
        super().__init__(first.message, at=first.place, notes=[str(other) for other in others])
        self.findings = list(findings)


def refuse(findings: Iterable[Finding], *, force: bool, fatal: frozenset[str] = FATAL) -> None:
    """Raise where defects forbid an export.

    Args:
        findings: Defects.
        force: Go past those that leave a robot.
        fatal: Names of those that leave none.

    Raises:
        Refused: With those that forbid it.
    """
    forbidding = [f for f in findings if not force or f.rule in fatal]
    if forbidding:
        raise Refused(forbidding)


def defects(robot: Robot) -> Iterator[Finding]:
    """Each defect of a robot's links, joints and numbers; meshes are looked at elsewhere."""
    yield from validate(robot, "export")
    yield from _immense_numbers(robot)


def taken_world(robot: Robot) -> tuple[Robot, list[Finding]]:
    """A robot with the world that it names and does not declare, and the defects that this is.

    Args:
        robot: Any robot; it is copied unchanged.
    """
    whole, joint = with_world(robot)
    if joint is None:
        return robot, []
    remain = set(map(identity, validate(whole, "join")))
    return whole, [f for f in validate(robot, "join") if identity(f) not in remain]


def identity(finding: Finding) -> tuple[str, Place, str]:
    """Get what two findings about one defect of a robot have in common."""
    return finding.rule, finding.place, finding.name


def defect(
    rule: str,
    message: str,
    place: Place,
    kind: str = "",
    name: str = "",
    hint: str = "",
    data: Mapping[str, object] | None = None,
) -> Finding:
    """Make a finding of severity error."""
    return Finding(rule, Severity.ERROR, message, place, kind, name, hint=hint, data=data or {})


def _immense_numbers(robot: Robot) -> Iterator[Finding]:
    for part in (*robot.links, *robot.joints, *robot.materials):
        for element in part.element.walk():
            for attribute, count in _SIZES.get(element.tag, {}).items():
                values = numbers(element.get(attribute), count) or ()
                if any(abs(value) > ENORMOUS for value in values):
                    yield _immense_number(element, attribute, part.element)


def _immense_number(element: Element, attribute: str, part: Element) -> Finding:
    return defect(
        "immense-number",
        f'{attribute}="{element.get(attribute)}" of <{element.tag}> in {part.tag} '
        f"'{part.get('name') or ''}' is above {ENORMOUS:g}; write one that a robot can have",
        element.attribute_place(attribute),
        part.tag,
        part.get("name") or "",
    )
