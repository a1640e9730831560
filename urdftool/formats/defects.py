"""What keeps a robot from leaving in any language: one finding a defect, with its place.

Each bears the name that the linter gives it. Those in ``FATAL`` leave no robot to write; past the
others an exporter can go on if it is told to, and says what it did instead.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain

from ..errors import ModelError
from ..finding import Finding, Severity
from ..model.elements import JOINT_TYPES, Joint, Link, Robot
from ..model.load import without_links
from ..model.pose import norm
from ..model.read import numbers
from ..model.world import WORLD, with_world
from ..source.document import Element
from ..source.location import Place

ENORMOUS = 1e30
"""No mass, size or distance is larger; beyond, squares of numbers end in infinity."""

FATAL = frozenset(
    ("no-links", "no-root", "multiple-roots", "multiple-parents", "duplicate-link-name",
     "duplicate-joint-name", "unknown-parent-link", "unknown-child-link", "missing-parent-or-child",
     "missing-name", "detached-cycle", "immense-number")
)  # fmt: skip

BALL_TYPES = frozenset(("spherical", "ball"))
"""Joint types that URDF does not know and several readers do."""

# tag -> attribute -> how many numbers
NUMBERS: dict[str, dict[str, int]] = {
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
    "limit": dict.fromkeys(("lower", "upper", "effort", "velocity"), 1),
    "dynamics": {"damping": 1, "friction": 1},
    "mimic": {"multiplier": 1, "offset": 1},
}


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
    structural = list(chain(_names(robot), _ends(robot), _roots(robot)))
    yield from structural
    yield from _numbers(robot)
    yield from _joints(robot)


def taken_world(robot: Robot) -> tuple[Robot, list[Finding]]:
    """A robot with the world that it names and does not declare, and the defects that this is.

    Args:
        robot: Any robot; it stays as it is.
    """
    whole, joint = with_world(robot)
    if joint is None:
        return robot, []
    remain = set(map(str, _ends(whole)))
    return whole, [finding for finding in _ends(robot) if str(finding) not in remain]


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


def _names(robot: Robot) -> Iterator[Finding]:
    if wrong := without_links(robot):
        yield defect("no-links", wrong, robot.place, "robot")
    named: tuple[tuple[str, Sequence[Link | Joint]], ...] = (
        ("link", robot.links),
        ("joint", robot.joints),
    )
    for kind, parts in named:
        seen: dict[str, Link | Joint] = {}
        for part in parts:
            if not part.name:
                yield defect("missing-name", f"a {kind} has no name", part.place, kind)
            elif part.name in seen:
                yield defect(
                    f"duplicate-{kind}-name",
                    f"{kind} '{part.name}' is there already ({seen[part.name].place}); rename one",
                    part.element.attribute_place("name"),
                    kind,
                    part.name,
                )
            seen.setdefault(part.name, part)


def _ends(robot: Robot) -> Iterator[Finding]:
    for joint in robot.joints:
        for end, name, element in (
            ("parent", joint.parent, joint.parent_element),
            ("child", joint.child, joint.child_element),
        ):
            if not name:
                place = joint.place if element is None else element.place
                yield defect(
                    "missing-parent-or-child",
                    f"joint '{joint.name}' names no {end} link",
                    place,
                    "joint",
                    joint.name,
                )
            elif name not in robot.link and element is not None:
                hint = '; write <link name="world"/> first' if name == WORLD else ""
                yield defect(
                    f"unknown-{end}-link",
                    f"{end} link '{name}' of joint '{joint.name}' does not exist{hint}",
                    element.attribute_place("link"),
                    "joint",
                    joint.name,
                )


def _roots(robot: Robot) -> Iterator[Finding]:
    tree = robot.tree
    for name, joints in tree.joints_of_child.items():
        for joint in joints[1:]:
            if name in robot.link:
                yield defect(
                    "multiple-parents",
                    f"link '{name}' is the child of joint '{joints[0].name}' and of "
                    f"'{joint.name}'; a link hangs on one joint",
                    (joint.child_element or joint.element).place,
                    "link",
                    name,
                )
    if robot.links and not tree.roots:
        yield defect(
            "no-root",
            "every link is some joint's child, so there is no root; one must be nobody's child",
            robot.place,
            "robot",
        )
    elif len(tree.roots) > 1:
        for link in tree.roots[1:]:
            yield defect(
                "multiple-roots",
                f"link '{link.name}' hangs on nothing, and so does '{tree.roots[0].name}'; a robot "
                "has one root",
                link.place,
                "link",
                link.name,
            )
    if tree.roots:
        for link in [link for link in tree.detached if _is_in_loop(robot, link)][:1]:
            yield defect(
                "detached-cycle",
                f"link '{link.name}' hangs on a loop of joints, not on the root",
                link.place,
                "link",
                link.name,
            )


def _is_in_loop(robot: Robot, link: Link) -> bool:
    """Whether no root is above a link; one that hangs on a link that does not exist is told so."""
    *_, top = (link.name, *robot.tree.ancestors(link.name))
    joint = robot.tree.parent_joint(top)
    return joint is not None and joint.parent in robot.link


def _joints(robot: Robot) -> Iterator[Finding]:
    for joint in robot.joints:
        if joint.type not in JOINT_TYPES | BALL_TYPES:
            yield defect(
                "unknown-joint-type",
                f"joint '{joint.name}' has type '{joint.type}'; the types are "
                + ", ".join(sorted(JOINT_TYPES)),
                joint.element.attribute_place("type"),
                "joint",
                joint.name,
            )
        if joint.has_axis and joint.axis is not None and norm(joint.axis.xyz) < 1e-6:
            yield defect(
                "zero-axis",
                f"axis of joint '{joint.name}' is zero; write a direction such as 0 0 1",
                joint.axis.element.attribute_place("xyz"),
                "joint",
                joint.name,
            )
        limit = joint.limit
        if joint.is_limited and limit is not None and (limit.lower or 0) > (limit.upper or 0):
            yield defect(
                "lower-above-upper",
                f"lower limit {limit.lower or 0:g} of joint '{joint.name}' is above its upper "
                f"limit {limit.upper or 0:g}",
                limit.place,
                "joint",
                joint.name,
            )
        yield from _mimic(robot, joint)


def _mimic(robot: Robot, joint: Joint) -> Iterator[Finding]:
    mimic = joint.mimic
    if mimic is None:
        return
    place = mimic.element.attribute_place("joint")
    if mimic.joint == joint.name:
        text = f"joint '{joint.name}' mimics itself"
        yield defect("mimic-cycle", text, place, "joint", joint.name)
    elif mimic.joint not in robot.joint:
        yield defect(
            "mimic-unknown-joint",
            f"joint '{joint.name}' mimics '{mimic.joint}', which does not exist",
            place,
            "joint",
            joint.name,
        )
    else:
        seen, leader = {joint.name}, robot.joint[mimic.joint]
        while leader.mimic is not None and leader.name not in seen:
            seen.add(leader.name)
            leader = robot.joint.get(leader.mimic.joint, joint)
        if leader.name == joint.name and leader.mimic is not None:
            yield defect(
                "mimic-cycle",
                f"joint '{joint.name}' mimics '{mimic.joint}', which in the end mimics it",
                place,
                "joint",
                joint.name,
            )


def _numbers(robot: Robot) -> Iterator[Finding]:
    for part in (*robot.links, *robot.joints, *robot.materials):
        for element in part.element.walk():
            for attribute, count in NUMBERS.get(element.tag, {}).items():
                text = element.get(attribute)
                if text is not None and (wanted := _wanted(element.tag, text, count)):
                    yield _not_a_number(element, attribute, text, wanted, part.element)


def _wanted(tag: str, text: str, count: int) -> str:
    """What should stand there instead; nothing where it is right."""
    values = numbers(text, count)
    if values is None:
        return "a finite number" if count == 1 else f"{count} finite numbers"
    if tag not in ("limit", "dynamics") and any(abs(value) > ENORMOUS for value in values):
        return f"below {ENORMOUS:g}, as all that a robot can have"
    return ""


def _not_a_number(
    element: Element, attribute: str, text: str, wanted: str, part: Element
) -> Finding:
    return defect(
        "not-a-number" if wanted.endswith(("number", "numbers")) else "immense-number",
        f'{attribute}="{text}" of <{element.tag}> in {part.tag} '
        f"'{part.get('name') or ''}' is not {wanted}",
        element.attribute_place(attribute),
        part.tag,
        part.get("name") or "",
    )
