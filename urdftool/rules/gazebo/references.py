"""Rules on the references of ``<gazebo>`` blocks."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from ...diagnostic import Severity
from ...model.block_elements import list_part_elements
from ...model.elements import GazeboExtension, Robot
from ...model.numbers import describe_content
from ...model.remarks import describe_dangling, describe_repeated, list_repeated_settings
from ...model.settings import Value, get_text
from ...source.document import Element
from ...source.location import Place
from ..fix import (
    FixContext,
    Proposal,
    escape_attribute,
    get_suggestion,
    get_written_lines,
    insert_after,
    is_computed,
    remove_element,
    set_attribute,
    unsafe,
)
from ..rule import ERROR, INFO, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import find_nearest, quote, suggest_name
from .keywords import JOINT_KEYWORDS, KEYWORDS, LINK_KEYWORDS
from .lumped_model import find_sdf_joints
from .lumping import get_lumped_body, is_lumped, is_preserving, remove_words

_OF_BLOCK = "gz, gazebo-classic"
_OF_JOINT = "gz, gazebo-classic (a joint of SDF)"

APPLIES_TO = ("gazebo",)


@rule(
    ERROR,
    effects={
        _OF_BLOCK: "ignore the whole block, without a message (sdformat 12.3)",
        _OF_JOINT: "reject the model: a link is not found, or is both ends (sdformat 12.3)",
    },
)
def dangling_reference(robot: Robot) -> Iterator[Problem]:
    """A ``<gazebo reference>`` is neither a link nor a joint.

    Gazebo ignores the whole block without a message: friction is not set, a camera does not exist,
    a joint is lumped. The name may be misspelled or lack a prefix, or the link was removed. An SDF
    ``<joint>`` that closes a loop also requires existing links; without them Gazebo rejects the
    model, and sdformat 12.3 does not find a link that it lumps. It is a warning if neither a sensor
    nor a plugin is lost, and an info if only looks or settings of a joint are, and no name is
    similar.
    """
    yield from _check_loops(robot)
    names = {*robot.link, *robot.joint}
    stripped = {name.strip() for name in names}
    of_sdf = set(_get_sdf_names(robot, "link"))
    compared = 0
    for block in robot.gazebo:
        name = block.reference
        if not name or name.strip() in stripped or is_unexpanded(name):
            continue
        if name in of_sdf:
            yield Problem(
                block.element,
                f"reference '{name}' is an SDF link in a <gazebo> block, so Gazebo ignores this "
                "block; write its settings in that link",
                at=block.locate_attribute("reference"),
                data={"name": name},
            )
            continue
        candidates = _get_candidates(block, robot)
        compared += len(candidates)
        if compared > _MOST_COMPARISONS:
            candidates = ()
        known = [one for one in candidates if not _has_settings_of(block, one, robot)]
        suggestion = find_nearest(name, known, _MIN_SIMILARITY)
        yield Problem(
            block.element,
            describe_dangling(robot, name) + suggest_name(name, known, _MIN_SIMILARITY),
            at=block.locate_attribute("reference"),
            severity=_choose_severity(block, bool(suggestion)),
            data={"name": name, "suggestion": suggestion},
        )


def _choose_severity(block: GazeboExtension, is_misspelled: bool) -> Severity:
    """Choose the severity by what Gazebo loses: sensors and plugins, settings, or leftovers.

    Looks, and springs of a joint that was removed, are lost without harm, unless a name is similar.
    """
    tags = {child.tag for child in block.element.children}
    if tags & {"sensor", "plugin", "link", "joint"}:
        return ERROR
    is_leftover = tags <= {"material", "visual"} or tags <= JOINT_KEYWORDS
    return INFO if is_leftover and not is_misspelled else WARNING


_MOST_COMPARISONS = 50_000
"""Comparisons of references with names of links and joints, of about 20 µs; chosen. Later ones get
no suggestion."""

_MIN_SIMILARITY = 0.8
"""Minimum similarity of a suggested name; high, because parts of an arm have similar names."""


@dangling_reference.fix(UNSAFE, reveals=True)
def write_reference(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested name of a link or joint."""
    name = get_suggestion(problem, problem.element.get("reference") or "")
    if not name:
        return None
    return unsafe(f"write '{name}'", set_attribute(problem.element, "reference", name))


def _get_candidates(block: GazeboExtension, robot: Robot) -> Collection[str]:
    """Get the possible names of a reference: joints for settings of joints, links for others."""
    tags = {child.tag for child in block.element.children}
    of_joint = not tags.isdisjoint(JOINT_KEYWORDS)
    of_link = not tags.isdisjoint(LINK_KEYWORDS | {"sensor"})
    if of_joint == of_link:
        return {*robot.link, *robot.joint}
    return robot.joint if of_joint else robot.link


def _has_settings_of(block: GazeboExtension, name: str, robot: Robot) -> bool:
    """Tell whether a block of a link or joint already has a setting of this block."""
    tags = {child.tag for child in block.element.children}
    return any(
        child.tag in tags and child.tag in KEYWORDS
        for other in robot.extensions.get(name, ())
        for child in other.element.children
    )


def _get_sdf_names(robot: Robot, *tags: str) -> Iterator[str]:
    """Yield the names of SDF elements with certain tags in the blocks of a robot."""
    for block in robot.gazebo:
        for element in block.element.walk():
            if element.tag in tags:
                yield element.get("name") or ""


def _check_loops(robot: Robot) -> Iterator[Problem]:
    of_sdf = {*_get_sdf_names(robot, "link", "frame")}
    reported: set[Place] = set()
    for joint in find_sdf_joints(robot):
        for end in (joint.find_child("parent"), joint.find_child("child")):
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
                what += (
                    f"lumped into '{get_lumped_body(robot, name)}', because its joint is fixed; "
                )
                what += "write that, or add preserveFixedJoint to the joint"
            else:
                what += f"not a link{suggest_name(name, robot.link)}"
            reported.add(end.place)
            yield Problem(
                _get_block(joint),
                what,
                at=end,
                data={"name": name} | ({"body": get_lumped_body(robot, name)} if lumped else {}),
                severity=WARNING if lumped else None,
                effects=(_OF_JOINT,),
            )

    for one in robot.rejected_settings:
        is_end = one.tag in ("parent", "child")
        known = {} if is_end else {*robot.joint, *of_sdf}
        if one.code != "dangling-reference" or one.text in known or "::" in one.text:
            continue
        if one.place not in reported and (one.text in robot.link) is is_end:
            text = f"{one.fact}, so Gazebo rejects the model"
            yield Problem(one.element, text, data={"name": one.text}, effects=(_OF_JOINT,))


def _get_block(joint: Element) -> Element:
    return joint if joint.parent is None else joint.parent


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic": "drop it, without a message (sdformat 12.3)",
    },
    group="robot",
)
def misplaced_extension(robot: Robot) -> Iterator[Problem]:
    """A keyword for links is in a block of a joint, or the reverse.

    Friction, contact, color and gravity are settings of links; springs, stops, feedback and
    ``preserveFixedJoint`` are settings of joints. In a block of the other kind, or without a
    reference, Gazebo drops them: ``preserveFixedJoint`` of a link does not preserve its joint. A
    sensor without a reference to a link is dropped too. If the joint is fixed and lumped, or
    already has the keyword, it should be removed: then the finding is an info.
    """
    for block in robot.gazebo:
        name = block.reference or ""
        if name in robot.link and name in robot.joint:
            continue
        if not name:
            wrong = LINK_KEYWORDS | JOINT_KEYWORDS | {"sensor"}
            where = "in a block without a reference"
        elif name in robot.link:
            wrong, where = JOINT_KEYWORDS, f"in a block of link '{name}'"
        elif name in robot.joint:
            wrong, where = LINK_KEYWORDS, f"in a block of joint '{name}'"
        else:
            continue
        children = [child for child in block.element.children if child.tag in wrong]
        if children:
            yield _report_misplaced(robot, block, children, where)


def _report_misplaced(
    robot: Robot, block: GazeboExtension, children: list[Element], where: str
) -> Problem:
    tags = quote(dict.fromkeys(child.tag for child in children)).replace("'", "")
    name = block.reference or ""
    right = "a link" if children[0].tag in LINK_KEYWORDS | {"sensor"} else "a joint"
    if name in robot.joint and robot.joint[name].child:
        right = f"link '{robot.joint[name].child}'"
    elif name in robot.link:
        joint = robot.tree.get_parent_joint(name)
        right = f"joint '{joint.name}'" if joint is not None else right
    verb = "has" if len(children) == 1 else "have"
    remedy, change = f"write it for {right}", "move"
    if name in robot.link and is_lumped(robot, name) and not any(map(is_preserving, children)):
        remedy = f"remove {'it' if len(children) == 1 else 'them'}, because {right} is fixed"
        remedy, change = f"{remedy} and lumped", "remove a lumped one"
    elif name and _is_repeated(robot, block.element, children):
        remedy = (
            f"remove {'it' if len(children) == 1 else 'them'}, because {right} already has its own"
        )
        change = "remove a repeated one"
    return Problem(
        block.element,
        f"{tags} {verb} no effect {where}; {remedy}",
        at=children[0],
        severity=WARNING if change == "move" else INFO,
        alike=(*(child.tag for child in children), name in robot.link, name in robot.joint, change),
        data={"elements": list(dict.fromkeys(child.tag for child in children))},
    )


def _is_repeated(robot: Robot, block: Element, children: list[Element]) -> bool:
    """Tell whether the joint or link of misplaced keywords already has all of them."""
    name = block.get("reference") or ""
    if name in robot.joint:
        other = robot.joint[name].child
    else:
        joint = robot.tree.get_parent_joint(name)
        other = joint.name if joint is not None else ""
    blocks = robot.extensions.get(other, ()) if other else ()
    there = {child.tag for one in blocks for child in one.element.children}
    return there.difference(("collision", "visual")).issuperset(child.tag for child in children)


@misplaced_extension.fix(UNSAFE, reveals=True)
def move_extension(problem: Problem, context: FixContext) -> Proposal | None:
    """Move the keywords to their joint or link.

    They are removed if the joint is lumped, or if its block already has them.
    """
    block, name = problem.element, problem.element.get("reference") or ""
    robot = context.robot
    if name in robot.link:
        joint = robot.tree.get_parent_joint(name)
        if joint is None or is_computed(joint.element):
            return None
        right, wrong = joint.name, JOINT_KEYWORDS
        children = [child for child in block.children if child.tag in wrong]
        if children and is_lumped(robot, name) and not any(map(is_preserving, children)):
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
        return unsafe(f"write it for '{right}'", set_attribute(block, "reference", right))
    lines = (
        f'<gazebo reference="{escape_attribute(right)}">',
        *(f"\t{line}" for child in moved for line in get_written_lines(child)),
        "</gazebo>",
    )
    return unsafe(
        f"write it for '{right}'", *map(remove_element, moved), insert_after(block, *lines)
    )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic": "warn, and take the last one",
    },
)
def conflicting_references(robot: Robot) -> Iterator[Problem]:
    """Two blocks of a link or joint have different values of a setting.

    This happens if two included files have a block for the same link. Gazebo uses the last value,
    so the order of includes decides.
    """
    for part, value in list_repeated_settings(robot):
        yield _report_repeated(part, value)
    for link in robot.links:
        names = [e for e in list_part_elements(robot, link) if e.tag == "material"]
        values = [Value(e, get_text(e)) for e in names if not e.children]
        if len({value.content for value in values}) > 1:
            last = values[-1]
            yield _report_repeated(
                ("link", link.name), Value(last.provenance, last.content, tuple(values[:-1]))
            )


def _report_repeated(part: tuple[str, str], value: Value) -> Problem:
    contents = [describe_content(one.written) for one in (*value.earlier, value)]
    return Problem(
        value.element,
        f"{describe_repeated(part, value)}; keep one",
        at=value.element,
        data={"element": value.tag, "values": contents},
    )
