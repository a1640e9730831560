"""Rules on names and references."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.references import list_blocks
from ...source.document import Element
from ..fix import OUTER_BLANKS, FixContext, Proposal, find_attribute, safe, substitute, unsafe
from ..rule import BOTH, ERROR, Problem, rule, select_holding

_PADDED = {
    "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake (a link of a joint)": (
        "reject the robot: link not found"
    ),
    "drake (a joint of a mimic)": "rejects the robot: joint not found",
    "gz, gazebo-classic (a block)": "drop it: its reference is not found",
}


@rule(
    ERROR,
    effects=_PADDED,
)
def padded_reference(robot: Robot) -> Iterator[Problem]:
    """A name or a reference has a space at its start or end.

    Readers compare names exactly, so ``"base "`` is not ``base``: a joint does not find its link,
    and readers reject the robot. If a mimic does not find its joint, only Drake does.
    """
    references: list[tuple[Element, str]] = []
    for joint in robot.joints:
        if joint.parent_element is not None:
            references.append((joint.parent_element, "link"))
        if joint.child_element is not None:
            references.append((joint.child_element, "link"))
        if joint.mimic is not None:
            references.append((joint.mimic.element, "joint"))
    references += [(element, "reference") for _, element in list_blocks(robot)]
    names = {*robot.link, *robot.joint}
    used = {element.get(attribute): _get_case(element) for element, attribute in references}
    for element, attribute in references:
        text = element.attributes.get(attribute)
        if text and text not in names and text.strip() in names:
            yield _report_padded(element, attribute, text, _get_case(element))
    for element in (part.element for parts in (robot.links, robot.joints) for part in parts):
        name = element.attributes.get("name", "")
        if name not in used and name != name.strip() and name.strip() in used:
            yield _report_padded(element, "name", name, used[name.strip()])


def _get_case(element: Element) -> str:
    """Get the condition of effects for an element with a reference."""
    cases = {"parent": "a link of a joint", "child": "a link of a joint", "gazebo": "a block"}
    return cases.get(element.tag, "a joint of a mimic")


def _report_padded(element: Element, attribute: str, text: str, case: str) -> Problem:
    return Problem(
        element,
        f"{attribute} of <{element.tag}> is '{text}', with a space at its start or end; "
        f"write '{text.strip()}'",
        at=element.locate_attribute(attribute),
        effects=select_holding(_PADDED, case),
    )


@padded_reference.fix(BOTH, reveals=True)
def remove_blank(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the space.

    The fix is safe for the parent and child of a joint, because every reader rejects the robot
    without it. It is unsafe for a mimic joint or a ``<gazebo>`` block, which readers ignore before
    the fix.
    """
    found = find_attribute(problem)
    if found is None:
        return None
    element, name = found
    ends = {end for joint in context.robot.joints for end in (joint.parent, joint.child)}
    joins = element.tag in ("parent", "child")
    joins = joins or (element.tag == "link" and (element.get(name) or "").strip() in ends)
    make = safe if joins else unsafe
    return make("remove the space", substitute(element, name, OUTER_BLANKS, ""))
