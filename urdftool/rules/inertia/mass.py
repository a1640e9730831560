"""Check masses of links and rigid bodies."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...model.attached import find_attached_links, is_fixed_to_world
from ...model.bounds import Bounds, compute_size
from ...model.elements import Collision, Link, Robot, Visual
from ...model.millimeters import find_shapes_in_millimeters
from ...source.location import Place
from ..fix import remove_sign
from ..mesh.link_extents import LinkExtents, get_extents
from ..rule import ANY_FORMAT, ERROR, GAZEBO, INFO, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from ..tree.mounted import is_mobile
from ..words import join_some
from .bodies import compute_mass, find_massless_pairs, find_rigid_bodies
from .density import GOLD
from .known_size import measure_known_size
from .light_body import find_light_body
from .markers import is_anchor, is_marker
from .massless import report_holders
from .solids import compute_volume, is_helper
from .tensors import has_written_inertial

_AS_PART = ("gz, gazebo-classic, pinocchio (part)", "mujoco (part)", "drake (part)")
_HELD = ("drake (part)",)
_AS_ROOT = ("gz, gazebo-classic (root)", "pybullet (root)")


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic": "omit the link and its descendants (sdformat 12.3)",
        "gz, gazebo-classic (root)": (
            "load nothing: a model must have at least one link (sdformat 12.3)"
        ),
        "gz, gazebo-classic (both)": "reject the robot: pose values must be finite (sdformat 12.3)",
        "gz, gazebo-classic (holds)": "omit the links whose joints are on it (sdformat 12.3)",
        "gz, gazebo-classic, pinocchio (part)": "add the inertia to the body that it is fixed to",
        "mujoco": "rejects the file: mass of moving bodies must be positive",
        "mujoco (part)": "ignores the inertia",
        "drake (part)": "gives the link 1 kg, with a warning",
        "pybullet (root)": "fixes the root link to the world",
    },
    group="robot",
    formats=ANY_FORMAT,
)
def zero_mass(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A rigid body has mass 0, or a link of mass 0 has an inertia.

    A moving body must have a mass. Gazebo removes one without mass and its descendants, MuJoCo
    rejects the file, PyBullet never moves it. The mass of the whole rigid body counts: a link of
    mass 0 that is fixed to a link with mass is merged into it and keeps its geometry. A mass that
    is less than that of air of the link's size is not that of the body: a trunk of mass 0 with a
    sensor of 1 g.

    A root of mass 0 makes a model static in PyBullet, which is intended for the frame of a door or
    the base of an arm; Gazebo rejects it. It is an info for a robot that drives, walks or flies by
    the names of its links and joints. If the mass is 0 and the
    inertia is not, Gazebo and pinocchio add the inertia to the body, and Drake gives the link 1 kg.
    Two links of mass 0 that are fixed to each other break Gazebo's reader, which divides by the sum
    of their masses. It omits links whose joint is on a link of mass 0 that is fixed to another one.
    """
    yield from report_holders(robot, targets, is_written=True)
    zero = [link for link in robot.links if link.inertial and link.inertial.mass == 0.0]
    if not zero:
        return
    yield from _report_massless_pairs(robot, targets)
    body = {link.name: links for links in find_rigid_bodies(robot).values() for link in links}
    for link in zero:
        if link.name == "world" or link.inertial is None:
            continue
        links = body.get(link.name, [link])
        joint = robot.tree.get_parent_joint(links[0].name)
        mass = link.inertial.find_child_xml("mass")
        at = mass.locate_attribute("value") if mass is not None else None
        if light := find_light_body(robot, link, links):
            yield Problem(
                link,
                f"mass of link '{link.name}' is 0, and the links fixed to it {light.describe()}; "
                "write its mass",
                at=at,
                effects=() if joint is not None else _AS_ROOT[1:],
                alike="light",
            )
            continue
        if compute_mass(links) > 0:
            tensor = link.inertial.inertia
            if tensor is not None and any(tensor.six):
                held = is_fixed_to_world(robot, link)
                leads = link is links[0]  # MuJoCo adds the inertia of the link that the joint moves
                yield Problem(
                    link,
                    f"link '{link.name}' has mass 0 but a nonzero inertia; write its mass, or set "
                    "the inertia to zero",
                    at=at,
                    severity=INFO if held else None,
                    effects=_HELD if held else _AS_PART[:: 2 if leads else 1],
                    alike=("part", held, leads),
                )
            continue
        if link is not next(one for one in links if one in zero):
            continue  # one finding per body
        moved = joint is not None and not joint.is_fixed
        if robot.format != "urdf":
            if moved or (joint is None and (robot.base is None or robot.base.is_free)):
                text = f"mass of link '{link.name}' is 0; a moving body must have a mass. Write it"
                yield Problem(link, text, at=link.inertial, severity=ERROR, alike="moves")
            continue
        if not targets.isdisjoint(GAZEBO):
            case, severity = "removed", ERROR
            so = "Gazebo removes the link and everything attached to it"
        elif moved and "mujoco" in targets:
            case, severity, so = "rejected", ERROR, "MuJoCo rejects the file"
        elif moved:
            case, severity = "moves", ERROR if link.collisions else WARNING
            so = "a moving body must have a mass"
        elif robot.moving_joints and targets != {"pybullet"}:
            if joint is None and not is_mobile(robot):
                continue  # the base of a mounted robot
            case, severity = "root", INFO
            so = "PyBullet fixes it to the world, and Gazebo loads nothing"
            if joint is not None:
                case, so = "removed", "Gazebo removes the link and everything attached to it"
        else:
            continue
        keys = {"gz, gazebo-classic", *(("mujoco",) if moved else ())}
        remedy = "Keep it if PyBullet is to fix it; else write" if case == "root" else "Write"
        yield Problem(
            link,
            f"mass of link '{link.name}' is 0; {so}. {remedy} its mass",
            at=at,
            severity=severity,
            effects=_AS_ROOT if joint is None else keys,
            alike=case,
        )


@zero_mass.full
def report_every_zero_mass(robot: Robot) -> Iterator[Problem]:
    """Report each link with mass 0, even if it is part of a body with a mass.

    A part without inertia is harmless, and so is a body on no moving joint.
    """
    for link, value, place in _get_masses(robot):
        if value != 0.0 or link.name == "world" or link.inertial is None:
            continue
        members = [one for one, _ in find_attached_links(robot, link)]
        tensor, what = link.inertial.inertia, "; write its mass"
        if compute_mass(members) > 0:
            is_harmless = tensor is None or not any(tensor.six)
            what = "; the links that it is fixed to have a mass"
            if not is_harmless:
                what = " but its inertia is not; write its mass, or set the inertia to zero"
        else:
            joints = [robot.tree.get_parent_joint(one.name) for one in members]
            is_harmless = all(joint is None or joint.is_fixed for joint in joints)
            if is_harmless:
                what = "; PyBullet fixes it to the world, and Gazebo removes it"
        yield Problem(
            link,
            f"mass of link '{link.name}' is 0{what}",
            at=place,
            data={"is_harmless": is_harmless},
        )


def _report_massless_pairs(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    for parent, link in find_massless_pairs(robot):
        if link.inertial is None:
            continue
        yield Problem(
            link,
            f"links '{parent.name}' and '{link.name}' are fixed to each other and have mass 0; "
            f"sdformat 12.3 rejects the robot. Write a mass of 1e-5 kg for '{link.name}'",
            at=link.inertial,
            severity=INFO if targets.isdisjoint(GAZEBO) else ERROR,
            group="{count} links of mass 0 are fixed to links of mass 0; sdformat 12.3 rejects the "
            "robot. Write a mass of 1e-5 kg for each: {names}",
            effects=("gz, gazebo-classic (both)",),
            alike="pair",
        )


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 18)",
        "mujoco": "rejects the file",
        "mujoco (part)": "ignores the mass",
        "pybullet, urdfdom, pinocchio": "accept it without a message",
        "drake": "warns, and uses another inertia",
        "newton": "warns, and takes 0 kg",
    },
    formats=ANY_FORMAT,
)
def negative_mass(robot: Robot) -> Iterator[Problem]:
    """A link's mass is negative.

    The link accelerates against the force. Gazebo and MuJoCo reject it, PyBullet simulates it.
    MuJoCo ignores the mass of a link that is fixed to others with mass, or to the world.
    """
    for link, mass, place in _get_masses(robot):
        if mass < 0:
            yield Problem(
                link,
                f"mass of link '{link.name}' is negative ({mass:g} kg); write {-mass:g}",
                at=place,
                data={"mass": mass},
                effects=(*_select_readers_of_negative(robot, link), *_NEGATIVE),
            )


_NEGATIVE = ("pybullet, urdfdom, pinocchio", "drake", "newton")


def _select_readers_of_negative(robot: Robot, link: Link) -> list[str]:
    """Get the keys of effects of Gazebo and MuJoCo, which depend on the links that are attached."""
    members = [one for one, _ in find_attached_links(robot, link)]
    joints = [robot.tree.get_parent_joint(one.name) for one in members]
    is_alone = not any(one.mass > 0 for one in members)
    moves = any(joint is not None and not joint.is_fixed for joint in joints)
    return ["gz, gazebo-classic"] * is_alone + ["mujoco" if is_alone and moves else "mujoco (part)"]


negative_mass.fix(UNSAFE)(remove_sign)


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "take it as written",
    },
    of_motion=True,
    group="robot",
    formats=URDF_AND_SDF,
    infos=True,
)
def implausible_mass(
    robot: Robot, *, heaviest: float = 1000.0, lightest: float = 1e-5
) -> Iterator[Problem]:
    """A mass is above ``heaviest`` [kg] or below ``lightest`` [kg].

    Masses are in kilograms; a mass in grams makes the link a thousand times too heavy. The limits
    are one metric ton and 10 mg. A link is not too heavy if its known shapes and its joints are as
    far apart as the edge of a cube of water of its mass, as those of a car. Frames without geometry
    may be lighter, because simulators require a mass even for them, and so may stickers on links of
    ten times their mass.
    """
    reach = get_extents(robot)
    for link, mass, place in _get_masses(robot):
        if (
            not lightest <= mass <= heaviest
            and _compute_density(reach.get_link_box(link), link, mass)[0]
        ):
            continue  # implausible-density reports it more precisely
        if mass > heaviest:
            size = measure_known_size(robot, link)
            if mass < _WATER * size * size * size:  # a power would overflow
                continue  # a vehicle
            what = f"{mass:g} kg; if the unit is grams, write {mass / 1000:g}"
        elif 0 < mass < lightest and (link.visuals or link.collisions):
            if sum(other.mass for other, _ in reach.get_attached(link)[1:]) >= 10 * mass:
                continue  # a sticker
            what = f"{mass:g} kg, less than {lightest * 1e6:g} mg; check the unit (kg)"
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
        *("mesh-in-millimeters", "mesh-scaled-twice", "mesh-scale-outlier"),
        *("collision-much-larger-than-visual", "mass-outlier"),
    ),
    formats=ANY_FORMAT,
    pedantic="light boxes of 1 × 1 × 1 m, which code scales",
)
def implausible_density(
    robot: Robot,
    *,
    least: float = 5.0,
    most: float = 12000.0,
    least_possible: float = 1.0,
    most_possible: float = GOLD,
    small: float = 0.02,
    marker: float = 0.01,
    dummy: float = 1e-3,
    most_of_box: float = 8000.0,
    together: float = 6,
) -> Iterator[Problem]:
    """A link's density is implausible: its mass does not fit its size.

    Usual materials have 5 kg/m³ (``least``, foam) to 12,000 kg/m³ (``most``, lead); none in
    robots is denser than 19,300 kg/m³ (``most_possible``, tungsten). Usually a unit
    is wrong: grams, or millimeters.

    For a mesh or several shapes, the density in their bounding box counts: a body of steel has at
    most ``most_of_box``, and air about ``least_possible``. It is only an info if a material could
    have the density, for links smaller than ``small`` [m], which mostly mark frames, and for links
    of up to ``dummy`` [kg] that are fixed to others, as sensor frames are for Gazebo. Not reported
    as too heavy are links of at most ``marker`` [m] that are not the root, whose shape marks a
    place. Not reported are links named fake, dummy, marker or virtual of at most 1 cm, and a root
    whose mass is a power of ten of at least 100 kg with the inertia of that mass: a stand. Small
    links that are fixed to links of ten times their mass are skipped. More than ``together`` infos
    are reported as one finding.
    """
    bounds = _DensityBounds(
        least, most, least_possible, most_possible, small, marker, dummy, most_of_box
    )
    found = list(_find_densities(robot, bounds))
    yield from (_report_density(one) for one in found if one.impossible)
    remarks = [one for one in found if not one.impossible]
    also = ""
    if len(remarks) > together:
        names = [f"'{one.link.name}' {one.density:.3g}" for one in remarks[1:]]
        also = f"; also implausible [kg/m³]: {join_some(names, 'links')}"
        del remarks[1:]
    yield from (_report_density(one, also) for one in remarks)


@implausible_density.full
def report_every_implausible_density(robot: Robot) -> Iterator[Problem]:
    """Report each link whose mass does not fit its own size, without a limit on their number."""
    return map(_report_density, _find_densities(robot, _DensityBounds(), of_body=False))


_WATER = 1000.0
"""Density of water [kg/m³], which is about 1 kg in a liter."""


class _DensityBounds(NamedTuple):
    """Thresholds of :func:`implausible_density`, without ``together``."""

    least: float = implausible_density.thresholds["least"]
    most: float = implausible_density.thresholds["most"]
    least_possible: float = implausible_density.thresholds["least_possible"]
    most_possible: float = implausible_density.thresholds["most_possible"]
    small: float = implausible_density.thresholds["small"]
    marker: float = implausible_density.thresholds["marker"]
    dummy: float = implausible_density.thresholds["dummy"]
    most_of_box: float = implausible_density.thresholds["most_of_box"]


class _Density(NamedTuple):
    """A link whose mass does not fit its size."""

    link: Link
    place: Place
    """Place of its mass."""
    density: float
    """Density [kg/m³]."""
    in_box: bool
    """Whether the volume is that of the bounding box."""
    impossible: bool
    """Whether no material has this density."""
    too_heavy: bool
    """Whether the mass is too large; otherwise it is too small."""


def _find_densities(
    robot: Robot, bounds: _DensityBounds, *, of_body: bool = True
) -> Iterator[_Density]:
    """Find links whose mass does not fit their size.

    Args:
        robot: The robot.
        bounds: The thresholds.
        of_body: Whether to ignore a mass that is plausible for the rigid body of its link.
    """
    reach = get_extents(robot)
    for link, mass, place in _get_masses(robot):
        if robot.format != "urdf" and not has_written_inertial(robot, link):
            continue  # a default of SDF, or the density of the geoms of MJCF
        density, in_box = _compute_density(reach.get_link_box(link), link, mass)
        if any(find_shapes_in_millimeters(link)) or _is_incomplete(link):
            continue
        if is_helper(link) or is_anchor(robot, link):
            continue
        most = bounds.most_of_box if in_box else bounds.most
        if density is None or bounds.least <= density <= most:
            continue
        if in_box and bounds.least_possible <= density < bounds.least:
            continue
        if of_body and _is_plausible_in_body(
            reach, link, density, bounds.least, bounds.most_of_box
        ):
            continue
        if density > most and is_marker(robot, link, mass, bounds.small, bounds.marker):
            continue
        impossible = density > bounds.most_possible or density < bounds.least_possible
        box = reach.get_link_box(link)
        if box is None or max(box.size) < bounds.small:
            impossible = False
        if density < bounds.least and mass <= bounds.dummy and _is_fixed(robot, link):
            impossible = False
        yield _Density(link, place, density, in_box, impossible, density > most)


def _report_density(found: _Density, also: str = "") -> Problem:
    link, where = found.link, " in its bounding box" if found.in_box else ""
    return Problem(
        link,
        f"density of link '{link.name}' is {found.density:.3g} kg/m³{where} (mass {link.mass:g} "
        f"kg), but water has 1000; check its mass and size{also}",
        at=found.place,
        severity=WARNING if found.impossible else INFO,
        alike=(found.in_box, bool(also)),
        pedantic=not found.too_heavy and _is_unit_box(link),
        data={"mass": link.mass, "density": found.density, "is_too_large": found.too_heavy},
    )


def _is_unit_box(link: Link) -> bool:
    """Tell whether each shape of a link is a box of 1 m, which code scales when it loads it."""
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    return all(compute_size(shape.geometry) == (1.0, 1.0, 1.0) for shape in shapes)


def _is_fixed(robot: Robot, link: Link) -> bool:
    joint = robot.tree.get_parent_joint(link.name)
    return joint is not None and joint.is_fixed


def _is_plausible_in_body(
    reach: LinkExtents, link: Link, density: float, least: float, most: float
) -> bool:
    """Tell whether a link of implausible density is part of a body with a plausible one.

    Either its mass includes that of attached links without one, or another link of the body has
    most of the mass.
    """
    attached = reach.get_attached(link)[1:]
    if not attached:
        return False
    if density < least:
        return any(other.mass >= link.mass for other, _ in attached)
    own = box = reach.get_link_box(link)
    if own is None or box is None:
        return False
    for other, at in reach.get_counted(link):
        more = reach.get_body_box(link, "all", [(other, at)])
        if more is not None:
            box = box.join(more)
        elif not other.mass:
            return True  # its unknown geometry may have the mass
    volume = math.prod(box.size)
    return box is not own and (volume <= 0 or link.mass / volume <= most)


def _compute_density(box: Bounds | None, link: Link, mass: float) -> tuple[float | None, bool]:
    """Compute the density [kg/m³] of a link, and whether it is that in its bounding box.

    A single primitive counts as solid. For a mesh, and for several shapes, which may overlap, the
    bounding box counts, which makes the density a lower bound.

    Returns:
        None as the density if it is unknown.
    """
    if mass <= 0:
        return None, False
    if len(link.visuals) <= 1 and len(link.collisions) <= 1:
        volumes = [compute_volume(visual.geometry) for visual in link.visuals]
        volumes += [compute_volume(collision.geometry) for collision in link.collisions]
        if volumes and min(volumes) > 0:
            return mass / max(volumes), False
    if box is None:
        return None, True
    volume = math.prod(box.size)
    return (mass / volume if volume > 0 else None), True


def _is_incomplete(link: Link) -> bool:
    """Tell whether readers reject the inertial of a link, which another rule reports."""
    return link.inertial is not None and link.inertial.inertia is None


def _get_masses(robot: Robot) -> Iterator[tuple[Link, float, Place]]:
    """Yield links with a readable mass, each with the mass [kg] and its location."""
    for link in robot.links:
        if link.inertial is not None and link.inertial.mass is not None:
            mass = link.inertial.find_child_xml("mass")
            if mass is not None or link.inertial.xml is None:
                yield link, link.inertial.mass, (mass or link.inertial).locate_attribute("value")
