"""Rules on settings that are lost when Gazebo lumps fixed joints."""

from __future__ import annotations

from collections.abc import Iterator

from ...diagnostic import Severity
from ...model.block_elements import LUMPED, is_set_by_block, make_taking_name
from ...model.elements import Collision, GazeboExtension, Link, Robot, Visual
from ...model.remarks import describe_unset, list_unset_collisions
from ...model.settings import LUMPING_TAGS, SURFACE_TAGS, get_text, is_set, is_true
from ...source.document import Element
from ..fix import (
    FixContext,
    Proposal,
    append_child,
    find_attribute,
    find_element,
    remove_element,
    set_attribute,
    set_text,
    unsafe,
)
from ..rule import ERROR, GAZEBO, INFO, UNSAFE, WARNING, Problem, rule
from ..words import quote
from .keywords import JOINT_KEYWORDS

APPLIES_TO = ("gazebo",)


def is_preserving(element: Element) -> bool:
    """Tell whether an element in a block of a joint preserves a fixed joint."""
    return element.tag in LUMPING_TAGS and is_true(get_text(element))


def is_lumped(robot: Robot, link: str) -> bool:
    """Tell whether Gazebo lumps a link into its parent."""
    joint = robot.tree.get_parent_joint(link)
    return (
        joint is not None
        and joint.is_fixed
        and joint.parent in robot.link
        and joint.parent != "world"
        and not joint.is_preserved
    )


def get_lumped_body(robot: Robot, link: str) -> str:
    """Get the link into which a link is lumped, or the link itself."""
    known: dict[str, str] = robot.memo.get(get_lumped_body, dict)
    if link not in known:
        known[link] = _find_lumped_body(robot, link)
    return known[link]


def _find_lumped_body(robot: Robot, link: str) -> str:
    seen = set()
    while is_lumped(robot, link) and link not in seen:
        seen.add(link)
        joint = robot.tree.get_parent_joint(link)
        assert joint is not None
        link = joint.parent
    return link


def remove_words(block: Element, words: frozenset[str]) -> Proposal:
    """Remove children of a ``<gazebo>`` by their tags, or the block if it has no others."""
    gone = [child for child in block.children if child.tag in words]
    if len(gone) == len(block.children):
        return unsafe("remove the block", remove_element(block))
    return unsafe("remove it", *map(remove_element, gone))


def _iterate_link_blocks(robot: Robot) -> Iterator[tuple[str, GazeboExtension]]:
    for block in robot.gazebo:
        if block.reference and block.reference in robot.link:
            yield block.reference, block


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": (
            "lump the joint and drop the contents of the block, without a message (sdformat 12.3)"
        ),
    },
    group="robot",
)
def lumped_joint_loses_content(robot: Robot) -> Iterator[Problem]:
    """A fixed joint has a ``<gazebo>`` block but is not preserved.

    Gazebo removes fixed joints and lumps their links into one body. A force sensor or a plugin of
    the joint is dropped without a message. Add ``preserveFixedJoint`` to keep the joint. A block
    that only has settings of the joint, such as a spring, has no effect on a fixed joint, and is
    reported only as a warning if a plugin names the joint: it reads the feedback of the joint.
    """
    for block in robot.gazebo:
        joint = robot.joint.get(block.reference or "")
        if joint is None or not joint.is_fixed or block.reference in robot.link:
            continue
        if joint.parent == "world" or joint.is_preserved:
            continue
        lost = [child for child in block.element.children if child.tag not in LUMPING_TAGS]
        if not lost or all(
            child.tag not in JOINT_KEYWORDS and not child.children for child in lost
        ):
            continue
        what = quote(dict.fromkeys(f"<{child.tag}>" for child in lost)).replace("'", "")
        settles = all(child.tag in JOINT_KEYWORDS for child in lost)
        if settles and not _has_read_feedback(robot, block):
            continue  # a fixed joint has no spring, and nothing reads its feedback
        remedy = "add <preserveFixedJoint>true</preserveFixedJoint>"
        child = robot.link.get(joint.child)
        is_massless = child is not None and child.mass == 0
        if child is not None and is_massless:
            remedy += f" and give link '{child.name}' an <inertial>"
        if settles:
            remedy = f"for the plugin that names it {remedy}, or remove the block"
        yield Problem(
            block.element,
            f"joint '{joint.name}' is fixed, so Gazebo lumps it and drops {what}; {remedy}",
            at=block.locate_attribute("reference"),
            severity=WARNING if settles else None,
            alike=(what, is_massless),
            data={"joint": joint.name, "elements": list(dict.fromkeys(one.tag for one in lost))},
        )


def _has_read_feedback(robot: Robot, block: GazeboExtension) -> bool:
    """Tell whether a block of a joint has feedback, and a plugin names the joint, except as mimic.

    The name is the text of a tag in a plugin or sensor.
    """
    if block.element.find_child("provideFeedback") is None:
        return False
    return any(
        each.text.strip() == block.reference and "mimic" not in each.tag.lower()
        for other in robot.gazebo
        for child in other.element.children
        if child.tag in ("plugin", "sensor")
        for each in child.walk()
    )


@lumped_joint_loses_content.fix(UNSAFE)
def preserve_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Write ``preserveFixedJoint``."""
    block = problem.element
    if block.find_child("preserveFixedJoint") is not None:
        return None
    line = "<preserveFixedJoint>true</preserveFixedJoint>"
    return unsafe(f"write {line}", append_child(block, line))


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "apply the flag to the whole lumped body",
    },
    group="robot",
)
def lumped_flag_leaks(robot: Robot) -> Iterator[Problem]:
    """A flag of a lumped link applies to the whole body.

    Gazebo writes ``turnGravityOff`` and ``selfCollide`` of a link with a fixed joint to the body
    that it is lumped into. A camera frame without mass can turn gravity off for the whole robot. A
    flag of the heaviest link of the body is taken as intended.
    """
    for name, block in _iterate_link_blocks(robot):
        if not is_lumped(robot, name):
            continue
        for word, what in (("turnGravityOff", "gravity is off"), ("selfCollide", "it collides")):
            child = block.element.find_child(word)
            body = get_lumped_body(robot, name)
            if child is None or not is_true(get_text(child)):
                continue
            whole = robot.link[body]
            if (
                whole.is_weightless
                if word == "turnGravityOff"
                else is_set(whole.settings, "self_collide")
            ):
                continue
            links = (robot.link[other] for other in robot.link if other != name)
            others = [other for other in links if get_lumped_body(robot, other.name) == body]
            if sum(other.mass for other in others) <= robot.link[name].mass:
                continue
            means = "with itself" if word == "selfCollide" else ""
            yield Problem(
                block.element,
                f"<{word}> of '{name}' applies to all of '{body}', which it is fixed to: "
                f"{what} {means}".rstrip()
                + f"; write it for '{body}' if that is intended",
                at=child,
                alike=word,
                data={"element": word, "link": name, "body": body},
            )


@lumped_flag_leaks.fix(UNSAFE)
def remove_flag(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the flag, or the block if it has no others."""
    element = find_element(problem)
    if element is None:
        return None
    return remove_words(problem.element, frozenset((element.tag,)))


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "omit the link and its descendants (sdformat 12.3)",
    },
)
def preserved_joint_massless(robot: Robot) -> Iterator[Problem]:
    """A fixed joint is preserved, but one of its bodies has no mass.

    Gazebo only simulates links with mass. sdformat then ignores ``preserveFixedJoint``, or omits
    the link. Add a small inertial.
    """
    for joint in robot.joints:
        if not joint.is_fixed or not joint.is_preserved or joint.child not in robot.link:
            continue
        for side in (joint.child, joint.parent):
            if side not in robot.link or side == "world":
                continue
            body = get_lumped_body(robot, side)
            links = [name for name in robot.link if get_lumped_body(robot, name) == body]
            if all(robot.link[name].mass <= 0 for name in links):
                yield Problem(
                    joint,
                    f"fixed joint '{joint.name}' is preserved, but link '{side}' has no mass; "
                    f"give '{side}' a small <inertial>",
                    data={"link": side},
                )
                break


@preserved_joint_massless.fix(UNSAFE)
def add_inertial_of_kept_link(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a small inertial to the child, if it is the link without mass."""
    child = context.robot.link.get(context.get_joint(problem).child)
    if child is None or problem.data["link"] != child.name:
        return None
    from ..inertia.corrections import give_small_inertial

    return give_small_inertial(child)


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": (
            "rename the shape and apply none of the settings, without a message (sdformat 12.3)"
        ),
    },
    group="robot",
)
def named_geometry_loses_extensions(robot: Robot) -> Iterator[Problem]:
    """Gazebo does not apply the settings of a link to a named collision or visual.

    sdformat recognizes the shapes of a link by names that begin with the name of the link. It takes
    ``<collision name="hull">`` as a shape of a lumped link: it renames the shape, and does not
    apply friction, contact or material of the link. Remove the name, or begin it with the name of
    the link. For a visual, which loses its color, it is an info.
    """
    for link, collision, tags in list_unset_collisions(robot):
        yield _make_unset(link, collision, tags, WARNING)
    for link in robot.links:
        blocks = robot.extensions.get(link.name, [])
        words = {child.tag for block in blocks for child in block.element.children}
        for visual in link.visuals if (tags := sorted(words & {"material", "visual"})) else ():
            if not is_set_by_block(visual.name, link.name):
                yield _make_unset(link, visual, tags, INFO)


def _make_unset(
    link: Link, shape: Collision | Visual, tags: list[str], severity: Severity
) -> Problem:
    new = make_taking_name(shape.name or "", link.name)
    return Problem(
        link,
        f"{describe_unset(link, shape, tags)}; write '{new}'",
        at=shape.locate_attribute("name"),
        severity=severity,
        alike=(shape.tag, *tags),
        data={"write": new, "elements": tags},
    )


@named_geometry_loses_extensions.fix(UNSAFE)
def prefix_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Prefix the name with that of the link, if nothing refers to it; its settings then apply."""
    found = find_attribute(problem)
    link = context.get_link(problem)
    if found is None:
        return None
    element, attribute = found
    name = element.get(attribute) or ""
    if name in context.texts:
        return None
    new = make_taking_name(name, link.name)
    return unsafe(f"write name '{new}'", set_attribute(element, attribute, new))


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": (
            "rename the collision: the sensor reports no contact (sdformat 12.3)"
        ),
    },
)
def lumped_link_referenced(robot: Robot) -> Iterator[Problem]:
    """A contact sensor refers to a collision that Gazebo renames.

    Gazebo moves the collision of a link with a fixed joint to the body that it is lumped into, and
    adds ``fixed_joint_lump`` to its name. The ``<contact>`` of a sensor keeps the old name, so the
    sensor reports no contact.
    """
    for name, block in _iterate_link_blocks(robot):
        for sensor in block.sensors:
            contact = sensor.element.find_child("contact")
            collision = contact.find_child("collision") if contact is not None else None
            if collision is None:
                continue
            for link in robot.links:
                text = collision.text.strip()
                if text == f"{link.name}_collision" and is_lumped(robot, link.name):
                    body = get_lumped_body(robot, link.name)
                    new = f"{body}{LUMPED}{link.name}_collision"
                    yield Problem(
                        block.element,
                        f"collision '{text}' becomes '{new}' (or '{new}_1' …) in Gazebo, because "
                        f"'{link.name}' is fixed to '{body}'; write that, or preserve the joint",
                        at=collision,
                        data={"write": new, "link": link.name, "body": body},
                    )
        del name


@lumped_link_referenced.fix(UNSAFE)
def write_merged_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the name of the collision in Gazebo."""
    element = find_element(problem)
    new = problem.data["write"]
    if element is None:
        return None
    return unsafe(f"write {new}", set_text(element, new))


@rule(
    INFO,
    effects={
        "gz, gazebo-classic": "drop it",
    },
    group="robot",
)
def surface_without_collision(robot: Robot) -> Iterator[Problem]:
    """A link has contact settings but no collision.

    Gazebo writes friction and contact settings into the collisions of a link, and drops them if
    there is none. The collision may be missing.
    """
    for name, block in _iterate_link_blocks(robot):
        if robot.link[name].collisions:
            continue
        children = [child for child in block.element.children if child.tag in SURFACE_TAGS]
        if children:
            words = quote(dict.fromkeys(c.tag for c in children)).replace("'", "")
            have = "has" if len(children) == 1 else "have"
            yield Problem(
                block.element,
                f"{words} {have} no effect, because link '{name}' has no collision",
                at=children[0],
                alike=tuple(child.tag for child in children),
                data={"elements": [child.tag for child in children]},
            )


@surface_without_collision.fix(UNSAFE)
def remove_surface(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the settings, if the link has no visual, or the block if it has no others."""
    link = context.robot.link.get(problem.element.get("reference") or "")
    if link is None or link.visuals:
        return None  # rather the collision is missing
    return remove_words(problem.element, SURFACE_TAGS)
