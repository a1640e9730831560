"""What Gazebo needs to be told of a link, and is not."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ...model.bounds import size_of
from ...model.elements import GazeboExtension, Link, Material, Mesh, Robot
from ..fix import (
    Change,
    FixContext,
    Proposal,
    append_child,
    depends_on_arguments,
    escape_attribute,
    insert_after,
    safe,
    unsafe,
    written_value,
)
from ..rule import GAZEBO, INFO, SAFE, UNSAFE, WARNING, Problem, holding, rule
from ..unexpanded import is_unexpanded
from ..words import nearest
from .contact import contact_role, has_friction
from .lumping import body_of

_FRICTION = {
    "wheel": "<mu1> and <mu2> for its grip",
    "caster": "<mu1> and <mu2> near 0, or it brakes",
    "foot": "<mu1> and <mu2> for its grip",
    "finger": "<mu1> and <mu2> for its grip",
}
_PLURAL = {"wheel": "wheels", "caster": "casters", "foot": "feet", "finger": "fingers"}
_MARKER = 0.01  # [m] the largest visual that only marks the place of a link
_GREY = 0.06  # colours whose parts differ less than this look like Gazebo Classic's own


_WITHOUT_BLOCK = {
    "gz, gazebo-classic (without friction)": "take a friction of 1, the default of SDF",
    "gz (without a color)": "takes URDF's color (sdformat 12.3)",
}


@rule(
    WARNING,
    on=("gazebo-classic", "gz"),
    effects=_WITHOUT_BLOCK,
    group="robot",
)
def missing_gazebo_tags(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A link has no ``<gazebo>`` block though it needs one.

    URDF says nothing of friction, and Gazebo Classic does not take its colours: both are said in
    ``<gazebo reference="the link">``. A link needs the block if it rolls, stands or grips (a
    wheel, a caster, a foot, a finger), for its friction; and in Gazebo Classic if a visual has a
    color, which alone is a remark; a marker of at most 1 cm is none. Other links need none and are
    not named; a block that lacks something is a case of ``missing-friction`` or
    ``missing-gazebo-material``. A robot that is not for Gazebo needs none.
    """
    if targets.isdisjoint(GAZEBO) or _is_unclear(robot):
        return
    colours = _colours(robot)
    names = {*robot.link, *robot.joint}
    meant = {nearest(name, names) for name in robot.extensions if name and name not in names}
    for link in robot.links:
        if robot.extensions.get(link.name) or link.name in meant:
            continue
        role = None if _has_by_name(robot, link, has_friction) else contact_role(robot, link)
        needs = [_FRICTION[role]] if role else []
        cases = ["without friction"] if role else []
        if "gazebo-classic" in targets and _lacks_material(robot, link, colours):
            needs.append("<material>, for Gazebo Classic does not show the colors of a URDF")
            cases.append("without a color")
        if needs:
            kind = f"{role} '{link.name}'" if role else f"link '{link.name}'"
            yield Problem(
                link,
                f'{kind} has no <gazebo reference="{link.name}">; it needs {" and ".join(needs)}',
                severity=None if role else INFO,
                data={"role": role or ""},
                alike=(role == "caster", *cases),
                effects=holding(_WITHOUT_BLOCK, *cases),
                group="{count} links have no <gazebo> block of their own, and need "
                f"{' and '.join(needs).replace(' its ', ' their ')}: {{names}}",
            )


@missing_gazebo_tags.fix(UNSAFE)
def add_block(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a block with its friction, and with its color for Gazebo Classic."""
    if not isinstance(problem.subject, Link):
        return None
    link, robot = problem.subject, context.robot
    inside: list[str] = []
    role = contact_role(robot, link)
    if role:
        mu = _coefficient(role)
        inside += [f"<mu1>{mu}</mu1>", f"<mu2>{mu}</mu2>"]
    if "gazebo-classic" in context.targets and _lacks_material(robot, link, _colours(robot)):
        lines = material_lines(link, robot)
        if lines is not None:
            inside += ["<visual>", *(f"\t{line}" for line in lines), "</visual>"]
    if not inside:
        return None
    block = (
        f'<gazebo reference="{escape_attribute(written_value(link.element, "name"))}">',
        *(f"\t{line}" for line in inside),
        "</gazebo>",
    )
    return unsafe("add the block", insert_after(link.element, *block))


def _is_unclear(robot: Robot) -> bool:
    """Whether a block is there of which it is not known what it refers to."""
    return any(is_unexpanded(block.reference or "") for block in robot.gazebo)


@rule(
    INFO,
    on=("gazebo-classic",),
    effects={
        "gz": "takes URDF's color (sdformat 12.3)",
    },
    group="robot",
)
def missing_gazebo_material(robot: Robot) -> Iterator[Problem]:
    """A link with a colour has a ``<gazebo>`` block without a material.

    Gazebo Classic does not convert the colours of a URDF: the link is grey whatever it is in RViz.
    It wants ``<material>Gazebo/Red</material>``, or the colour itself in ``<visual><material>``.
    New Gazebo takes URDF's colours. A link that has no block at all is a case of
    ``missing-gazebo-tags``; greys and markers of at most 1 cm are let pass.
    """
    if _is_unclear(robot):
        return
    colours = _colours(robot)
    for link in robot.links:
        blocks = robot.extensions.get(link.name, [])
        if blocks and not _has_material(blocks) and _lacks_material(robot, link, colours):
            yield Problem(
                link,
                f"link '{link.name}' has a colour that Gazebo Classic does not show; write "
                f'<material> into its <gazebo reference="{link.name}">',
                at=blocks[0],
                group="{count} links with a <gazebo> block have a color that Gazebo Classic does "
                "not show; write <material> into their <gazebo> blocks: {names}",
            )


@missing_gazebo_material.fix(SAFE)
def write_material(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the color of the URDF into its block."""
    link = context.link(problem)
    lines = material_lines(link, context.robot)
    blocks = context.robot.extensions.get(link.name)
    if lines is None or not blocks:
        return None
    block = blocks[0].element
    visual = block.child("visual")
    if visual is not None:
        return safe("write its colour", append_child(visual, *lines))
    inside = ("<visual>", *(f"\t{line}" for line in lines), "</visual>")
    return safe("write its colour", append_child(block, *inside))


def material_lines(link: Link, robot: Robot) -> tuple[str, ...] | None:
    """Format the color of a link's visuals as SDF; None where they have several."""
    colours = _colours(robot)
    found = set()
    for visual in link.visuals:
        material = visual.material
        if material is not None and depends_on_arguments(link.element, "visual"):
            return None
        if material is not None and material.color is None:
            material = colours.get(material.name)
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


def _has_by_name(
    robot: Robot, link: Link, is_there: Callable[[list[GazeboExtension]], bool]
) -> bool:
    """Whether sdformat gives a lumped link what the blocks of another link have.

    It applies the blocks of the link that a body is named after to each part whose name begins
    with its name (run: sdformat 12.3, friction and material).
    """
    body = body_of(robot, link.name)
    return (
        body != link.name
        and link.name.startswith(body)
        and is_there(robot.extensions.get(body, []))
    )


@rule(
    INFO,
    on=("gazebo-classic", "gz"),
    effects={
        "gz, gazebo-classic": "take a friction of 1, the default of SDF, in both directions",
    },
    group="robot",
)
def missing_friction(robot: Robot) -> Iterator[Problem]:
    """A wheel, caster, foot or finger has a ``<gazebo>`` block without friction.

    Without ``mu1`` and ``mu2`` the coefficients are 1: enough for a rubber wheel, too much for a
    caster that should slide, too little for a finger that should hold. A finger of a gripper whose
    joints are all fixed grips nothing, and is not reported. A link that has no block at all is a
    case of ``missing-gazebo-tags``.
    """
    if _is_unclear(robot):
        return
    for link in robot.links:
        blocks = robot.extensions.get(link.name, [])
        if blocks and not has_friction(blocks) and not _has_by_name(robot, link, has_friction):
            role = contact_role(robot, link)
            if role:
                yield Problem(
                    link,
                    f"{role} '{link.name}' has no friction of its own; write {_FRICTION[role]}",
                    at=blocks[0],
                    data={"role": role},
                    alike=role,
                    group=f"{{count}} {_PLURAL[role]} have no friction of their own: {{names}}; "
                    f"write {_FRICTION[role].replace(' its ', ' their ')}",
                )


@missing_friction.fix(UNSAFE)
def write_friction(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the friction of rubber, or none for a caster."""
    link = context.link(problem)
    role = contact_role(context.robot, link)
    blocks = context.robot.extensions.get(link.name)
    if not role or not blocks:
        return None
    mu = _coefficient(role)
    change = Change(
        "insert", blocks[0].element, blocks=((f"<mu1>{mu}</mu1>",), (f"<mu2>{mu}</mu2>",))
    )
    return unsafe(f"write mu1 and mu2 of {mu}", change)


def _coefficient(role: str) -> str:
    """Get the friction of a link that touches the world so."""
    return "0.0" if role == "caster" else "1.0"


def _colours(robot: Robot) -> dict[str, Material]:
    """Materials by name, wherever they are defined."""
    found = {m.name: m for m in robot.materials if m.name}
    for link in robot.links:
        for visual in link.visuals:
            material = visual.material
            if material is not None and material.name and material.color is not None:
                found.setdefault(material.name, material)
    return found


def _lacks_material(robot: Robot, link: Link, colours: dict[str, Material]) -> bool:
    """Whether Gazebo Classic shows a link without its color, for want of a block of another."""
    return _shows_colour(link, colours) and not _has_by_name(robot, link, _has_material)


def _shows_colour(link: Link, colours: dict[str, Material]) -> bool:
    """Whether a visual is given a color in the URDF that is not a grey, and is no marker."""
    for visual in link.visuals:
        material, shape = visual.material, visual.geometry
        if material is None or shape is None:
            continue
        if isinstance(shape, Mesh) and not shape.filename.lower().endswith(".stl"):
            continue  # such meshes bring their own
        size = size_of(shape)
        if size is not None and max(size) <= _MARKER:
            continue
        if material.color is None and material.texture is None:
            material = colours.get(material.name, material)
        if material.color is not None and max(material.color[:3]) - min(material.color[:3]) > _GREY:
            return True
    return False


def _has_material(blocks: list[GazeboExtension]) -> bool:
    for block in blocks:
        for child in block.element.children:
            if child.tag == "material" or (
                child.tag == "visual" and child.child("material") is not None
            ):
                return True
    return False
