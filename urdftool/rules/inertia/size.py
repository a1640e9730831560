"""Compare inertia with the size of the link."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial

from ...mechanics.mass_bounds import ALLOWED, CERTAIN, ROUNDING, check_spread, name_shapes
from ...mechanics.tensor import SymmetricTensor, compute_principal_moments, rotate_tensor
from ...model.attached import find_attached_links, is_fixed_to_world
from ...model.elements import Link, Robot
from ...model.pose import make_pose
from ...source.document import Element
from ..fix import FixContext, Proposal
from ..mesh.link_extents import get_extents
from ..rule import ANY_FORMAT, INFO, UNSAFE, WARNING, Problem, rule
from ..tree.mounted import is_base_of_arm
from .bodies import find_rigid_bodies, find_slight_parts, is_only_sliding
from .corrections import (
    MASS_IN_DOUBT,
    correct_slip,
    has_comment,
    write_inertia_of_shapes,
    write_meant_inertia,
    write_tensor,
)
from .density import find_outliers
from .frame import compute_tensor_about_com, find_exchange, has_mesh
from .identified import is_identified
from .known_size import measure_known_size
from .proposals import describe_remedy, get_recompute_hint, get_remedy_kind
from .solids import compute_solid_moments, describe_solid, is_dummy
from .tensors import SIX, get_tensors, is_accepted, is_positive, is_zero

SIZE_IN_DOUBT = (
    *("mesh-in-millimeters", "mesh-scaled-twice", "mesh-scale-outlier"),
    "non-positive-dimension",
)
_IN_DOUBT = (*SIZE_IN_DOUBT, "singular-inertia", "implausible-density")
_SINGULAR = 1e-9
"""The part of the largest moment that counts as zero. Chosen, no source."""

_CHECKING = "gz, gazebo-classic, mujoco, drake"
_CENTER = ("com-outside-geometry", "inertial-not-at-com-suspect")


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": "take it as written",
    },
    group="robot",
    of_motion=True,
    formats=ANY_FORMAT,
    infos=True,
)
def placeholder_inertia(robot: Robot, *, tiny: float = 0.02) -> Iterator[Problem]:
    """An inertia is the same power of ten about every axis, such as 1 or 1e-3.

    Such a value is a placeholder. 1 kg·m² on a link of 100 g is a radius of gyration of 3 m: the
    arm accelerates like a flywheel and its motors seem too weak. Frames often have a placeholder to
    keep a simulation stable, so these are reported only if the value is too large: links of a few
    millimeters, links without geometry, and links of up to ``tiny`` [m] that are fixed to a
    heavier link. Where most tensors of the robot are rounded to the same number of decimals, as CAD
    programs do, 0.0001 may be the rounded moment of a small link and is not reported. Neither are
    the root of an arm, which is mounted, and links that only slide relative to the world.
    """
    slight = find_slight_parts(robot)
    whole: dict[str, list[Link]] | None = None
    for link, inertial, six in get_tensors(robot):
        if not is_placeholder(link, six) or link.mass < 0 or link.name in slight:
            continue  # negative-mass reports the mass
        if is_base_of_arm(robot, link) or is_only_sliding(robot, link):
            continue
        moment = six[0]
        if is_last_decimal(robot, moment) and _may_round(robot, link, moment):
            continue
        radius = math.sqrt(moment / inertial.mass) if inertial.mass and inertial.mass > 0 else 0.0
        large = radius > (_PLAUSIBLE if moment == 1.0 else 1.0)
        dummy = is_dummy(link)
        if not large:
            if whole is None:
                whole = {
                    one.name: links for links in find_rigid_bodies(robot).values() for one in links
                }
            if dummy or _is_frame(robot, link, whole.get(link.name, [link]), tiny):
                continue
        far = f" ({link.mass:g} kg with a radius of gyration of {radius:.2g} m)" if large else ""
        yield Problem(
            link,
            f"inertia of link '{link.name}' is a placeholder: {moment:g} about every axis{far}"
            f"{'' if dummy else describe_solid(link)}",
            at=inertial.inertia,
            severity=WARNING if large else INFO,
            hint="" if dummy else get_recompute_hint(robot, link),
            group="inertia of {count} links is a placeholder (the same power of ten about every "
            "axis): {names}",
            data={"moment": moment, "is_large": large},
        )


def is_last_decimal(robot: Robot, moment: float) -> bool:
    """Tell whether a moment [kg·m²] is one unit of the last decimal of most tensors of a robot.

    At least three other tensors must use that decimal, which several links with one placeholder
    do not.
    """
    found = robot.memo.get(_list_decimals, lambda: _list_decimals(robot))
    last = [decimals for decimals, _ in found if math.isclose(moment, 10.0**-decimals)]
    using = sum(len({*six[::3], six[5]}) > 1 for decimals, six in found if decimals in last)
    rounded = [decimals for decimals, _ in found if last and decimals <= last[0]]
    return using >= _USING and 2 * len(rounded) > sum(1 for _ in get_tensors(robot))


def _list_decimals(robot: Robot) -> list[tuple[int, Sequence[float]]]:
    """List the tensors that are written with decimals, each with their number."""
    return [
        (decimals, six)
        for _, inertial, six in get_tensors(robot)
        if (decimals := _count_decimals(inertial.inertia.xml if inertial.inertia else None))
        is not None
    ]


_PLAUSIBLE = 0.3
"""Radius of gyration [m] of the trunk of a large robot. Chosen, no source."""
_USING = 3
"""Other tensors that must be rounded to the same decimal. Chosen, no source."""
_ROUNDED = 10.0
"""Factor between a moment of the link's box and one unit of the last decimal. Chosen, no source."""


def _count_decimals(tensor: Element | None) -> int | None:
    """Count the decimals of the components of a tensor; None with an exponent or without text."""
    if tensor is None:
        return None
    texts = [text for name in SIX if (text := tensor.get(name)) is not None]
    if any(set(text.strip()) - set("+-.0123456789") for text in texts):
        return None
    return max((len(text.strip().partition(".")[2]) for text in texts), default=0)


def _may_round(robot: Robot, link: Link, moment: float) -> bool:
    """Tell whether a moment may be that of the link's box, if known, rounded to one unit."""
    box = get_extents(robot).get_link_box(link)
    if box is None:
        return True
    a, b, c = box.size
    largest = link.mass / 12 * (a * a + b * b + c * c)
    return moment / _ROUNDED <= largest <= moment * _ROUNDED


def _is_frame(robot: Robot, link: Link, body: list[Link], tiny: float) -> bool:
    """Tell whether a link is a frame: without geometry, or tiny and part of a heavier body."""
    if not link.visuals and not link.collisions:
        return True
    if not any(other.mass > link.mass for other in body):
        return False
    box = get_extents(robot).get_link_box(link)
    return box is not None and max(box.size) <= tiny


def is_placeholder(link: Link, six: SymmetricTensor) -> bool:
    """Tell whether a tensor is a power of ten times the identity, and not the right one."""
    xx, xy, xz, yy, yz, zz = six
    if not xx == yy == zz > 0 or xy or xz or yz:
        return False
    power = math.log10(xx)
    if abs(power - round(power)) > 1e-9:
        return False
    solid = compute_solid_moments(link)
    return solid is None or not all(0.5 <= moment / xx <= 2 for moment in solid)


@placeholder_inertia.fix(UNSAFE, rests_on=MASS_IN_DOUBT)
def write_inertia(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the inertia of the geometry.

    Excepted are dummies, whose inertia is negligible, and values with a comment that says why they
    were chosen.
    """
    link = context.get_link(problem)
    if is_dummy(link) or has_comment(link):
        return None
    return write_inertia_of_shapes(problem, context)


@rule(
    WARNING,
    effects={
        _CHECKING: "take it as written",
        "pinocchio": "takes it as written",
    },
    of_motion=True,
    group="robot",
    formats=ANY_FORMAT,
    pedantic="meshes, and bodies of less than 10 g, that would have to be less than 2 times as "
    "long, and identified values",
    infos=True,
)
def inertia_exceeds_geometry(
    robot: Robot,
    *,
    allowed: float = ALLOWED,
    rounding: float = ROUNDING,
    certain: float = CERTAIN,
) -> Iterator[Problem]:
    """An inertia is larger than any body of the link's size can have.

    Mass has the largest inertia if it is in two lumps at the ends of the geometry. Usual causes of
    a larger one are g·mm² or kg·mm² in place of kg·m², a mass that is ten times too small, or the
    moment of one axis written for all three. The message gives the factor by which the geometry
    would have to be longer, for any center of mass, and says if the tensor fits with two axes
    exchanged.

    ``allowed`` and ``certain`` are ratios of the variance of the mass along an axis to the largest
    possible one, about the center of mass as written. For a mesh the bounding box counts. Up to
    ``certain`` it is an info for meshes, which may lack heavy parts, and for links that have only
    visual geometry, which may be markers. The geometry of attached links without a mass of their
    own counts too, and is named. ``urdftool inertia robot`` applies the same checks.

    It is an info, and off by default, if two or more links have such a tensor, with all six numbers
    and less than 5 times too long: identification by measured torques gives values that are right
    together, not for each link. The published numbers of Franka's arms are off by default, too, and
    so are a mesh, and a body of a few grams whose inertia is rounded, that would have to be less
    than 2 times as long. Links that only slide relative to the world do not turn.
    """
    found = list(_find_large_inertias(robot, allowed, rounding, certain))
    if sum(_is_like_identified(problem) for problem in found) >= _IDENTIFIED:
        for problem in filter(_is_like_identified, found):
            problem.severity, problem.pedantic = INFO, True
    yield from found


_OF_GRAMS = 0.01
"""Mass [kg] of a body whose moments are mostly rounded to 1e-6 kg·m². Chosen, no source."""

_IDENTIFIED = 2
"""Number of links from which large tensors of a robot may be identified. Chosen, no source."""


def _is_like_identified(problem: Problem) -> bool:
    """Tell whether a tensor is full, and less than 5 times too long for its geometry."""
    return bool(problem.data["is_full"]) and float(problem.data["times"]) < 5


def _find_large_inertias(
    robot: Robot, allowed: float, rounding: float, certain: float
) -> Iterator[Problem]:
    """Find the links whose inertia is larger than their geometry allows."""
    reach = get_extents(robot)
    slight = find_slight_parts(robot)
    for link, inertial, six in get_tensors(robot):
        if link.mass <= 0 or is_placeholder(link, six) or not is_positive(six):
            continue
        if link.name in slight or _slides(robot, link):
            continue
        low, middle, high = compute_principal_moments(six)
        if low + middle < high:
            continue  # physically inconsistent at any size
        pose = make_pose(inertial.origin)
        tensor = rotate_tensor(six, pose.rotation)
        judge = partial(
            check_spread,
            mass=link.mass,
            tensor=tensor,
            rough=has_mesh(link) or not link.collisions,
            allowed=allowed,
            certain=certain,
            rounding=rounding,
        )
        box = reach.get_link_box(link)
        if box is None or judge(box, com=pose.translation) is None:
            continue
        if compute_tensor_about_com(link, inertial, six, box) is not None:
            continue
        box = reach.get_inertial_box(link, box)
        if box is None:
            continue
        attached = [other.name for other, _ in reach.get_counted(link)]
        shapes = name_shapes(attached)
        found = judge(box, com=pose.translation, shapes=shapes)
        if found is not None:
            fits = judge(box, com=box.center) is None
            at_com = partial(judge, box, com=pose.translation)
            exchanged = "" if fits else find_exchange(tensor, at_com)
            so = f"; it fits with the axes {exchanged} exchanged" if exchanged else ""
            is_own = _has_own_size(robot, link, found.certain)
            remedy = describe_remedy(link, inertial, six) if is_own else ""
            kind = get_remedy_kind(link, inertial, six) if is_own else ""
            yield Problem(
                link,
                f"inertia of link '{link.name}' {found.sentence}{so or remedy}",
                at=inertial.inertia,
                severity=None if found.certain or exchanged else INFO,
                caused_by=(*_IN_DOUBT, *(_CENTER if fits else ())),
                effects=_select_readers(six),
                alike=(bool(attached), so or kind),
                data={
                    "certain": found.certain,
                    "times": found.amount,
                    "is_full": _is_full(tensor),
                    "exchanged": exchanged,
                },
                pedantic=is_identified(link)
                or (found.amount < 2 and link.mass < _OF_GRAMS)
                or (not found.certain and found.amount < 2),
            )


def _slides(robot: Robot, link: Link) -> bool:
    """Tell whether a link slides relative to the world, and does not turn."""
    return is_only_sliding(robot, link) and not is_fixed_to_world(robot, link)


def _is_full(tensor: SymmetricTensor) -> bool:
    """Tell whether no number of a tensor about the axes of the link is zero."""
    return min(map(abs, tensor)) > _SINGULAR * max(map(abs, tensor))


def _select_readers(six: SymmetricTensor) -> list[str]:
    """Get the keys of effects for the readers that take a tensor as written."""
    return [*[_CHECKING] * is_accepted(six), "pinocchio"]


def _has_own_size(robot: Robot, link: Link, certain: bool) -> bool:
    """Tell whether an inertia can be proposed for a link whose inertia exceeds its geometry.

    Returns:
        False if the size includes that of attached links, or comes from visuals alone, which may
        differ from the body.
    """
    return not get_extents(robot).get_counted(link) and (certain or bool(link.collisions))


@inertia_exceeds_geometry.fix(UNSAFE, rests_on=MASS_IN_DOUBT)
def write_inertia_that_fits(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the intended inertia, or that of the geometry if it certainly is the body."""
    link, certain = context.get_link(problem), problem.data["certain"]
    inertial = link.inertial
    if not _has_own_size(context.robot, link, certain):
        return None
    if not certain and inertial is not None and inertial.inertia is not None:
        return correct_slip(link, inertial, inertial.inertia)
    return write_meant_inertia(problem, context)


@rule(
    INFO,
    effects={
        _CHECKING: "take it as written",
        "pinocchio": "takes it as written",
    },
    of_motion=True,
    caused_by=(
        *(*SIZE_IN_DOUBT, "implausible-density", "implausible-mass"),
        *("inertia-triangle-inequality", "singular-inertia"),
    ),
    formats=ANY_FORMAT,
    infos=True,
)
def inertia_below_geometry(
    robot: Robot, *, least: float = 0.12, part: float = 0.1
) -> Iterator[Problem]:
    """An inertia is far smaller than that of a body of the link's size.

    Compared is the inertia of a solid box of the link's mass and size. Heavy material in the
    middle, such as steel inside of plastic, halves it. An eighth means that the mass is ten times
    too large, that the inertia lost a power of ten, or that the geometry is larger than the body.
    ``least`` is the smallest tolerated part of the box's inertia. Links with less than ``part`` of
    the mass of their rigid body change little, and are skipped, as is the root of an arm, which is
    mounted.
    """
    reach = get_extents(robot)
    heavy = {outlier.link.name for outlier in find_outliers(robot)}
    for link, inertial, six in get_tensors(robot):
        mass = link.mass
        if mass <= 0 or is_zero(six, mass) or not is_positive(six):
            continue
        if link.name in heavy:
            continue  # mass-outlier reports it
        if mass < part * sum(other.mass for other, _ in find_attached_links(robot, link)):
            continue
        if is_base_of_arm(robot, link):
            continue
        box = reach.get_link_box(link)
        if box is None:
            continue
        if is_placeholder(link, six):
            continue
        solid = mass / 12 * sum(length * length for length in box.size)
        written = sum(six[i] for i in (0, 3, 5)) / 2
        if written < least * solid:
            x, y, z = (f"{length:.3g}" for length in box.size)
            yield Problem(
                link,
                f"inertia of link '{link.name}' is {written / solid:.2g} times that of a solid box "
                f"of its mass ({mass:g} kg) and size ({x} × {y} × {z} m); check mass and inertia "
                "for a wrong power of ten",
                at=inertial.inertia,
                effects=_select_readers(six),
                data={"part": written / solid, "size": list(box.size)},
            )


@rule(
    WARNING,
    effects={
        _CHECKING: "take it as written",
        "pinocchio": "takes it as written",
    },
    of_motion=True,
    group="robot",
    caused_by=("inertia-triangle-inequality", "inertia-not-positive-definite"),
    formats=ANY_FORMAT,
)
def radius_of_gyration(
    robot: Robot,
    *,
    largest: float = 1.0,
    smallest: float = 1e-3,
    heavy: float = 0.01,
) -> Iterator[Problem]:
    """A link's inertia does not fit its mass.

    The radius of gyration is the square root of the largest moment of inertia divided by the mass:
    a thin ring of that radius has the same moment about its axis. Above 1 m it exceeds most robots,
    below 1 mm it is that of a pinhead. The usual cause is kg·mm² in place of kg·m². A link is not
    reported whose known shapes and joints are as far apart as the inertia requires, as those of a
    car, nor is the root of an arm. Links of known size are checked by ``inertia-exceeds-geometry``;
    tensors that are zero or negative about an axis by other rules.
    """
    reach = get_extents(robot)
    slight = find_slight_parts(robot)
    for link, inertial, six in get_tensors(robot):
        mass = link.mass
        if mass <= 0 or is_zero(six, mass) or is_placeholder(link, six):
            continue
        if link.name in slight or is_base_of_arm(robot, link):
            continue
        if inertial.mass is None or reach.get_link_box(link) is not None:
            continue
        low, _, high = compute_principal_moments(six)
        if high <= 0 or low <= _SINGULAR * high:
            continue
        radius = math.sqrt(high / mass)
        around = reach.get_body_box(link)
        if around is not None and radius <= math.dist(*around):
            continue  # the inertia is that of the whole body
        if radius <= measure_known_size(robot, link) / 2:
            continue
        data: dict[str, object] = {"radius": radius}
        if radius > largest:
            remedy = ""
            if _may_be_kg_mm2(radius):
                remedy = "; if it is in kg·mm², divide it by 1e6"
                data["inertia"] = [value * 1e-6 for value in six]
        elif radius < smallest and mass > heavy:
            remedy = "; check the unit (kg·m²)"
        else:
            continue
        yield Problem(
            link,
            f"radius of gyration of link '{link.name}' is {radius:.2g} m: largest moment of "
            f"inertia {high:.4g} kg·m², mass {mass:g} kg{remedy}",
            at=inertial.inertia,
            effects=_select_readers(six),
            alike=remedy,
            data=data,
        )


def _may_be_kg_mm2(radius: float) -> bool:
    """Tell whether a radius of gyration [m] becomes plausible if the inertia is in kg·mm²."""
    return _OF_A_LINK[0] < radius / 1000 <= _OF_A_LINK[1]


_OF_A_LINK = (0.01, 1.0)
"""Plausible radii of gyration of links [m]. Chosen, no source."""


@radius_of_gyration.fix(UNSAFE)
def write_inertia_in_kg_m2(problem: Problem, context: FixContext) -> Proposal | None:
    """Convert the inertia from kg·mm² to kg·m²."""
    link = context.get_link(problem)
    if "inertia" not in problem.data:
        return None
    xx, xy, xz, yy, yz, zz = problem.data["inertia"]
    if is_zero((xx, xy, xz, yy, yz, zz), link.mass):
        return None
    return write_tensor(link, (xx, xy, xz, yy, yz, zz), "divide it by 1e6")
