"""A mass compared with those of the other links of the robot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from statistics import median
from typing import NamedTuple

from ...model.elements import Link, Robot
from ..mesh.outlines import reaches
from ..rule import WARNING, Problem, rule
from .tensors import is_zero, tensors

DENSER, DENSEST, FILLED, FITS, OTHERS = 3.0, 1.2, 0.35, 3.0, 4.0
"""The thresholds of :func:`mass_out_of_line`."""

_THINNEST = 0.002
"""Length [m] below which a bounding box is flat, and has no density."""


class _Body(NamedTuple):
    """A link with its mass, compared with a solid box of its size."""

    link: Link
    density: float
    """In the box [kg/m³]."""
    filled: float
    """Its moments of inertia, relative to those of a solid box of its mass."""


@rule(WARNING, effects={"mujoco, pybullet, pinocchio": "take it as written"})
def mass_out_of_line(
    robot: Robot,
    *,
    denser: float = DENSER,
    densest: float = DENSEST,
    filled: float = FILLED,
    fits: float = FITS,
    others: float = OTHERS,
) -> Iterator[Problem]:
    """One mass is several times too large for the robot's other links, and for its own inertia.

    The inertia of a link is proportional to its mass. If only the mass was mistyped, the link is
    denser than the others and its inertia is too small for its mass, by the same factor. Both must
    hold: the density in the bounding box is ``denser`` times the median of the other links and
    ``densest`` times the largest of them; the moments of inertia, relative to a solid box, are less
    than ``filled`` times their median; and the density that the inertia stands for is within a
    factor ``fits`` of theirs. There must be at least ``others`` links to compare with. A mass that
    is wrong together with its inertia looks like another material, and is not reported.
    """
    found = outlier(robot, denser, densest, filled, fits, others)
    if found is None:
        return
    link = found.link
    mass = link.inertial.child_xml("mass") if link.inertial is not None else None
    yield Problem(
        link,
        f"mass of link '{link.name}' is {link.mass:g} kg: {found.denser:.2g} times as dense as the "
        f"other links, while its inertia is that of {found.fitting:.2g} kg; is the mass too large?",
        data={"mass": link.mass, "fitting": found.fitting},
        at=mass.attribute_place("value") if mass is not None else None,
    )


class Outlier(NamedTuple):
    """A link whose mass alone is out of line."""

    link: Link
    denser: float
    """Its density, relative to the median of the other links."""
    fitting: float
    """The mass that its inertia fits, if it is as the others are [kg]."""


def outlier(
    robot: Robot,
    denser: float = DENSER,
    densest: float = DENSEST,
    filled: float = FILLED,
    fits: float = FITS,
    others: float = OTHERS,
) -> Outlier | None:
    """Find the one link of a robot whose mass is several times too large, if there is one.

    The arguments are those of :func:`mass_out_of_line`.
    """
    bodies = list(_bodies(robot))
    if len(bodies) <= others:
        return None
    body = max(bodies, key=lambda one: one.density)
    rest = [one for one in bodies if one is not body]
    usual_density = median(one.density for one in rest)
    usual_filled = median(one.filled for one in rest)
    usual = median(one.density * one.filled for one in rest)
    factor = body.density / usual_density
    if factor < denser or body.density < densest * max(one.density for one in rest):
        return None
    if not 0.3 < usual_filled < 2 or body.filled > filled * usual_filled:
        return None  # the others are placeholders, or its own inertia goes with its mass
    if not 1 / fits < body.density * body.filled / usual < fits:
        return None
    return Outlier(body.link, factor, body.link.mass * body.filled / usual_filled)


def _bodies(robot: Robot) -> Iterator[_Body]:
    """Links whose mass, inertia and size are known, without placeholders."""
    reach = reaches(robot)
    for link, _, six in tensors(robot):
        if link.mass <= 0 or is_zero(six, link.mass) or six[0] == six[3] == six[5]:
            continue
        box = reach.link(link)
        if box is None or min(box.size) <= _THINNEST:
            continue
        solid = link.mass / 12 * sum(length * length for length in box.size)
        moments = (six[0] + six[3] + six[5]) / 2
        if moments > 0:
            yield _Body(link, link.mass / math.prod(box.size), moments / solid)
