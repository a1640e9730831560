"""Mass, center of mass and inertia of each body, in values that the simulators keep.

Newton replaces a whole tensor if one principal moment is below zero, and raises moments that are
too small or break the triangle inequality (``finalize``). PhysX and Newton compute the mass of a
body whose mass is zero. The values here are outside of all these cases.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...finding import Finding
from ...geometry.link_extent import compute_box_size
from ...mechanics.repair import find_nearest_consistent
from ...mechanics.spatial_inertia import SpatialInertia, link_inertia
from ...mechanics.tensor import (
    ROUNDING,
    WRITTEN_ROUNDING,
    SymmetricTensor,
    compute_principal_axes,
    format_moments_text,
    from_matrix,
    get_diagonal,
    get_excess,
    make_diagonal_tensor,
)
from ...model.elements import ZERO, Link
from ...model.pose import IDENTITY
from ..common.inertia_repair import repair_tensor
from ..common.inertia_surplus import is_consistent, move_surplus, report_move
from ..defects import make_defect
from ..written import Written
from .bodies import Bodies, has_mass
from .options import Options

Array = npt.NDArray[np.float64]

TINY_MASS = 1e-6
"""Mass [kg] of a moving body without mass. Chosen, no source."""

TINY_MOMENT = 1e-9
"""Principal moments [kg·m²] of a moving body without mass. Chosen, no source."""

_FLOOR, _RELATIVE_FLOOR = 1.1e-10, 1.1e-6
"""Smallest principal moment [kg·m²], and relative to the largest; Newton's limits plus 10 %."""

_MARGIN = 1e-7
"""Margin of the triangle inequality relative to the largest moment; 32-bit floats round."""

_REPORTED = 1e-6
"""Change relative to the largest moment above which it is reported. Chosen, no source."""


@dataclass(frozen=True)
class BodyInertia:
    """Mass properties of a body as they are written.

    Attributes:
        body: Mass, center of mass and tensor in the frame of the link.
        moments: Principal moments [kg·m²], shape (3,).
        axes: Their axes as columns of a rotation matrix in the frame of the link.
    """

    body: SpatialInertia
    moments: Array
    axes: Array


def make_inertias(
    bodies: Bodies, options: Options, written: Written
) -> tuple[dict[str, BodyInertia], list[Finding]]:
    """Compute the mass properties of every body, and the defects that prevent an export."""
    found: dict[str, BodyInertia] = {}
    wrong: list[Finding] = []
    read = _read(bodies, written)
    static = [] if bodies.free else bodies.find_rigid_groups().get(bodies.base, [])
    for link in bodies.links:
        if has_mass(link):
            is_static = link.name in static
            body, defects = _repair(bodies, link, read[link.name], options, written, is_static)
            wrong += defects
        else:
            body = _give_mass(bodies, link, written)
        found[link.name] = _accept(link, body, written)
    for link in bodies.frames:
        if any(link_inertia(link).tensor):
            written.report_loss(
                "inertia-without-mass",
                f"inertia of link '{link.name}', which has no mass, is dropped: it is a frame",
                link.place,
                kind="link",
                name=link.name,
            )
    return found, wrong


def _read(bodies: Bodies, written: Written) -> dict[str, SpatialInertia]:
    """Return the mass properties of bodies; surpluses moved inside of rigid bodies."""
    read = {link.name: link_inertia(link) for link in bodies.links if has_mass(link)}
    for top, members in bodies.find_rigid_groups().items():
        group = {name: read[name] for name in members if name in read}
        wrong = [name for name, body in group.items() if not is_consistent(body)]
        rotations = {name: bodies.poses[name].rotation for name in group}
        for move in move_surplus(group, rotations, wrong, top, find_nearest_consistent):
            report_move(written, move, bodies.robot.link[move.link].place)
        read |= group
    return read


def _give_mass(bodies: Bodies, link: Link, written: Written) -> SpatialInertia:
    moment = TINY_MOMENT
    what = "moves" if link.name != bodies.base else "is the base of several bodies"
    written.report_loss(
        "massless-body",
        f"link '{link.name}' {what} but has no mass, and simulators compute a missing mass from "
        f"collision geometry; it gets {TINY_MASS:g} kg and {moment:g} kg·m²",
        link.place,
        kind="link",
        name=link.name,
    )
    return SpatialInertia(TINY_MASS, ZERO, make_diagonal_tensor(moment, moment, moment))


def _repair(
    bodies: Bodies,
    link: Link,
    body: SpatialInertia,
    options: Options,
    written: Written,
    is_static: bool,
) -> tuple[SpatialInertia, list[Finding]]:
    """Return a link's mass properties, repaired if physically inconsistent, and the defects."""
    excess = get_excess(body.tensor, body.mass)
    if excess <= ROUNDING:
        return body, []
    before = f"principal moments {format_moments_text(body.tensor)} kg·m²"
    defects = []
    if options.fix_inertia == "none" and not is_static and excess > WRITTEN_ROUNDING:
        code = "inertia-triangle-inequality"
        text = (
            f"inertia of link '{link.name}' is physically inconsistent: {before} (none may be "
            "negative or above the sum of the other two), and Newton replaces it. Correct it, or "
            "use --fix-inertia lift, balance or box"
        )
        defects = [make_defect(code, text, link.place, "link", link.name, data={"excess": excess})]
        if not options.force:
            return body, defects
    tensor, how = repair_tensor(
        options.fix_inertia,
        body,
        lambda: compute_box_size(bodies.robot, [(link, IDENTITY)]),
        lift=find_nearest_consistent,
    )
    if not defects:
        held = "; it is fixed to the world and does not move" if is_static else ""
        written.report_loss(
            "inertia",
            f"inertia of link '{link.name}' is physically inconsistent ({before}): {how} to "
            f"{format_moments_text(tensor)} kg·m²{held}",
            link.place,
            kind="link",
            name=link.name,
            data={"excess": excess},
        )
    return SpatialInertia(body.mass, body.com, tensor), defects


def _accept(link: Link, body: SpatialInertia, written: Written) -> BodyInertia:
    """Return principal moments and axes that no reader changes; report a change."""
    moments, axes = _compute_principal(body.tensor)
    accepted = raise_moments(moments)
    tensor = body.tensor
    if not np.array_equal(accepted, moments):
        tensor = from_matrix((axes * accepted) @ axes.T)
    change = float(np.abs(accepted - moments).max()) / (float(accepted.max()) or 1.0)
    if change > _REPORTED:
        written.report_loss(
            "inertia-raised",
            f"inertia of link '{link.name}' has a principal moment that Newton raises; "
            f"{format_moments_text(body.tensor)} kg·m² becomes {format_moments_text(tensor)} kg·m²",
            link.place,
            kind="link",
            name=link.name,
            data={"change": change},
        )
    return BodyInertia(SpatialInertia(body.mass, body.com, tensor), accepted, axes)


def _compute_principal(tensor: SymmetricTensor) -> tuple[Array, Array]:
    """Return principal moments and axes; those of a diagonal tensor keep their order."""
    if tensor[1] == tensor[2] == tensor[4] == 0.0:
        return np.array(get_diagonal(tensor), dtype=np.float64), np.eye(3)
    return compute_principal_axes(tensor)


def raise_moments(moments: Array) -> Array:
    """Raise principal moments [kg·m²] until Newton keeps them, shape (3,)."""
    raised = np.maximum(moments, max(_RELATIVE_FLOOR * float(moments.max()), _FLOOR))
    largest = int(raised.argmax())
    deficit = 2 * raised[largest] - raised.sum()
    if deficit > -2 * _MARGIN * raised[largest]:
        others = np.arange(3) != largest
        raised[others] += max(deficit, 0.0) / 2 + _MARGIN * raised[largest]
    return raised
