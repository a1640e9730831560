"""What a ``<gazebo>`` block refers to."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from ...model.elements import GazeboExtension, Robot
from ...source.document import Element
from ..fix import (
    FixContext,
    Proposal,
    escape_attribute,
    insert_after,
    is_computed,
    remove_element,
    set_attribute,
    suggestion_of,
    unsafe,
    written_lines,
)
from ..rule import ERROR, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import did_you_mean, nearest, quoted
from .kept import joints_of_sdf
from .keywords import JOINT_KEYWORDS, KEYWORDS, LINK_KEYWORDS
from .lumping import body_of, is_lumped, keeps_joint, remove_words

_OF_BLOCK = "gz, gazebo-classic"
_OF_JOINT = "gz, gazebo-classic (a joint of SDF)"

APPLIES_TO = ("gazebo",)


@rule(
    ERROR,
    effects={
        _OF_BLOCK: "ignore the whole block, without a message (sdformat 12.3)",
        _OF_JOINT: "reject the model: a link of the joint is not found (sdformat 12.3)",
    },
)
def dangling_reference(robot: Robot) -> Iterator[Problem]:
    """A ``<gazebo reference>`` names neither a link nor a joint.

    The block is thrown away without a word: the wheel has no grip, the camera does not exist, the
    joint is lumped. A misspelt name, a prefix that was forgotten, or a link that is no longer
    there. A ``<joint>`` of SDF that closes a loop needs links that are there as well; without them
    Gazebo loads no robot at all. sdformat 12.3 does not find one that a fixed joint lumps into
    another either.
    """
    yield from _loops(robot)
    names = {*robot.link, *robot.joint}
    stripped = {name.strip() for name in names}
    of_sdf = set(_names_of_sdf(robot, "link"))
    for block in robot.gazebo:
        name = block.reference
        if not name or name.strip() in stripped or is_unexpanded(name):
            continue
        if name in of_sdf:
            yield Problem(
                block.element,
                f"'{name}' is a link of SDF in a <gazebo> block, which no reference finds, so the "
                "block does nothing; write its settings in that link",
                at=block.element.attribute_place("reference"),
                data={"name": name},
            )
            continue
        known = [one for one in _meant_by(block, robot) if not _has_settings_of(block, one, robot)]
        yield Problem(
            block.element,
            f"'{name}' is neither a link nor a joint, so the block does nothing"
            + did_you_mean(name, known, _LIKE),
            at=block.element.attribute_place("reference"),
            data={"name": name, "suggestion": nearest(name, known, _LIKE)},
        )


_LIKE = 0.8
"""Least similarity of a name that is suggested: parts of one arm have similar names."""


@dangling_reference.fix(UNSAFE)
def write_reference(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested name of a link or joint."""
    name = suggestion_of(problem, problem.element.get("reference") or "")
    if not name:
        return None
    return unsafe(f"write '{name}'", set_attribute(problem.element, "reference", name))


def _meant_by(block: GazeboExtension, robot: Robot) -> Collection[str]:
    """Name what a block may refer to: joints for settings of joints, links for those of links."""
    tags = {child.tag for child in block.element.children}
    of_joint = not tags.isdisjoint(JOINT_KEYWORDS)
    of_link = not tags.isdisjoint(LINK_KEYWORDS | {"sensor"})
    if of_joint == of_link:
        return {*robot.link, *robot.joint}
    return robot.joint if of_joint else robot.link


def _has_settings_of(block: GazeboExtension, name: str, robot: Robot) -> bool:
    """Tell whether a link or joint has a setting of a block in a block of its own."""
    tags = {child.tag for child in block.element.children}
    return any(
        child.tag in tags and child.tag in KEYWORDS
        for other in robot.extensions.get(name, ())
        for child in other.element.children
    )


def _names_of_sdf(robot: Robot, *tags: str) -> Iterator[str]:
    """List the names of elements of SDF in blocks of a robot."""
    for block in robot.gazebo:
        for element in block.element.walk():
            if element.tag in tags:
                yield element.get("name") or ""


def _loops(robot: Robot) -> Iterator[Problem]:
    of_sdf = {*_names_of_sdf(robot, "link", "frame")}
    for joint in joints_of_sdf(robot):
        for end in (joint.child("parent"), joint.child("child")):
            name = end.text.strip() if end is not None else ""
            if end is None or not name or name in {"world", *of_sdf}:
                continue
            if "::" in name or is_unexpanded(name):
                continue
            lumped = name in robot.link and is_lumped(robot, name)
            if name in robot.link and not lumped:
                continue
            what = f"<{end.tag}> of joint '{joint.get('name') or ''}' is '{name}', which is "
            if lumped:
                what += f"lumped into '{body_of(robot, name)}', because its joint is fixed; name "
                what += "that, or keep the joint by preserveFixedJoint"
            else:
                what += f"no link{did_you_mean(name, robot.link)}"
            yield Problem(
                _block_of(joint),
                what,
                at=end,
                data={"name": name} | ({"body": body_of(robot, name)} if lumped else {}),
                severity=WARNING if lumped else None,
                effects=(_OF_JOINT,),
            )


def _block_of(joint: Element) -> Element:
    return joint if joint.parent is None else joint.parent


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "drop it, without a message (sdformat 12.3)",
    },
    group="robot",
)
def misplaced_extension(robot: Robot) -> Iterator[Problem]:
    """A word of Gazebo's stands at a link and belongs to a joint, or the other way round.

    Friction, contact, colour and gravity belong to links; springs, stops, feedback and
    ``preserveFixedJoint`` to joints. At the other kind, or in a block without a reference, they
    are dropped: a fixed joint preserved at its link is lumped all the same. So is a sensor that no
    reference is on a link. Where the joint is fixed and lumped, Gazebo has no joint that the
    word could be written at, and the remedy is to remove it.
    """
    for block in robot.gazebo:
        name = block.reference or ""
        if name in robot.link and name in robot.joint:
            continue
        if not name:
            wrong = LINK_KEYWORDS | JOINT_KEYWORDS | {"sensor"}
            belongs = "in a block without a reference"
        elif name in robot.link:
            wrong, belongs = JOINT_KEYWORDS, f"at link '{name}'"
        elif name in robot.joint:
            wrong, belongs = LINK_KEYWORDS, f"at joint '{name}'"
        else:
            continue
        children = [child for child in block.element.children if child.tag in wrong]
        if children:
            yield _misplaced(robot, block, children, belongs)


def _misplaced(
    robot: Robot, block: GazeboExtension, children: list[Element], belongs: str
) -> Problem:
    tags = quoted(dict.fromkeys(child.tag for child in children)).replace("'", "")
    name = block.reference or ""
    right = "a link" if children[0].tag in LINK_KEYWORDS | {"sensor"} else "a joint"
    if name in robot.joint and robot.joint[name].child:
        right = f"link '{robot.joint[name].child}'"
    elif name in robot.link:
        joint = robot.tree.parent_joint(name)
        right = f"joint '{joint.name}'" if joint is not None else right
    verb = "does" if len(children) == 1 else "do"
    remedy, change = f"write it at {right}", "move"
    if name in robot.link and is_lumped(robot, name) and not any(map(keeps_joint, children)):
        remedy = f"remove {'it' if len(children) == 1 else 'them'}, because {right} is fixed"
        remedy, change = f"{remedy} and lumped", "remove a lumped one"
    elif name and _is_repeated(robot, block.element, children):
        remedy = f"remove {'it' if len(children) == 1 else 'them'}, because {right} has its own"
        change = "remove a repeated one"
    return Problem(
        block.element,
        f"{tags} {verb} nothing {belongs}; {remedy}",
        at=children[0],
        alike=(*(child.tag for child in children), name in robot.link, name in robot.joint, change),
        data={"elements": list(dict.fromkeys(child.tag for child in children))},
    )


def _is_repeated(robot: Robot, block: Element, children: list[Element]) -> bool:
    """Tell whether the joint or link that misplaced words are about has all of them already."""
    name = block.get("reference") or ""
    if name in robot.joint:
        other = robot.joint[name].child
    else:
        joint = robot.tree.parent_joint(name)
        other = joint.name if joint is not None else ""
    blocks = robot.extensions.get(other, ()) if other else ()
    there = {child.tag for one in blocks for child in one.element.children}
    return there.difference(("collision", "visual")).issuperset(child.tag for child in children)


@misplaced_extension.fix(UNSAFE)
def move_extension(problem: Problem, context: FixContext) -> Proposal | None:
    """Move the words to the joint or link they are about.

    Where that is lumped or has them already, they are removed.
    """
    block, name = problem.element, problem.element.get("reference") or ""
    robot = context.robot
    if name in robot.link:
        joint = robot.tree.parent_joint(name)
        if joint is None or is_computed(joint.element):
            return None
        right, wrong = joint.name, JOINT_KEYWORDS
        children = [child for child in block.children if child.tag in wrong]
        if children and is_lumped(robot, name) and not any(map(keeps_joint, children)):
            return remove_words(block, JOINT_KEYWORDS)
    elif name in robot.joint:
        right, wrong = robot.joint[name].child, LINK_KEYWORDS
        if right not in robot.link or is_computed(robot.link[right].element):
            return None
    else:
        return None
    moved = [child for child in block.children if child.tag in wrong]
    if not right or not moved:
        return None
    if _is_repeated(robot, block, moved):
        return remove_words(block, wrong)
    if len(moved) == len(block.children):
        return unsafe(f"write it at '{right}'", set_attribute(block, "reference", right))
    lines = (
        f'<gazebo reference="{escape_attribute(right)}">',
        *(f"\t{line}" for child in moved for line in written_lines(child)),
        "</gazebo>",
    )
    return unsafe(
        f"write it at '{right}'", *map(remove_element, moved), insert_after(block, *lines)
    )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic": "warn, and take the last one",
    },
)
def conflicting_references(robot: Robot) -> Iterator[Problem]:
    """Two blocks of one link or joint say different things.

    Usually two included files each have a block for it. The one that is read last wins, and the
    order of includes decides how the wheel grips.
    """
    for name, blocks in robot.extensions.items():
        said: dict[str, str] = {}
        for block in blocks:
            for child in block.element.children:
                if child.tag not in KEYWORDS or child.tag in ("collision", "visual"):
                    continue
                value = (child.get("value") or child.text).strip()
                other = said.setdefault(child.tag, value)
                if other != value:
                    said[child.tag] = value
                    of = f" of '{name}'" if name else ""
                    yield Problem(
                        block.element,
                        f"{child.tag}{of} is {other} further up and {value} here; keep one",
                        at=child,
                        data={"element": child.tag, "values": [other, value]},
                    )
