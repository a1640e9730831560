"""What is lost when Gazebo joins fixed links into one body."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import GazeboExtension, Joint, Robot
from ...source.document import Element
from ..fix import (
    FixContext,
    Proposal,
    append_child,
    attribute_at,
    element_at,
    remove_element,
    set_attribute,
    set_text,
    unsafe,
)
from ..rule import ERROR, GAZEBO, INFO, UNSAFE, WARNING, Problem, rule
from ..words import quoted
from .keywords import JOINT_KEYWORDS, SURFACE, is_true

APPLIES_TO = ("gazebo",)

_KEEPERS = ("preserveFixedJoint", "disableFixedJointLumping")


def is_kept(robot: Robot, joint: Joint) -> bool:
    """Whether a fixed joint stays a joint in Gazebo."""
    blocks = robot.extensions.get(joint.name, [])
    return any(is_true(block.value(word)) for block in blocks for word in _KEEPERS)


def keeps_joint(element: Element) -> bool:
    """Tell whether an element of a joint's block keeps a fixed joint in Gazebo."""
    return element.tag in _KEEPERS and is_true(element.get("value") or element.text)


def is_lumped(robot: Robot, link: str) -> bool:
    """Whether Gazebo makes a link part of the body above it."""
    joint = robot.tree.parent_joint(link)
    return (
        joint is not None
        and joint.is_fixed
        and joint.parent in robot.link
        and joint.parent != "world"
        and not is_kept(robot, joint)
    )


def body_of(robot: Robot, link: str) -> str:
    """The link whose body a link becomes part of; itself where it stays."""
    seen = set()
    while is_lumped(robot, link) and link not in seen:
        seen.add(link)
        joint = robot.tree.parent_joint(link)
        assert joint is not None
        link = joint.parent
    return link


def remove_words(block: Element, words: frozenset[str]) -> Proposal:
    """Remove children of a ``<gazebo>`` by their tags; the block too, if it has no others."""
    gone = [child for child in block.children if child.tag in words]
    if len(gone) == len(block.children):
        return unsafe("take the block away", remove_element(block))
    return unsafe("take it away", *map(remove_element, gone))


def _blocks_of_links(robot: Robot) -> Iterator[tuple[str, GazeboExtension]]:
    for block in robot.gazebo:
        if block.reference and block.reference in robot.link:
            yield block.reference, block


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": (
            "merge the joint and drop what the block holds, without a message (sdformat 12.3)"
        ),
    },
    group="robot",
)
def lumped_joint_loses_content(robot: Robot) -> Iterator[Problem]:
    """A fixed joint has something in Gazebo and is not kept.

    Fixed joints do not exist in the simulated robot: their links are joined into one body. A force
    sensor at one, or a plugin, goes with it and nothing is said. ``preserveFixedJoint`` keeps it.
    Settings of the joint alone have no effect at one that does not move, and are a warning.
    """
    for block in robot.gazebo:
        joint = robot.joint.get(block.reference or "")
        if joint is None or not joint.is_fixed or block.reference in robot.link:
            continue
        if joint.parent == "world" or is_kept(robot, joint):
            continue
        lost = [child for child in block.element.children if child.tag not in _KEEPERS]
        if not lost or all(
            child.tag not in JOINT_KEYWORDS and not child.children for child in lost
        ):
            continue
        what = quoted(dict.fromkeys(f"<{child.tag}>" for child in lost)).replace("'", "")
        settles = all(child.tag in JOINT_KEYWORDS for child in lost)
        remedy = "add <preserveFixedJoint>true</preserveFixedJoint>"
        child = robot.link.get(joint.child)
        is_massless = child is not None and child.mass == 0
        if child is not None and is_massless:
            remedy += f" and give link '{child.name}' an <inertial>"
        if settles:
            remedy = f"remove the block; for a sensor {remedy}"
        yield Problem(
            block.element,
            f"joint '{joint.name}' is fixed, so Gazebo lumps it and drops {what}; {remedy}",
            at=block.element.attribute_place("reference"),
            severity=WARNING if settles else None,
            alike=(what, is_massless),
            data={"joint": joint.name, "elements": list(dict.fromkeys(one.tag for one in lost))},
        )


@lumped_joint_loses_content.fix(UNSAFE)
def preserve_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Write ``preserveFixedJoint``."""
    block = problem.element
    if block.child("preserveFixedJoint") is not None:
        return None
    line = "<preserveFixedJoint>true</preserveFixedJoint>"
    return unsafe(f"write {line}", append_child(block, line))


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "apply the flag to the whole merged body",
    },
    group="robot",
)
def lumped_flag_leaks(robot: Robot) -> Iterator[Problem]:
    """A flag of a link that is joined to another holds for both.

    ``turnGravityOff`` and ``selfCollide`` at a link on a fixed joint are written on the body it
    becomes part of. A camera frame without weight makes the whole robot float. At the
    heaviest link of the body it is taken to be meant.
    """
    for name, block in _blocks_of_links(robot):
        if not is_lumped(robot, name):
            continue
        for word, what in (("turnGravityOff", "gravity is off"), ("selfCollide", "it collides")):
            child = block.element.child(word)
            body = body_of(robot, name)
            if child is None or not is_true(block.value(word)):
                continue
            if any(is_true(other.value(word)) for other in robot.extensions.get(body, [])):
                continue
            links = (robot.link[other] for other in robot.link if other != name)
            others = [other for other in links if body_of(robot, other.name) == body]
            if sum(other.mass for other in others) <= robot.link[name].mass:
                continue
            means = "with itself" if word == "selfCollide" else ""
            yield Problem(
                block.element,
                f"<{word}> of '{name}' holds for all of '{body}', which it is fixed to: "
                f"{what} {means}".rstrip()
                + f"; write it at '{body}' if that is meant",
                at=child,
                alike=word,
                data={"element": word, "link": name, "body": body},
            )


@lumped_flag_leaks.fix(UNSAFE)
def remove_flag(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the flag; the block too, if it has nothing else."""
    element = element_at(problem)
    if element is None:
        return None
    return remove_words(problem.element, frozenset((element.tag,)))


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "leave out the link and all below it (sdformat 12.3)",
    },
)
def preserved_joint_massless(robot: Robot) -> Iterator[Problem]:
    """A fixed joint is kept, and on one side of it nothing has mass.

    A link that stays a link of its own needs mass to be simulated. sdformat then takes the
    ``preserveFixedJoint`` away, or does not model the link. A small inertial will do.
    """
    for joint in robot.joints:
        if not joint.is_fixed or not is_kept(robot, joint) or joint.child not in robot.link:
            continue
        for side in (joint.child, joint.parent):
            if side not in robot.link or side == "world":
                continue
            body = body_of(robot, side)
            links = [name for name in robot.link if body_of(robot, name) == body]
            if all(robot.link[name].mass <= 0 for name in links):
                yield Problem(
                    joint,
                    f"fixed joint '{joint.name}' is kept, and link '{side}' has no mass; "
                    f"give '{side}' a small <inertial>",
                    data={"link": side},
                )
                break


@preserved_joint_massless.fix(UNSAFE)
def add_inertial_of_kept_link(problem: Problem, context: FixContext) -> Proposal | None:
    """Add an inertial of a few grams to the child, if that is the link without mass."""
    child = context.robot.link.get(context.joint(problem).child)
    if child is None or problem.data["link"] != child.name:
        return None
    from ..inertia.corrections import give_small_inertial

    return give_small_inertial(child)


@rule(
    ERROR,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": (
            "rename the shape and apply none of the settings, without a message (sdformat 12.3)"
        ),
    },
    group="robot",
)
def named_geometry_loses_extensions(robot: Robot) -> Iterator[Problem]:
    """A named collision or visual loses what Gazebo is told of its link.

    sdformat knows the shapes of a link by names that begin with the link's. A ``<collision
    name="hull">`` is taken for one that came from another link: it is renamed, and friction,
    contact or material of the link are not applied to it. Leave the name out, or begin it with the
    link's.
    """
    for link in robot.links:
        words = {
            child.tag
            for block in robot.extensions.get(link.name, [])
            for child in block.element.children
        }
        for what, shapes, told in (
            ("collision", link.collisions, words & (SURFACE | {"collision"})),
            ("visual", link.visuals, words & {"material", "visual"}),
        ):
            for shape in shapes:
                if told and shape.name and not shape.name.startswith(link.name):
                    lost = " or ".join(sorted(told))
                    yield Problem(
                        link,
                        f"{what} '{shape.name}' does not begin with '{link.name}', so Gazebo "
                        f"applies no {lost} to it; name it '{link.name}_{shape.name}'",
                        at=shape.element.attribute_place("name"),
                        alike=(what, *sorted(told)),
                        data={"write": f"{link.name}_{shape.name}", "elements": sorted(told)},
                    )


@named_geometry_loses_extensions.fix(UNSAFE)
def prefix_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the link's name in front, if nothing refers to the shape; friction applies then."""
    found = attribute_at(problem)
    link = context.link(problem)
    if found is None:
        return None
    element, attribute = found
    name = element.get(attribute) or ""
    if name in context.texts:
        return None
    new = f"{link.name}_{name}"
    return unsafe(f"call it '{new}'", set_attribute(element, attribute, new))


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": (
            "give the collision another name: the sensor reports no contact (sdformat 12.3)"
        ),
    },
)
def lumped_link_referenced(robot: Robot) -> Iterator[Problem]:
    """A contact sensor names a collision that will have another name.

    The collision of a link on a fixed joint moves to the body it is joined to, and gets a name with
    ``fixed_joint_lump`` in it. In the ``<contact>`` of a sensor the old name stays, and means
    nothing.
    """
    for name, block in _blocks_of_links(robot):
        for sensor in block.sensors:
            contact = sensor.element.child("contact")
            collision = contact.child("collision") if contact is not None else None
            if collision is None:
                continue
            for link in robot.links:
                text = collision.text.strip()
                if text == f"{link.name}_collision" and is_lumped(robot, link.name):
                    body = body_of(robot, link.name)
                    new = f"{body}_fixed_joint_lump__{link.name}_collision"
                    yield Problem(
                        block.element,
                        f"'{text}' will be called '{new}' (or '{new}_1' …), as '{link.name}' is "
                        f"fixed to '{body}'; write that, or keep the joint",
                        at=collision,
                        data={"write": new, "link": link.name, "body": body},
                    )
        del name


@lumped_link_referenced.fix(UNSAFE)
def write_merged_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the name that the collision will have."""
    element = element_at(problem)
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
    """A link is told how it grips and has nothing to grip with.

    Friction and contact are written into the collisions of a link. Where there is none they are
    dropped; often the collision is what is missing.
    """
    for name, block in _blocks_of_links(robot):
        if robot.link[name].collisions:
            continue
        children = [child for child in block.element.children if child.tag in SURFACE]
        if children:
            words = quoted(dict.fromkeys(c.tag for c in children)).replace("'", "")
            do = "does" if len(children) == 1 else "do"
            yield Problem(
                block.element,
                f"{words} {do} nothing, as link '{name}' has no collision",
                at=children[0],
                alike=tuple(child.tag for child in children),
                data={"elements": [child.tag for child in children]},
            )


@surface_without_collision.fix(UNSAFE)
def remove_surface(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove it, if the link has no visual either; the block too, if it has nothing else."""
    link = context.robot.link.get(problem.element.get("reference") or "")
    if link is None or link.visuals:
        return None  # the collision is what is missing
    return remove_words(problem.element, SURFACE)
