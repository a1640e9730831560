"""Check the parent and child links of joints."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from ...model.elements import Joint, Robot
from ...source.document import Element
from ..cross_file_references import check_not_included, find_including_file
from ..fix import (
    FixContext,
    Proposal,
    find_attribute,
    get_suggestion,
    is_always_there,
    is_computed,
    prepend_child,
    safe,
    set_attribute,
    unsafe,
    write_suggestion,
)
from ..rule import ANY_FORMAT, BOTH, ERROR, INFO, UNSAFE, Problem, rule, select_holding
from ..unexpanded import is_unexpanded
from ..words import find_nearest, quote, suggest_name
from ..xml.vocabulary_table import find_misspelled_children, is_for_another_reader

_WITHOUT_PARENT = {
    "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio": (
        "reject the robot: parent link not found"
    ),
    "drake (the parent is world)": "uses its own world, and loads the robot",
    "drake (the parent is not world)": "rejects the robot",
}


@rule(ERROR, effects=_WITHOUT_PARENT, formats=ANY_FORMAT)
def unknown_parent_link(robot: Robot) -> Iterator[Problem]:
    """A joint's parent is not a link of the robot.

    Readers reject the robot. ``world`` must be declared like any other link; only Drake has a world
    of its own, so it is an info in files with Drake's elements. All such joints of a file that
    another file includes are one info, because the parents may come from there.
    """
    stripped = {name.strip() for name in robot.link}
    found = []
    for joint in robot.joints:
        name = joint.parent
        if name in robot.link or name.strip() in stripped or is_unexpanded(name):
            continue
        if name.strip() and joint.parent_element is not None:
            found.append((joint, joint.parent_element))
    user = _find_including_file(robot) if found else ""
    if user:
        yield _report_part(found, user)
        return
    for joint, parent in found:
        yield _report_unknown_parent(robot, joint, parent)


def _find_including_file(robot: Robot) -> str:
    """Find a file that includes an expanded one; empty if none does."""
    source = robot.source
    return find_including_file(source) if source is not None and source.expansion else ""


def _report_part(found: list[tuple[Joint, Element]], user: str) -> Problem:
    """Report the joints of a file that is a part of another robot."""
    (joint, parent), others = found[0], len(found) - 1
    names = list(dict.fromkeys(one.parent for one, _ in found))
    more = f" and of {others} more joint{'s' if others > 1 else ''}" if others else ""
    are = f"parents {quote(names, 3)}" if len(names) > 1 else f"parent '{names[0]}'"
    verb = "are not links" if len(names) > 1 else "is not a link"
    return Problem(
        joint,
        f"{are} of joint '{joint.name}'{more} {verb} of this file; {user} includes it: check that",
        at=parent.locate_attribute("link"),
        severity=INFO,
        effects=[],
        data={"parents": names, "included_by": user},
    )


@unknown_parent_link.full
def report_every_unknown_parent(robot: Robot) -> Iterator[Problem]:
    """Report each parent name that is not a link, also unexpanded or with spaces around it."""
    for joint in robot.joints:
        if joint.parent and joint.parent not in robot.link and joint.parent_element is not None:
            yield _report_unknown_parent(robot, joint, joint.parent_element)


def _report_unknown_parent(robot: Robot, joint: Joint, parent: Element) -> Problem:
    name = joint.parent
    below = {joint.child, *robot.tree.list_descendants(joint.child)}
    possible = [link for link in robot.link if link not in below]
    is_world = name == "world"
    return Problem(
        joint,
        f"parent '{name}' of joint '{joint.name}' is not a link"
        f"{_describe_remedy(name, robot, possible)}",
        at=parent.locate_attribute("link"),
        data={"suggestion": find_nearest(name, possible)},
        severity=INFO if is_world and is_for_another_reader(robot.xml) else None,
        effects=select_holding(
            _WITHOUT_PARENT, "the parent is world" if is_world else "the parent is not world"
        ),
    )


@unknown_parent_link.fix(BOTH, reveals=True)
def fix_parent(problem: Problem, context: FixContext) -> Proposal | None:
    """Declare ``world``; for another name write the suggested link.

    ``world`` is declared only in a description that is a complete robot for all arguments. A part
    that another robot includes gets ``world`` from there. If two links have one name, one of them
    may be the missing link, so that no other is written.
    """
    joint = context.get_joint(problem)
    if "included_by" in problem.data:
        return None
    if joint.parent != "world":
        return None if _has_repeated_link(context) else write_suggestion(problem)
    check_not_included(context)
    made = prepend_child(context.robot.element, '<link name="world"/>')
    parent = joint.parent_element
    sure = parent is not None and is_always_there(parent) and not is_computed(parent, "link")
    known = any(_WORLD.search(file.data) for file in context.description.files)
    return (safe if sure and not known else unsafe)('add <link name="world"/>', made)


def _has_repeated_link(context: FixContext) -> bool:
    """Tell whether two links have one name."""
    links = context.robot.links
    return len({link.name for link in links}) < len(links)


_WORLD = re.compile(rb"<link\b[^<>]*\bname\s*=\s*[\"']world[\"']")


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "reject the robot: child link not found"
        ),
    },
    formats=ANY_FORMAT,
)
def unknown_child_link(robot: Robot) -> Iterator[Problem]:
    """A joint's child is not a link of the robot.

    Readers reject the robot. A link without a parent joint, which is not above this joint, is
    probably the intended child.
    """
    stripped = {name.strip() for name in robot.link}
    missing = [
        joint
        for joint in robot.joints
        if joint.child.strip()
        and joint.child_element is not None
        and joint.child not in robot.link
        and joint.child.strip() not in stripped
        and not is_unexpanded(joint.child)
    ]
    for joint in missing:
        if joint.child_element is not None:
            yield _report_unknown_child(robot, joint, joint.child_element, len(missing) == 1)


@unknown_child_link.full
def report_every_unknown_child(robot: Robot) -> Iterator[Problem]:
    """Report each child name that is not a link, also unexpanded or with spaces around it."""
    missing = [joint for joint in robot.joints if joint.child and joint.child not in robot.link]
    for joint in missing:
        if joint.child_element is not None:
            yield _report_unknown_child(robot, joint, joint.child_element, len(missing) == 1)


def _report_unknown_child(robot: Robot, joint: Joint, child: Element, alone: bool) -> Problem:
    name, orphans = joint.child, _find_orphans(robot, joint)
    meant = orphans[0] if alone and len(orphans) == 1 else find_nearest(name, orphans, 0.6)
    right = _describe_remedy(name, robot, robot.link)
    if meant:
        right = f"; did you mean '{meant}', which has no parent joint?"
    return Problem(
        joint,
        f"child '{name}' of joint '{joint.name}' is not a link{right}",
        at=child.locate_attribute("link"),
        data={"suggestion": find_nearest(name, robot.link), "orphan": meant},
    )


def _find_orphans(robot: Robot, joint: Joint) -> list[str]:
    """List the links without a parent joint that are not above a joint."""
    above = {joint.parent, *robot.tree.list_ancestors(joint.parent)}
    return [link.name for link in robot.tree.roots if link.name not in above]


def _describe_remedy(name: str, robot: Robot, possible: Iterable[str]) -> str:
    if name == "world":
        return '; add <link name="world"/>'
    remedy = f'; add <link name="{name}"/>'
    if robot.source is not None and robot.source.expansion is not None:
        remedy += ", or check the file that includes this one"
    return suggest_name(name, possible) or remedy


@unknown_child_link.fix(UNSAFE, reveals=True)
def fix_child(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested link, if it has no parent joint yet, and no two links have one name."""
    orphan: str = problem.data.get("orphan", "")
    found = find_attribute(problem)
    if _has_repeated_link(context):
        return None
    if orphan and found is not None:
        return unsafe(f"write '{orphan}'", set_attribute(*found, orphan))
    name = get_suggestion(problem, context.get_joint(problem).child)
    if any(joint.child == name for joint in context.robot.joints):
        return None
    return write_suggestion(problem)


_READERS = "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake"


@rule(ERROR, effects={_READERS: "reject the robot"}, formats=ANY_FORMAT)
def missing_parent_or_child(robot: Robot) -> Iterator[Problem]:
    """A joint lacks its parent or child link.

    A joint needs ``<parent link="…"/>`` and ``<child link="…"/>``; otherwise readers reject the
    robot.
    """
    for joint in robot.joints:
        missing = list(_find_missing_ends(joint))
        if not missing:
            continue
        if len(missing) == 2:
            yield Problem(
                joint,
                f"joint '{joint.name}' has neither <parent> nor <child>; "
                'add <parent link="…"/> and <child link="…"/>',
            )
        else:
            yield _report_missing_end(joint, *missing[0])


@missing_parent_or_child.full
def report_every_missing_end(robot: Robot) -> Iterator[Problem]:
    """Report each end of a joint without a link name, even if its element is misspelled."""
    for joint in robot.joints:
        if not joint.parent:
            yield _report_missing_end(joint, "parent", joint.parent_element)
        if not joint.child:
            yield _report_missing_end(joint, "child", joint.child_element)


def _report_missing_end(joint: Joint, tag: str, element: Element | None) -> Problem:
    what = f"no <{tag}>" if element is None else f"a <{tag}> without a link"
    return Problem(
        joint,
        f"joint '{joint.name}' has {what}; add <{tag} link=\"…\"/>",
        at=element,
        data={"end": tag},
    )


def _find_missing_ends(joint: Joint) -> Iterator[tuple[str, Element | None]]:
    ends = (
        ("parent", joint.parent, joint.parent_element),
        ("child", joint.child, joint.child_element),
    )
    for tag, name, element in ends:
        if name.strip():
            continue
        if element is None:
            if tag not in find_misspelled_children(joint.xml).values():
                yield tag, None
        elif all(key == "link" or ":" in key for key in element.attributes):
            yield tag, element


_TO_ITSELF = {
    "mujoco, drake": "reject the file",
    "urdfdom, gz, gazebo-classic, pinocchio (it has no other parent)": (
        "load the robot without the link and its descendants; check_urdf reports success"
    ),
    "pybullet (it has no other parent)": (
        "loads the robot without the link and its descendants, or crashes"
    ),
    "urdfdom, gz, gazebo-classic, pybullet, pinocchio (no root is left)": (
        "reject the robot: no root link found"
    ),
    "gz, gazebo-classic, pybullet, pinocchio (it has another parent)": "crash",
}


@rule(ERROR, effects=_TO_ITSELF, formats=ANY_FORMAT)
def joint_to_itself(robot: Robot) -> Iterator[Problem]:
    """A joint connects a link to itself.

    Parent and child are the same link, which the root then does not reach. Without another root,
    readers reject the robot. If the link is also the child of a second joint, readers recurse
    until they crash.
    """
    for joint in robot.joints:
        if joint.parent and joint.parent == joint.child and joint.child_element is not None:
            yield Problem(
                joint,
                f"parent and child of joint '{joint.name}' are both link '{joint.child}'; write "
                "two different links",
                at=joint.child_element.locate_attribute("link"),
                effects=select_holding(_TO_ITSELF, _select_case(joint, robot)),
            )


def _select_case(to_itself: Joint, robot: Robot) -> str:
    """Select the case of the effects for a joint from a link to itself; empty if unknown."""
    children = {joint.child for joint in robot.joints}
    roots = sum(name not in children for name in robot.link)
    if any(joint.child == to_itself.child for joint in robot.joints if joint is not to_itself):
        return "it has another parent" if roots == 1 else ""
    return "no root is left" if roots == 0 else "it has no other parent" if roots == 1 else ""
