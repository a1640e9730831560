"""Check names of links and joints, and the links that joints refer to."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from ...model.elements import Joint, Link, Robot
from ...source.description import Description
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
)
from ..gazebo.lumped_model import find_kept_links, find_sdf_joints, is_joint_kept, is_named_as_link
from ..gazebo.lumping import is_lumped
from ..renaming import rename_part
from ..rule import (
    ANY_FORMAT,
    BOTH,
    ERROR,
    GAZEBO,
    INFO,
    UNSAFE,
    WARNING,
    Problem,
    rule,
    select_holding,
)
from ..unexpanded import is_unexpanded
from ..words import find_nearest, quote, suggest_name
from ..xml.vocabulary_table import find_misspelled_children, is_for_another_reader


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio": "reject the robot",
        "mujoco, drake": "load a model without a body",
    },
    formats=ANY_FORMAT,
)
def no_links(robot: Robot, description: Description) -> Iterator[Problem]:
    """The robot has no link.

    urdfdom, and with it ROS and Gazebo, rejects a robot without links. A ``<robot>`` with a comment
    and neither name nor elements is ignored, as a placeholder that another file includes.
    """
    if not (robot.name.strip() or robot.element.children) and description.document.comments:
        return
    if not robot.links and "link" not in find_misspelled_children(robot.xml).values():
        yield _report_no_link(robot)


@no_links.full
def report_every_missing_link(robot: Robot) -> Iterator[Problem]:
    """Report a robot without links, also a placeholder or one whose links are misspelled."""
    if not robot.links:
        yield _report_no_link(robot)


def _report_no_link(robot: Robot) -> Problem:
    macros = robot.source is not None and robot.source.expansion is not None
    what = "use a file that calls its macros" if macros else 'add a <link name="…"/>'
    who = f"robot '{robot.name}'" if robot.name else "the robot"
    return Problem(robot, f"{who} has no link; {what}")


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot: link is not unique",
        "mujoco, pybullet, drake": "reject the file",
    },
    formats=ANY_FORMAT,
)
def duplicate_link_name(robot: Robot) -> Iterator[Problem]:
    """Two links have the same name.

    Joints refer to links by name, so readers reject the robot. Often a macro is called twice with
    the same prefix.
    """
    for link in robot.links:
        first = robot.link[link.name]
        if first is not link and link.name.strip():
            yield _report_second(link, first)


@duplicate_link_name.full
def report_every_second_link(robot: Robot) -> Iterator[Problem]:
    """Report each link after the first of its name, also if the name is blank or empty."""
    yield from _report_every_second(robot.links, robot.link)


def _report_every_second(
    parts: Sequence[Link] | Sequence[Joint], first: Mapping[str, Link] | Mapping[str, Joint]
) -> Iterator[Problem]:
    for part in parts:
        if first[part.name] is not part:
            problem = _report_second(part, first[part.name])
            problem.data = {"has_name": bool(part.name)}
            yield problem


def _report_second(part: Link | Joint, first: Link | Joint) -> Problem:
    kind = "link" if isinstance(part, Link) else "joint"
    named = "name" in part.element.attributes
    return Problem(
        part,
        f"{kind} name '{part.name}' is used twice (first in line {first.place.line}); rename one",
        at=part.locate_attribute("name") if named else None,
    )


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot: joint is not unique",
        "mujoco": "loads it",
        "pybullet": "crashes",
    },
    formats=ANY_FORMAT,
)
def duplicate_joint_name(robot: Robot) -> Iterator[Problem]:
    """Two joints have the same name.

    Joint states and commands refer to joints by name. urdfdom rejects the robot, PyBullet crashes.
    """
    for joint in robot.joints:
        first = robot.joint[joint.name]
        if first is not joint and joint.name.strip():
            yield _report_second(joint, first)


@duplicate_joint_name.full
def report_every_second_joint(robot: Robot) -> Iterator[Problem]:
    """Report each joint after the first of its name, also if the name is blank or empty."""
    yield from _report_every_second(robot.joints, robot.joint)


@duplicate_joint_name.fix(UNSAFE)
def number_joint_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Append a number to the second name."""
    joint = context.get_joint(problem)
    name = _find_free_name(joint.name, {*context.robot.joint, *context.robot.link})
    return unsafe(f"rename it to '{name}'", set_attribute(joint.element, "name", name))


def _find_free_name(name: str, taken: set[str]) -> str:
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"


_OTHERS_ACCEPT = "urdfdom, mujoco, pybullet, pinocchio, drake"
_CLASH = {
    "gz, gazebo-classic (both stay)": "reject the model: a name is not unique (sdformat 12.3)",
    "gz, gazebo-classic (one is lumped)": (
        "load the model, because a lumped link or joint leaves no name (sdformat 12.3)"
    ),
    _OTHERS_ACCEPT: "accept it",
}


@rule(
    INFO,
    on=GAZEBO,
    raised=dict.fromkeys(GAZEBO, ERROR),
    effects=_CLASH,
    group="robot",
)
def link_joint_name_clash(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A link and a joint have the same name.

    In SDF, links and joints share one namespace, so Gazebo rejects a model that other readers
    load. If a fixed joint is lumped with its link, sdformat 12.3 writes neither name, but versions
    that write frames for them (9.9 of series 9, and 13 or later) write both: then it is a warning.
    A ``<joint>`` of SDF in a ``<gazebo>`` block belongs to the same namespace.
    """
    in_gazebo = not targets.isdisjoint(GAZEBO)
    kept = find_kept_links(robot)
    for name, joint in robot.joint.items():
        if name in robot.link and name.strip():
            stay = kept is not None and is_named_as_link(robot, joint, kept)
            lumped = is_lumped(robot, name) or is_lumped(robot, joint.child)
            case = "both stay" if stay else "one is lumped" if kept and lumped else ""
            yield Problem(
                joint,
                f"joint '{name}' has the name of a link, but both share one namespace in SDF; "
                f"rename it to '{name}_joint'",
                at=joint.locate_attribute("name"),
                severity=WARNING if in_gazebo and lumped and not stay else None,
                effects=select_holding(_CLASH, case),
            )
    yield from _report_sdf_clashes(robot, kept or set())


def _report_sdf_clashes(robot: Robot, kept: set[str]) -> Iterator[Problem]:
    """Report SDF joints with the name of a link or joint that Gazebo has too."""
    names = dict.fromkeys((*kept, "world"), "a link")
    for joint in robot.joints:
        if is_joint_kept(robot, joint, kept):
            names.setdefault(joint.name, "a joint")
    for element in find_sdf_joints(robot):
        name = element.get("name") or ""
        if name in names:
            yield Problem(
                element,
                f"joint '{name}' in <gazebo> has the name of {names[name]}; write a unique name",
                at=element.locate_attribute("name"),
                effects=[
                    key for key in select_holding(_CLASH, "both stay") if key != _OTHERS_ACCEPT
                ],
                alike=names[name],
            )
        elif name:
            names[name] = "another joint in <gazebo>"


_WITHOUT_PARENT = {
    "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio": (
        "reject the robot: parent link not found"
    ),
    "drake (the parent is world)": "uses its own world, and loads the robot",
    "drake (the parent is not world)": "rejects the robot",
}


@link_joint_name_clash.fix(UNSAFE, renames=True)
def rename_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Append ``_joint`` to the name of a joint of URDF."""
    if not isinstance(problem.subject, Joint):
        return None
    joint = context.get_joint(problem)
    return rename_part(context, joint, f"{joint.name}_joint")


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
    that another robot includes gets ``world`` from there.
    """
    joint = context.get_joint(problem)
    if "included_by" in problem.data:
        return None
    if joint.parent != "world":
        return _write_suggestion(problem)
    check_not_included(context)
    made = prepend_child(context.robot.element, '<link name="world"/>')
    parent = joint.parent_element
    sure = parent is not None and is_always_there(parent) and not is_computed(parent, "link")
    known = any(_WORLD.search(file.data) for file in context.description.files)
    return (safe if sure and not known else unsafe)('add <link name="world"/>', made)


_WORLD = re.compile(rb"<link\b[^<>]*\bname\s*=\s*[\"']world[\"']")


def _write_suggestion(problem: Problem) -> Proposal | None:
    found = find_attribute(problem)
    name = get_suggestion(problem, found[0].get(found[1]) or "") if found is not None else ""
    if found is None or not name:
        return None
    return unsafe(f"write '{name}'", set_attribute(*found, name))


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
    """Write the suggested link, if it does not have a parent joint yet."""
    orphan: str = problem.data.get("orphan", "")
    found = find_attribute(problem)
    if orphan and found is not None:
        return unsafe(f"write '{orphan}'", set_attribute(*found, orphan))
    name = get_suggestion(problem, context.get_joint(problem).child)
    if any(joint.child == name for joint in context.robot.joints):
        return None
    return _write_suggestion(problem)


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
        elif element.attributes.keys() <= {"link"}:
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
