"""Rules on deprecated settings, and on those that only one version of Gazebo reads."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.gazebo_plugins import is_for_gz
from ...source.document import Element
from ..fix import (
    Change,
    FixContext,
    Proposal,
    escape_attribute,
    find_element,
    get_written_value,
    insert_after,
    remove_element,
    rename_element,
    safe,
    unsafe,
)
from ..rule import GAZEBO, INFO, SAFE, UNSAFE, WARNING, Problem, rule
from ..words import quote
from .contact import get_contact_role
from .keywords import NOT_IN_GZ
from .tags import format_material


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "warn, and take it as implicitSpringDamper",
    },
)
def deprecated_cfm_damping(robot: Robot) -> Iterator[Problem]:
    """``cfmDamping`` is a deprecated name of ``implicitSpringDamper``.

    sdformat reads it with a warning.
    """
    for block in robot.gazebo:
        for child in block.element.list_children("cfmDamping"):
            has_both = block.element.find_child("implicitSpringDamper") is not None
            remedy = (
                ", and the block has implicitSpringDamper; remove it"
                if has_both
                else "; write implicitSpringDamper"
            )
            yield Problem(
                block.element,
                f"cfmDamping is deprecated{remedy}",
                at=child,
            )


@deprecated_cfm_damping.fix(SAFE)
def write_implicit_spring_damper(problem: Problem, context: FixContext) -> Proposal | None:
    """Write ``implicitSpringDamper``, if the block does not have it."""
    element = find_element(problem)
    parent = element.parent if element is not None else None
    if element is None or parent is None or parent.find_child("implicitSpringDamper") is not None:
        return None
    return safe("write <implicitSpringDamper>", rename_element(element, "implicitSpringDamper"))


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz": "keeps it in the SDF, where gz-physics does not read it for DART",
    },
    pedantic="robots without a plugin for new Gazebo, whose settings may be for Classic",
)
def no_effect_in_gz(
    robot: Robot, targets: frozenset[str], guessed: frozenset[str]
) -> Iterator[Problem]:
    """A setting of Gazebo Classic has no effect in new Gazebo.

    Contact stiffness and damping, contact counts, stops and feedback are settings of ODE. sdformat
    keeps them in the SDF, but gz-sim and its physics engines ignore them. Friction (mu1, mu2,
    fdir1) has an effect. Robots for Gazebo Classic are not reported, nor those that only a
    ``<gazebo>`` tag shows to be for new Gazebo. If the description has no plugin for new Gazebo,
    the finding is an info, and off by default, because the settings may be for Gazebo Classic.
    """
    if "gazebo-classic" in targets or "gz" in guessed:
        return
    found: dict[str, list[tuple[Element, Element]]] = {}
    for block in robot.gazebo:
        for child in block.element.children:
            if block.reference and child.tag in NOT_IN_GZ:
                found.setdefault(child.tag, []).append((block.element, child))
    if found:
        block_, first = next(iter(found.values()))[0]
        words = quote(found, 6).replace("'", "")
        count = sum(map(len, found.values()))
        times = f" ({count} times)" if count > 1 else ""
        have = "have" if len(found) > 1 else "has"
        them = "them" if count > 1 else "it"
        own = any(is_for_gz(plugin.element) for plugin in robot.plugins)
        remedy = f"remove {them}" if own else f"keep {them} only for Gazebo Classic"
        yield Problem(
            block_,
            f"{words} {have} no effect in new Gazebo{times}; {remedy}",
            at=first,
            severity=None if own else INFO,
            pedantic=not own,
            data={"elements": list(found), "count": count, "has_gz_plugin": own},
        )


@no_effect_in_gz.fix(UNSAFE)
def remove_classic_settings(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove all settings that only Gazebo Classic reads."""
    changes = []
    for block in context.robot.gazebo:
        if not block.reference:
            continue
        gone = [child for child in block.element.children if child.tag in NOT_IN_GZ]
        if gone and len(gone) == len(block.element.children):
            changes.append(remove_element(block.element))
        else:
            changes += map(remove_element, gone)
    return unsafe("remove all of them", *changes)


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz": "does not read Ogre scripts, and warns",
    },
    group="robot",
)
def ogre_material_script(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A material of Gazebo Classic is not available in new Gazebo.

    New Gazebo has the names ``Gazebo/…``, but it cannot read Ogre scripts, which define all others.
    It shows the color of the URDF, or the color in ``<visual><material><diffuse>``.
    """
    if "gazebo-classic" in targets:
        return
    found: dict[str, list[Element]] = {}
    for block in robot.gazebo:
        if not block.reference:
            continue
        for element in block.element.children:
            if element.tag == "material":
                name = (element.get("value") or element.text).strip()
                if name and not name.startswith("Gazebo/") and not element.children:
                    found.setdefault(name, []).append(element)
            elif element.tag == "visual":
                for script in element.walk():
                    uri = script.find_child("uri") if script.tag == "script" else None
                    if uri is not None and "gazebo.material" not in uri.text:
                        found.setdefault(uri.text.strip(), []).append(script)
    for name, elements in found.items():
        more = f" ({len(elements)} times)" if len(elements) > 1 else ""
        yield Problem(
            elements[0],
            f"material '{name}'{more} is an Ogre script, which new Gazebo cannot read; "
            "remove it if the URDF has a color",
            alike=len(elements) > 1,
            data={"material": name, "count": len(elements)},
        )


@ogre_material_script.fix(SAFE)
def remove_script(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the material from all links, if the URDF has a color for each of them."""
    name = problem.data["material"]
    changes = []
    for block in context.robot.gazebo:
        link = context.robot.link.get(block.reference or "")
        for element in block.element.walk():
            if element.tag == "script":
                uri = element.find_child("uri")
                named = uri is not None and uri.text.strip() == name
            else:
                value = (element.get("value") or element.text).strip()
                named = element.tag == "material" and value == name
            if not named:
                continue
            if link is None or format_material(link, context.robot) is None:
                return None
            changes.append(remove_element(element))
    return safe("use the color of the URDF", *changes) if changes else None


@rule(
    INFO,
    on=("gazebo-classic",),
    default=False,
    effects={
        "gazebo-classic": "takes the defaults of SDF: it gets no <kp> and <kd>",
    },
)
def missing_contact_parameters(robot: Robot) -> Iterator[Problem]:
    """A foot, finger or wheel has no contact parameters.

    The default contact stiffness of ODE is 1e12, which makes contacts vibrate. Typical values are a
    ``kp`` of 1e6 N/m, a ``kd`` of 100 N s/m and a ``minDepth`` of 1 mm.
    """
    for link in robot.links:
        role = get_contact_role(robot, link)
        if not role:
            continue
        words = {
            child.tag
            for block in robot.extensions.get(link.name, [])
            for child in block.element.children
        }
        if not words & {"kp", "kd", "minDepth", "collision"}:
            yield Problem(
                link, f"{role} '{link.name}' has no contact parameters; write kp, kd and minDepth"
            )


@missing_contact_parameters.fix(UNSAFE)
def write_contact_parameters(problem: Problem, context: FixContext) -> Proposal | None:
    """Write a stiffness of 1e6 N/m, a damping of 100 N s/m and a depth of 1 mm."""
    link = context.get_link(problem)
    lines = (("<kp>1e6</kp>",), ("<kd>100</kd>",), ("<minDepth>0.001</minDepth>",))
    blocks = context.robot.extensions.get(link.name)
    if blocks:
        return unsafe("write them", Change("insert", blocks[0].element, blocks=lines))
    block = (
        f'<gazebo reference="{escape_attribute(get_written_value(link.element, "name"))}">',
        *(f"\t{line}" for one in lines for line in one),
        "</gazebo>",
    )
    return unsafe("write them", insert_after(link.element, *block))


@rule(
    INFO,
    on=("gz",),
    default=False,
    effects={
        "gz": "gets only <ode> friction, and no <bullet> friction",
    },
)
def engine_ignores_ode_friction(robot: Robot) -> Iterator[Problem]:
    """The friction is set for one physics engine, and others ignore it.

    ``mu1`` and ``mu2`` become ``<friction><ode>``, which DART, the default engine of new Gazebo,
    reads. The engine bullet-featherstone only reads ``<friction><bullet>``, and the MuJoCo engine
    reads no surface of SDF. To use bullet-featherstone, write both in ``<collision><surface>``.
    """
    found = [
        block
        for block in robot.gazebo
        if any(block.element.find_child(word) for word in ("mu1", "mu2"))
        and not any(element.tag == "bullet" for element in block.element.walk())
    ]
    if found:
        names = [f"'{block.reference}'" for block in found if block.reference]
        more = f" (and {len(names) - 1} more)" if len(names) > 1 else ""
        yield Problem(
            found[0].element,
            f"bullet-featherstone ignores the friction{f' of {names[0]}{more}' if names else ''}; "
            "for that engine write <friction><bullet><friction> and <friction2> too",
        )
