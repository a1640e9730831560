"""Rules on missing friction and materials for Gazebo."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ...model.bounds import compute_size
from ...model.elements import Link, Material, Mesh, Robot
from ..fix import (
    Change,
    FixContext,
    Proposal,
    append_child,
    depends_on_arguments,
    escape_attribute,
    get_written_value,
    insert_after,
    safe,
    unsafe,
)
from ..rule import BOTH, GAZEBO, INFO, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import find_nearest
from .contact import get_contact_role, has_friction
from .lumping import get_lumped_body

_FRICTION = {
    "caster": "<mu1> and <mu2> near 0, so that it slides",
    "finger": "<mu1> and <mu2> for its friction",
}
_PLURAL = {"caster": "casters", "finger": "fingers"}
_MARKER = 0.01
"""Largest size [m] of a visual that only marks the position of a link. Chosen, no source."""
_GRAY = 0.06
"""Largest difference of the channels of a color that looks like the default of Gazebo Classic."""


@rule(
    WARNING,
    on=("gazebo-classic", "gz"),
    effects={
        "gz, gazebo-classic": "take a friction of 1, the default of SDF",
    },
    group="robot",
)
def missing_gazebo_tags(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A caster has no ``<gazebo>`` block although it needs one.

    URDF has no friction: ``<gazebo reference="the link">`` sets it. A caster that slides needs the
    block; the default of 1 is right for wheels, feet and fingers of rubber. ``missing-friction``
    reports blocks without it. Robots for other targets are not reported.
    """
    if targets.isdisjoint(GAZEBO) or _is_unclear(robot):
        return
    names = {*robot.link, *robot.joint}
    meant = {find_nearest(name, names) for name in robot.extensions if name and name not in names}
    for link in robot.links:
        if robot.extensions.get(link.name) or link.name in meant:
            continue
        if _get_role(robot, link) != "caster" or _has_from_body(robot, link, _has_friction):
            continue
        needed = _FRICTION["caster"]
        yield Problem(
            link,
            f"caster '{link.name}' has no <gazebo reference=\"{link.name}\">; it needs {needed}",
            group="{count} casters have no <gazebo> block, and need "
            f"{needed.replace('it slides', 'they slide')}: {{names}}",
        )


@missing_gazebo_tags.fix(UNSAFE)
def add_block(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a block with friction."""
    if not isinstance(problem.subject, Link):
        return None
    return _add_block(problem.subject, "<mu1>0.0</mu1>", "<mu2>0.0</mu2>")


def _add_block(link: Link, *inside: str) -> Proposal:
    """Propose a ``<gazebo>`` block of a link."""
    block = (
        f'<gazebo reference="{escape_attribute(get_written_value(link.element, "name"))}">',
        *(f"\t{line}" for line in inside),
        "</gazebo>",
    )
    return unsafe("add the block", insert_after(link.element, *block))


def _is_unclear(robot: Robot) -> bool:
    """Tell whether the reference of a block is an unexpanded expression."""
    return any(is_unexpanded(block.reference or "") for block in robot.gazebo)


@rule(
    INFO,
    on=("gazebo-classic",),
    effects={
        "gz": "takes the color of the URDF (sdformat 12.3)",
    },
    group="robot",
    default=False,
)
def missing_gazebo_material(robot: Robot) -> Iterator[Problem]:
    """A link with a color has no material for Gazebo Classic.

    Gazebo Classic ignores URDF colors and shows the link in gray. Write
    ``<material>Gazebo/Red</material>``, or the color in ``<visual><material>``, into
    ``<gazebo reference="the link">``. New Gazebo reads URDF colors. Gray visuals and markers of at
    most 1 cm are ignored.
    """
    if _is_unclear(robot):
        return
    colors = _collect_materials(robot)
    names = {*robot.link, *robot.joint}
    meant = {find_nearest(name, names) for name in robot.extensions if name and name not in names}
    for link in robot.links:
        blocks = robot.extensions.get(link.name, [])
        if link.name in meant or _has_material(robot, link):
            continue
        if not _is_shown_gray(robot, link, colors):
            continue
        where = "its" if blocks else "a new"
        yield Problem(
            link,
            f"link '{link.name}' has a color that Gazebo Classic ignores; write <material> into "
            f'{where} <gazebo reference="{link.name}">',
            at=blocks[0] if blocks else None,
            alike=bool(blocks),
            group="{count} links have a color that Gazebo Classic ignores; write <material> into "
            f"{'their' if blocks else 'new'} <gazebo> blocks: {{names}}",
        )


@missing_gazebo_material.fix(BOTH)
def write_material(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the color of the URDF into the block, or into a new one."""
    link = context.get_link(problem)
    lines = format_material(link, context.robot)
    if lines is None:
        return None
    inside = ("<visual>", *(f"\t{line}" for line in lines), "</visual>")
    blocks = context.robot.extensions.get(link.name)
    if not blocks:
        return _add_block(link, *inside)
    block = blocks[0].element
    visual = block.find_child("visual")
    if visual is not None:
        return safe("write its color", append_child(visual, *lines))
    return safe("write its color", append_child(block, *inside))


def format_material(link: Link, robot: Robot) -> tuple[str, ...] | None:
    """Format the color of a link's visuals as SDF; None if they have several colors."""
    colors = _collect_materials(robot)
    found = set()
    for visual in link.visuals:
        material = visual.material
        if material is not None and depends_on_arguments(link.element, "visual"):
            return None
        if material is not None and material.color is None:
            material = colors.get(material.name)
        found.add(None if material is None else material.color)
    if len(found) != 1 or (color := found.pop()) is None:
        return None
    text = " ".join(f"{part:.6g}" for part in color)
    return (
        "<material>",
        f"\t<ambient>{text}</ambient>",
        f"\t<diffuse>{text}</diffuse>",
        "</material>",
    )


def _has_from_body(robot: Robot, link: Link, is_there: Callable[[Robot, Link], bool]) -> bool:
    """Tell whether sdformat gives a lumped link the settings of the link that it is lumped into.

    It applies the blocks of that link to each part whose name begins with its name (run: sdformat
    12.3, friction and material).
    """
    body = get_lumped_body(robot, link.name)
    return body != link.name and link.name.startswith(body) and is_there(robot, robot.link[body])


@rule(
    INFO,
    on=("gazebo-classic", "gz"),
    effects={
        "gz, gazebo-classic": "take a friction of 1, the default of SDF, in both directions",
    },
    group="robot",
    formats=URDF_AND_SDF,
)
def missing_friction(robot: Robot) -> Iterator[Problem]:
    """A caster or finger has a ``<gazebo>`` block without friction.

    Without ``mu1`` and ``mu2`` both coefficients are 1: enough for a wheel or foot of rubber, too
    much for a caster that should slide, too little for a finger that should grip. Fingers of a
    gripper without moving joints are not reported. ``missing-gazebo-tags`` reports links without a
    block. In SDF the friction is in ``<surface>`` of the collision.
    """
    if _is_unclear(robot):
        return
    for link in robot.links:
        holders = robot.extensions.get(link.name) or (link.collisions if robot.xml is None else [])
        if not holders or has_friction(link) or _has_from_body(robot, link, _has_friction):
            continue
        role = _get_role(robot, link)
        if not role:
            continue
        friction = _FRICTION[role]
        where, places = "a <gazebo> block", "<gazebo> blocks"
        if robot.xml is None:
            where, places = "a collision", "collisions"
            friction = friction.replace("mu1", "mu")
        yield Problem(
            link,
            f"{role} '{link.name}' has {where} without friction; write {friction}",
            at=holders[0],
            data={"role": role},
            alike=role,
            group=f"{{count}} {_PLURAL[role]} have {places} without friction: {{names}}; "
            f"write {friction.replace(' its ', ' their ')}",
        )


@missing_friction.fix(UNSAFE)
def write_friction(problem: Problem, context: FixContext) -> Proposal | None:
    """Write 0 for a caster; which friction a finger needs is in no file."""
    link = context.get_link(problem)
    blocks = context.robot.extensions.get(link.name)
    if problem.data["role"] != "caster" or not blocks:
        return None
    lines = (("<mu1>0.0</mu1>",), ("<mu2>0.0</mu2>",))
    return unsafe("write mu1 and mu2 of 0.0", Change("insert", blocks[0].element, blocks=lines))


def _get_role(robot: Robot, link: Link) -> str | None:
    """Get the role of a link for whose contact the default friction of 1 is wrong."""
    role = get_contact_role(robot, link)
    return role if role in _FRICTION else None


def _collect_materials(robot: Robot) -> dict[str, Material]:
    """Collect all materials by name."""
    found = {m.name: m for m in robot.materials if m.name}
    for link in robot.links:
        for visual in link.visuals:
            material = visual.material
            if material is not None and material.name and material.color is not None:
                found.setdefault(material.name, material)
    return found


def _has_friction(robot: Robot, link: Link) -> bool:
    return has_friction(link)


def _is_shown_gray(robot: Robot, link: Link, colors: dict[str, Material]) -> bool:
    """Tell whether Gazebo Classic shows a link without its color."""
    return _has_visible_color(link, colors) and not _has_from_body(robot, link, _has_material)


def _has_visible_color(link: Link, colors: dict[str, Material]) -> bool:
    """Tell whether a visual has a URDF color that is not gray, and is not a marker."""
    for visual in link.visuals:
        material, shape = visual.material, visual.geometry
        if material is None or shape is None:
            continue
        if isinstance(shape, Mesh) and not shape.filename.lower().endswith(".stl"):
            continue  # such meshes have their own colors
        size = compute_size(shape)
        if size is not None and max(size) <= _MARKER:
            continue
        if material.color is None and material.texture is None:
            material = colors.get(material.name, material)
        if material.color is not None and max(material.color[:3]) - min(material.color[:3]) > _GRAY:
            return True
    return False


def _has_material(robot: Robot, link: Link) -> bool:
    for block in robot.extensions.get(link.name, ()):
        for child in block.element.children:
            if child.tag == "material" or (
                child.tag == "visual" and child.find_child("material") is not None
            ):
                return True
    return False
