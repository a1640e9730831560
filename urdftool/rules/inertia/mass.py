"""Masses, and whether an inertial says all it has to."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...model.attached import attached_links
from ...model.bounds import Bounds
from ...model.elements import Inertial, Link, Robot
from ...model.millimeters import shapes_in_millimeters
from ...source.location import Place
from ..fix import FixContext, Proposal, remove_sign, set_attribute, unsafe
from ..mesh.outlines import Reaches, reaches
from ..rule import ERROR, GAZEBO, INFO, UNSAFE, WARNING, Problem, rule
from ..words import some_of
from ..xml.vocabulary_table import misspelt_attributes, misspelt_children
from .bodies import bodies, mass_of, massless_pairs
from .solids import solid_volume
from .tensors import SIX

_AS_PART = ("gz, gazebo-classic, pinocchio (part)", "mujoco (part)", "drake (part)")
_AS_ROOT = ("gz, gazebo-classic (root)", "pybullet (root)")


@rule(
    ERROR,
    effects={
        "urdfdom, pinocchio": (
            "load the link without its visuals and collisions, with an error in the log"
        ),
        "gz, gazebo-classic (with a mass)": "load the link without its visuals and collisions",
        "gz, gazebo-classic (without a mass)": (
            "take 0 kg and drop its visuals and collisions; leave out a body without mass, and "
            "all below it"
        ),
        "check_urdf": "reports success nevertheless",
        "mujoco": "rejects the file",
        "pybullet (no element)": "rejects the robot",
        "pybullet, drake (a number)": "take 0 for a missing number",
    },
)
def incomplete_inertial(robot: Robot) -> Iterator[Problem]:
    """An ``<inertial>`` lacks its mass, its inertia or one of the six numbers.

    urdfdom gives up on the link right there: its visuals and collisions are lost, its inertia is
    zero, and the robot is reported as parsed all the same. A number that is zero has to be written.
    """
    for link in robot.links:
        if link.inertial is None:
            continue
        missing, at = _missing(link.inertial)
        if missing:
            yield Problem(
                link,
                f"<inertial> of link '{link.name}' has no {', '.join(missing)}; write it",
                at=at,
                effects=_effects_of(link.inertial),
                data={"missing": missing},
            )


@incomplete_inertial.full
def every_incomplete_inertial(robot: Robot) -> Iterator[Problem]:
    """Report each inertial that lacks an element or a number, also where one is misspelt."""
    for link in robot.links:
        if link.inertial is None or link.inertial.xml is None:
            continue
        found = {child.tag: child for child in link.inertial.xml.children}
        missing = [f"<{tag}>" for tag in ("mass", "inertia") if tag not in found]
        lacks_element = bool(missing)
        if "inertia" in found:
            missing += [name for name in SIX if name not in found["inertia"].attributes]
        if missing:
            text = f"<inertial> of link '{link.name}' has no {', '.join(missing)}; write it"
            data = {"missing": missing, "lacks_element": lacks_element}
            yield Problem(link, text, at=link.inertial, data=data)


def _effects_of(inertial: Inertial) -> set[str]:
    mass, inertia = inertial.element.child("mass"), inertial.element.child("inertia")
    has_mass = mass is not None and "value" in mass.attributes
    has = "with" if has_mass else "without"
    keys = {"urdfdom, pinocchio", f"gz, gazebo-classic ({has} a mass)", "check_urdf", "mujoco"}
    if mass is None or inertia is None:
        keys.add("pybullet (no element)")
    elif has_mass:
        keys.add("pybullet, drake (a number)")
    return keys


def _missing(inertial: Inertial) -> tuple[list[str], Inertial | None]:
    element = inertial.element
    missing: list[str] = []
    mass, inertia = element.child("mass"), element.child("inertia")
    if mass is None:
        missing.append("<mass>")
    elif not mass.attributes:
        missing.append("mass value")
    if inertia is None:
        missing.append("<inertia>")
    if mass is None or inertia is None:
        if missing and (meant := misspelt_children(element)):
            missing = [name for name in missing if name.strip("<>") not in meant.values()]
    if inertia is not None:
        lacking = [name for name in SIX if name not in inertia.attributes]
        if lacking and (meant := misspelt_attributes(inertia)):
            lacking = [name for name in lacking if name not in meant.values()]
        if lacking and not missing:
            return lacking, Inertial(inertia)
        missing += lacking
    return missing, inertial


@incomplete_inertial.fix(UNSAFE)
def write_products_of_zero(problem: Problem, context: FixContext) -> Proposal | None:
    """Write 0 for products of inertia that are not written."""
    inertial = context.link(problem).inertial
    inertia = inertial.element.child("inertia") if inertial is not None else None
    if inertial is None or inertia is None or inertial.element.child("mass") is None:
        return None
    missing = [name for name in SIX if name not in inertia.attributes]
    if not missing or not set(missing) <= {"ixy", "ixz", "iyz"}:
        return None
    zeros = " ".join(f'{name}="0"' for name in missing)
    return unsafe(f"write {zeros}", *(set_attribute(inertia, name, "0") for name in missing))


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic": "leave out the link and all below it (sdformat 12.3)",
        "gz, gazebo-classic (root)": (
            "load nothing: a model must have at least one link (sdformat 12.3)"
        ),
        "gz, gazebo-classic (both)": "reject the robot: pose values must be finite (sdformat 12.3)",
        "gz, gazebo-classic, pinocchio (part)": "add the inertia to the body that it is fixed to",
        "mujoco": "rejects the file: mass of moving bodies must be positive",
        "mujoco (part)": "ignores the inertia",
        "drake (part)": "makes the link weigh 1 kg, with a warning",
        "pybullet (root)": "fixes the root link to the world",
    },
    group="robot",
)
def zero_mass(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A rigid body has mass 0, or a link of mass 0 has an inertia.

    A body that moves has a mass. Gazebo removes one without and everything below it, MuJoCo rejects
    the file, PyBullet never moves it. What counts is the body: a link of mass 0 that is fixed to
    one with a mass is merged into it and keeps its shapes, which is how a link says that it adds no
    mass. A root of mass 0 is PyBullet's way to say that a model is static: it is an error for
    Gazebo, and of a robot with joints that move a remark. An inertia next to a mass of 0 is added
    to the body by Gazebo and pinocchio, and Drake makes such a link weigh 1 kg. Two links of mass 0
    that are fixed to each other are one too many for Gazebo, which divides by the sum.
    """
    zero = [link for link in robot.links if link.inertial and link.inertial.mass == 0.0]
    if not zero:
        return
    yield from _pairs_without_mass(robot, targets)
    body = {link.name: links for links in bodies(robot).values() for link in links}
    for link in zero:
        if link.name == "world" or link.inertial is None:
            continue
        links = body.get(link.name, [link])
        joint = robot.tree.parent_joint(links[0].name)
        mass = link.inertial.child_xml("mass")
        at = mass.attribute_place("value") if mass is not None else None
        if mass_of(links) > 0:
            tensor = link.inertial.inertia
            if tensor is not None and any(tensor.six):
                yield Problem(
                    link,
                    f"mass of link '{link.name}' is 0 and its inertia is not; write its mass, or "
                    "an inertia of zeros",
                    at=at,
                    effects=_AS_PART,
                    alike="part",
                )
            continue
        if link is not next(one for one in links if one in zero):
            continue  # one finding for a body
        moved = joint is not None and not joint.is_fixed
        if not targets.isdisjoint(GAZEBO):
            case, severity = "removed", ERROR
            so = "Gazebo removes the link and everything attached to it"
        elif moved and "mujoco" in targets:
            case, severity, so = "rejected", ERROR, "MuJoCo rejects the file"
        elif moved:
            case, severity = "moves", ERROR if link.collisions else WARNING
            so = "a body that moves has a mass"
        elif robot.moving_joints and targets != {"pybullet"}:
            case, severity = "root", INFO
            so = "PyBullet fixes it to the world, and Gazebo loads nothing"
            if joint is not None:
                case, so = "removed", "Gazebo removes the link and everything attached to it"
        else:
            continue
        keys = {"gz, gazebo-classic", *(("mujoco",) if moved else ())}
        yield Problem(
            link,
            f"mass of link '{link.name}' is 0; {so}. Write its mass",
            at=at,
            severity=severity,
            effects=_AS_ROOT if joint is None else keys,
            alike=case,
        )


@zero_mass.full
def every_zero_mass(robot: Robot) -> Iterator[Problem]:
    """Report each link with a mass of 0, also where it is a part of a body with a mass.

    A part without an inertia is harmless, and so is a body that no joint moves.
    """
    for link, value, place in _masses(robot):
        if value != 0.0 or link.name == "world" or link.inertial is None:
            continue
        members = [one for one, _ in attached_links(robot, link)]
        tensor, what = link.inertial.inertia, "; write its mass"
        if mass_of(members) > 0:
            is_harmless = tensor is None or not any(tensor.six)
            what = "; it adds none to the links that it is fixed to"
            if not is_harmless:
                what = " and its inertia is not; write its mass, or an inertia of zeros"
        else:
            joints = [robot.tree.parent_joint(one.name) for one in members]
            is_harmless = all(joint is None or joint.is_fixed for joint in joints)
            if is_harmless:
                what = "; PyBullet fixes it to the world, and Gazebo removes it"
        yield Problem(
            link,
            f"mass of link '{link.name}' is 0{what}",
            at=place,
            data={"is_harmless": is_harmless},
        )


def _pairs_without_mass(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    for parent, link in massless_pairs(robot):
        if link.inertial is None:
            continue
        yield Problem(
            link,
            f"links '{parent.name}' and '{link.name}' are fixed to each other and have mass 0, at "
            f"which sdformat 12.3 rejects the robot; write a mass of 1e-5 kg for '{link.name}'",
            at=link.inertial,
            severity=INFO if targets.isdisjoint(GAZEBO) else ERROR,
            group="{count} links of mass 0 are fixed to links of mass 0, at which sdformat 12.3 "
            "rejects the robot; write a mass of 1e-5 kg for each: {names}",
            effects=("gz, gazebo-classic (both)",),
            alike="pair",
        )


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
        "pybullet, urdfdom, pinocchio": "accept it without a message",
        "drake": "warns, and takes another inertia",
    },
)
def negative_mass(robot: Robot) -> Iterator[Problem]:
    """A link's mass is negative.

    It accelerates against the force. Gazebo and MuJoCo refuse it, PyBullet simulates it.
    """
    for link, mass, place in _masses(robot):
        if mass < 0:
            yield Problem(
                link,
                f"mass of link '{link.name}' is {mass:g} kg; write {-mass:g}",
                at=place,
                data={"mass": mass},
            )


@negative_mass.fix(UNSAFE)
def write_magnitude(problem: Problem, _context: FixContext) -> Proposal | None:
    """Write the mass without its sign."""
    return remove_sign(problem)


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "take it as written",
    },
    of_motion=True,
)
def implausible_mass(
    robot: Robot, *, heaviest: float = 1000.0, lightest: float = 1e-5
) -> Iterator[Problem]:
    """A link weighs more than a tonne, or less than a hundredth of a gram.

    Masses are in kilograms. Grams make a robot a thousand times too heavy. A frame without shapes
    may weigh as little as its author wants: next to nothing is what a program asked for.
    """
    reach = reaches(robot)
    for link, mass, place in _masses(robot):
        if not lightest <= mass <= heaviest and _density(reach.link(link), link, mass)[0]:
            continue  # its size tells more than its mass alone
        if mass > heaviest:
            what = f"{mass:g} kg; if that is grams, write {mass / 1000:g}"
        elif 0 < mass < lightest and (link.visuals or link.collisions):
            what = f"{mass:g} kg, less than {lightest * 1e6:g} mg; are the units right?"
        else:
            continue
        yield Problem(
            link,
            f"mass of link '{link.name}' is {what}",
            at=place,
            data={"mass": mass},
        )


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "take it as written",
    },
    of_motion=True,
    group="robot",
    caused_by=(
        *("mesh-in-millimetres", "mesh-scaled-twice", "mesh-scale-out-of-line"),
        "collision-much-larger-than-visual",
    ),
)
def implausible_density(
    robot: Robot,
    *,
    least: float = 5.0,
    most: float = 12000.0,
    least_possible: float = 1.0,
    most_possible: float = 22600.0,
    small: float = 0.02,
    dummy: float = 1e-3,
    most_of_box: float = 8000.0,
    together: float = 6,
) -> Iterator[Problem]:
    """A link's mass does not go with its size.

    Between foam and lead lie 5 and 12,000 kg/m³, and nothing is denser than osmium with 22,600.
    Beyond that, a unit is wrong: grams, or millimetres. A shape of millimetres is mostly a mark for
    a frame: no more than a remark, and not reported where it is fixed to links that weigh ten times
    as much. A remark is also a link of at most ``dummy`` [kg] that is fixed to
    another, as sensors have it to survive Gazebo. Of a mesh, or of several shapes, the box around
    them counts: one that is all of steel has ``most_of_box``, and one lighter than air is hollow
    beyond belief. More than ``together`` remarks are one, which names some of the links.
    """
    bounds = _DensityBounds(least, most, least_possible, most_possible, small, dummy, most_of_box)
    found = list(_find_densities(robot, bounds))
    yield from (_of_density(one) for one in found if one.impossible)
    remarks = [one for one in found if not one.impossible]
    also = ""
    if len(remarks) > together:
        names = [f"'{one.link.name}' {one.density:.3g}" for one in remarks[1:]]
        also = f"; densities are as odd of {some_of(names, 'links')}"
        del remarks[1:]
    yield from (_of_density(one, also) for one in remarks)


@implausible_density.full
def every_implausible_density(robot: Robot) -> Iterator[Problem]:
    """Report each link whose mass does not go with its own size, whatever it is fixed to."""
    return map(_of_density, _find_densities(robot, _DensityBounds(), of_body=False))


class _DensityBounds(NamedTuple):
    """The thresholds of :func:`implausible_density`, but ``together``."""

    least: float = implausible_density.thresholds["least"]
    most: float = implausible_density.thresholds["most"]
    least_possible: float = implausible_density.thresholds["least_possible"]
    most_possible: float = implausible_density.thresholds["most_possible"]
    small: float = implausible_density.thresholds["small"]
    dummy: float = implausible_density.thresholds["dummy"]
    most_of_box: float = implausible_density.thresholds["most_of_box"]


class _Density(NamedTuple):
    """A link whose mass does not go with its size."""

    link: Link
    place: Place
    """Place of its mass."""
    density: float
    """Density [kg/m³]."""
    in_box: bool
    """Whether it is that in the box around the shapes."""
    impossible: bool
    """Whether no material has it."""
    too_heavy: bool
    """Whether the mass is too large, and not too small."""


def _find_densities(
    robot: Robot, bounds: _DensityBounds, *, of_body: bool = True
) -> Iterator[_Density]:
    """Find links whose mass does not go with their size.

    Args:
        robot: The robot.
        bounds: The thresholds.
        of_body: Whether a mass that is right for the rigid body of its link is ignored.
    """
    reach = reaches(robot)
    for link, mass, place in _masses(robot):
        density, in_box = _density(reach.link(link), link, mass)
        if any(shapes_in_millimeters(link)) or _is_incomplete(link):
            continue
        most = bounds.most_of_box if in_box else bounds.most
        if density is None or bounds.least <= density <= most:
            continue
        if in_box and bounds.least_possible <= density < bounds.least:
            continue
        if of_body and _is_right_for_body(reach, link, density, bounds.least, bounds.most_of_box):
            continue
        if density > bounds.most and _is_mark(reach, link, mass, bounds.small):
            continue
        impossible = density > bounds.most_possible or density < bounds.least_possible
        box = reach.link(link)
        if box is None or max(box.size) < bounds.small:
            impossible = False
        if density < bounds.least and mass <= bounds.dummy and _is_fixed(robot, link):
            impossible = False
        yield _Density(link, place, density, in_box, impossible, density > most)


def _of_density(found: _Density, also: str = "") -> Problem:
    link, where = found.link, " in the box around it" if found.in_box else ""
    return Problem(
        link,
        f"link '{link.name}' weighs {link.mass:g} kg and has a density of {found.density:.3g} kg/m³"
        f"{where}; water has 1000{also}",
        at=found.place,
        severity=WARNING if found.impossible else INFO,
        alike=(found.in_box, bool(also)),
        data={"mass": link.mass, "density": found.density, "is_too_large": found.too_heavy},
    )


def _is_mark(reach: Reaches, link: Link, mass: float, small: float) -> bool:
    """Whether a link is smaller than ``small`` [m] and fixed to links that outweigh it by far."""
    box = reach.link(link)
    if box is None or max(box.size) >= small:
        return False
    return sum(other.mass for other, _ in reach.attached(link)[1:]) >= 10 * mass


def _is_fixed(robot: Robot, link: Link) -> bool:
    joint = robot.tree.parent_joint(link.name)
    return joint is not None and joint.is_fixed


def _is_right_for_body(
    reach: Reaches, link: Link, density: float, least: float, most: float
) -> bool:
    """Whether a link of an odd density is a part of a body that is not odd.

    Its mass is that of attached links without one, or most of the mass has a link of its own.
    """
    attached = reach.attached(link)[1:]
    if not attached:
        return False
    if density < least:
        return any(other.mass >= link.mass for other, _ in attached)
    own = reach.link(link)
    box = reach.meant(link, own) if own is not None else None
    volume = math.prod(box.size) if box is not None else 0.0
    return box is not own and (volume <= 0 or link.mass / volume <= most)


def _density(box: Bounds | None, link: Link, mass: float) -> tuple[float | None, bool]:
    """Density [kg/m³] of a link, and whether it is that in the box around its shapes.

    One primitive is taken solid. Several may overlap, so of them the box counts, as for a mesh,
    which makes the density a lower bound. None where it is not known.
    """
    if mass <= 0:
        return None, False
    if len(link.visuals) <= 1 and len(link.collisions) <= 1:
        volumes = [solid_volume(visual.geometry) for visual in link.visuals]
        volumes += [solid_volume(collision.geometry) for collision in link.collisions]
        if volumes and min(volumes) > 0:
            return mass / max(volumes), False
    if box is None:
        return None, True
    volume = math.prod(box.size)
    return (mass / volume if volume > 0 else None), True


def _is_incomplete(link: Link) -> bool:
    """Whether readers reject the inertial of a link, or the robot, which is reported."""
    return link.inertial is not None and link.inertial.inertia is None


def _masses(robot: Robot) -> Iterator[tuple[Link, float, Place]]:
    """Links with a mass that is written and can be read, and its place."""
    for link in robot.links:
        if link.inertial is not None and link.inertial.mass is not None:
            mass = link.inertial.child_xml("mass")
            if mass is not None or link.inertial.xml is None:
                yield link, link.inertial.mass, (mass or link.inertial).attribute_place("value")
