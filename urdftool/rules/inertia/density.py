"""Compare the mass of a link with the masses of the robot's other links."""

from __future__ import annotations

import math
from collections.abc import Iterator
from statistics import median
from typing import NamedTuple

from ...model.elements import Link, Robot
from ..mesh.link_extents import get_extents
from ..rule import ANY_FORMAT, WARNING, Problem, rule
from .tensors import get_tensors, is_zero

DENSITY_RATIO, MAX_DENSITY_RATIO, MOMENT_RATIO, FIT_FACTOR, MIN_LINKS = 3.0, 1.2, 0.35, 3.0, 4.0
"""Thresholds of :func:`mass_outlier`. Chosen, no source."""

_THINNEST = 0.002
"""Length [m] below which a bounding box counts as flat, without a density."""

GOLD = 19300.0
"""Density of gold [kg/m³], above which that of a link is impossible."""


ALUMINUM = 2700.0
"""Density of aluminum [kg/m³], the material of most links. Chosen as the limit for a root."""


class _Body(NamedTuple):
    """A link, compared with a solid box of its mass and size."""

    link: Link
    density: float
    """Mass by volume of the bounding box [kg/m³]."""
    filled: float
    """Its moments of inertia, relative to those of the solid box."""


@rule(
    WARNING,
    effects={"mujoco, pybullet, pinocchio": "take it as written"},
    formats=ANY_FORMAT,
)
def mass_outlier(
    robot: Robot,
    *,
    density_ratio: float = DENSITY_RATIO,
    max_density_ratio: float = MAX_DENSITY_RATIO,
    moment_ratio: float = MOMENT_RATIO,
    fit_factor: float = FIT_FACTOR,
    min_links: float = MIN_LINKS,
) -> Iterator[Problem]:
    """One mass is several times too large, compared with the other links and its own inertia.

    The inertia of a link is proportional to its mass. If only the mass was mistyped, the link is
    denser than the others and its inertia is too small for its mass, by the same factor. A mass
    that is wrong together with its inertia looks like another material, and is not reported.

    All of this must hold: the density in the bounding box is at least ``density_ratio`` times the
    median of the other links and ``max_density_ratio`` times their maximum; the moments of inertia,
    relative to a solid box, are less than ``moment_ratio`` times the median of the others; the
    density that fits the inertia is within a factor ``fit_factor`` of the others; and there are
    more than ``min_links`` links. A root that is no denser than aluminum is not reported: motor and
    electronics are in it, and thin fingers are light in their bounding box.
    """
    for link, denser, fitting in find_outliers(
        robot, density_ratio, max_density_ratio, moment_ratio, fit_factor, min_links
    ):
        mass = link.inertial.find_child_xml("mass") if link.inertial is not None else None
        if _is_solid_root(robot, link):
            continue
        yield Problem(
            link,
            f"mass of link '{link.name}' ({link.mass:g} kg) is {denser:.2g} times too large by "
            f"the density of other links, and its inertia fits {fitting:.2g} kg; check the mass",
            data={"mass": link.mass, "fitting": fitting},
            at=mass.locate_attribute("value") if mass is not None else None,
        )


def _is_solid_root(robot: Robot, link: Link) -> bool:
    """Tell whether a link is part of the root body, and no denser than aluminum."""
    reach = get_extents(robot)
    joints = [robot.tree.get_parent_joint(one.name) for one, _ in reach.get_attached(link)]
    box = reach.get_link_box(link)
    if box is None or not any(joint is None or joint.parent == "world" for joint in joints):
        return False
    return link.mass <= ALUMINUM * math.prod(box.size)


class Outlier(NamedTuple):
    """A link whose mass alone does not fit the robot."""

    link: Link
    denser: float
    """Its density, relative to the median of the other links."""
    fitting: float
    """The mass that fits its inertia, at the usual ratio of the other links [kg]."""


def find_outliers(
    robot: Robot,
    density_ratio: float = DENSITY_RATIO,
    max_density_ratio: float = MAX_DENSITY_RATIO,
    moment_ratio: float = MOMENT_RATIO,
    fit_factor: float = FIT_FACTOR,
    min_links: float = MIN_LINKS,
) -> Iterator[Outlier]:
    """Find the densest link of a robot whose mass is several times too large.

    Then links denser than gold are left out, whose masses cannot be compared with, and the next
    one is judged.

    The arguments are those of :func:`mass_outlier`.
    """
    bodies = list(_get_bodies(robot))
    ratios = (density_ratio, max_density_ratio, moment_ratio, fit_factor, min_links)
    possible = [one for one in bodies if one.density <= GOLD]
    for some in (bodies, possible) if len(possible) < len(bodies) else (bodies,):
        found = _judge_densest(some, *ratios)
        if found is not None:
            yield found


def _judge_densest(
    bodies: list[_Body],
    density_ratio: float,
    max_density_ratio: float,
    moment_ratio: float,
    fit_factor: float,
    min_links: float,
) -> Outlier | None:
    """Return the densest body if its mass alone does not fit the others."""
    if len(bodies) <= min_links:
        return None
    body = max(bodies, key=lambda one: one.density)
    rest = [one for one in bodies if one is not body]
    usual_density = median(one.density for one in rest)
    usual_filled = median(one.filled for one in rest)
    usual = median(one.density * one.filled for one in rest)
    factor = body.density / usual_density
    if factor < density_ratio or body.density < max_density_ratio * max(
        one.density for one in rest
    ):
        return None
    if not 0.3 < usual_filled < 2 or body.filled > moment_ratio * usual_filled:
        return None  # the others are placeholders, or the inertia fits the mass
    if not 1 / fit_factor < body.density * body.filled / usual < fit_factor:
        return None
    return Outlier(body.link, factor, body.link.mass * body.filled / usual_filled)


def _get_bodies(robot: Robot) -> Iterator[_Body]:
    """Get links with known mass, inertia and size; placeholders are skipped."""
    reach = get_extents(robot)
    for link, _, six in get_tensors(robot):
        if link.mass <= 0 or is_zero(six, link.mass) or six[0] == six[3] == six[5]:
            continue
        box = reach.get_link_box(link)
        if box is None or min(box.size) <= _THINNEST:
            continue
        solid = link.mass / 12 * sum(length * length for length in box.size)
        moments = (six[0] + six[3] + six[5]) / 2
        if moments > 0:
            yield _Body(link, link.mass / math.prod(box.size), moments / solid)
