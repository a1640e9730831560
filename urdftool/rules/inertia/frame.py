"""Inertia tensors about the wrong point."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...mechanics.mass_bounds import spread_ratio
from ...mechanics.tensor import SymmetricTensor, rotate_tensor, shift_to_com
from ...mechanics.typo_detection import is_consistent
from ...model.bounds import Bounds
from ...model.elements import Collision, Inertial, Link, Mesh, Robot, Vector, Visual
from ...model.pose import pose_of, transpose
from ..fix import FixContext, Proposal
from ..mesh.outlines import reaches
from ..rule import UNSAFE, WARNING, Problem, rule
from .corrections import write_proposed_inertia
from .proposals import attributes_text, proposal_of
from .solids import solid_tensor
from .tensors import is_zero, tensors

HOLLOW = 1.7
"""Second moment of a body, relative to that of a solid box of its size, above which it is not
plausible: a hollow box, with all mass in its walls, has 5/3."""

PLAUSIBLE = (0.3, 1.3)
"""The same for a tensor that is accepted as the right one: a solid ball has 0.6, a hollow one 1."""

BEYOND = 1.1
"""Factor by which mass must be spread wider than the bounding box allows."""

UNIFORM = 0.1
"""Distance of a tensor from that of a solid primitive, relative to it, at which the two agree."""


@rule(
    WARNING,
    effects={
        "mujoco, pinocchio": (
            "take it as the tensor about the center of mass: a joint then moves mass × distance² "
            "twice"
        ),
        "pybullet": "does so with URDF_USE_INERTIA_FROM_FILE, and computes its own otherwise",
    },
)
def inertia_about_link_frame(robot: Robot) -> Iterator[Problem]:
    """An inertia is given about the frame of the link instead of the center of mass.

    URDF expects the tensor about the center of mass, along the axes of the ``<inertial>``. CAD
    programs also print it about the output coordinate system, which is larger by mass × distance²
    (the parallel axis theorem). The link then resists its joint as if it were much heavier.

    It is reported only where the tensor as written does not fit the geometry, and the one about the
    center of mass does: where it equals that of a solid primitive, or where the written one is far
    above that of a solid box of the link's size and either needs mass outside of the geometry, or
    has products of inertia that the parallel axis theorem explains.
    """
    for link, inertial, six in tensors(robot):
        right = about_com(link, inertial, six, reaches(robot).link(link))
        if right is not None:
            yield Problem(
                link,
                f"inertia of link '{link.name}' fits its geometry only if it is about the link "
                f"frame; readers take it about the center of mass: write {attributes_text(right)}",
                at=inertial.inertia,
                data={"inertia": list(right)},
            )


@inertia_about_link_frame.fix(UNSAFE)
def write_inertia_about_center(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the tensor about the center of mass."""
    return write_proposed_inertia(problem, context)


def about_com(
    link: Link, inertial: Inertial, six: SymmetricTensor, box: Bounds | None
) -> SymmetricTensor | None:
    """Compute the tensor about the center of mass, if the written one is about the link frame.

    Args:
        link: A link with mass.
        inertial: Its inertial.
        six: The tensor as written [kg·m²].
        box: The box around its geometry in its frame [m].

    Returns:
        The tensor [kg·m²] along the axes of the inertial; None where the written one may be right,
        or is wrong in another way.
    """
    mass, pose = link.mass, pose_of(inertial.origin)
    if box is None or mass <= 0 or not any(pose.translation) or is_zero(six, mass):
        return None
    tensor = rotate_tensor(six, pose.rotation)
    shifted = shift_to_com(tensor, mass, pose.translation)
    right = rotate_tensor(shifted, transpose(pose.rotation))
    if not is_consistent(shifted):
        return None
    other = proposal_of(link, inertial, six)
    if other is not None and other.kind != "origin":
        return None
    solid = solid_tensor(link)
    if solid is not None and not _has_mesh(link):
        size = _norm(solid)
        if _distance(right, solid) <= UNIFORM * size and _distance(six, solid) >= 0.3 * size:
            return right
    whole = mass / 12 * sum(length * length for length in box.size)
    if whole <= 0:  # of numbers so small that their product is none
        return None
    written, meant = (sum(one[i] for i in (0, 3, 5)) / 2 / whole for one in (tensor, shifted))
    if written < max(HOLLOW, 2 * meant) or not PLAUSIBLE[0] <= meant <= PLAUSIBLE[1]:
        return None
    ratio, _ = spread_ratio(box, mass, pose.translation, tensor)
    if ratio > BEYOND or _explains_products(tensor, shifted):
        return right
    return None


def about_center(
    link: Link, inertial: Inertial, center: Vector, box: Bounds
) -> SymmetricTensor | None:
    """Compute the tensor about a center of mass that is not written, but known by the geometry.

    Args:
        link: A link with mass, whose inertial is at its frame.
        inertial: Its inertial.
        center: Where its center of mass is by its geometry, in its frame [m].
        box: The box around its geometry in its frame [m].

    Returns:
        The tensor [kg·m²] along the axes of the inertial: as written, where that fits the geometry
        as it is, or shifted, where it fits the geometry about the frame of the link; None where
        neither is clear.
    """
    if inertial.inertia is None:
        return None
    six, rotation, mass = inertial.inertia.six, pose_of(inertial.origin).rotation, link.mass
    shifted = shift_to_com(rotate_tensor(six, rotation), mass, center)
    right = rotate_tensor(shifted, transpose(rotation))
    solid = solid_tensor(link)
    if solid is not None and not _has_mesh(link):
        for one in (six, right):
            if _distance(one, solid) <= UNIFORM * _norm(solid):
                return one
    whole = mass / 12 * sum(length * length for length in box.size)
    if whole <= 0:
        return None
    written, meant = (sum(one[i] for i in (0, 3, 5)) / 2 / whole for one in (six, shifted))
    fits = [PLAUSIBLE[0] <= value <= PLAUSIBLE[1] for value in (written, meant)]
    if fits[1] and not fits[0] and is_consistent(shifted):
        return right
    if fits[0] and not (fits[1] and is_consistent(shifted)):
        return six
    return None


def _explains_products(tensor: SymmetricTensor, shifted: SymmetricTensor) -> bool:
    """Whether products of inertia that are not small are much smaller about the other point."""
    before, after = (abs(one[1]) + abs(one[2]) + abs(one[4]) for one in (tensor, shifted))
    return before > 0.05 * max(tensor[0], tensor[3], tensor[5]) and after < 0.5 * before


def _has_mesh(link: Link) -> bool:
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    return any(isinstance(shape.geometry, Mesh) for shape in shapes)


def _distance(one: SymmetricTensor, other: SymmetricTensor) -> float:
    a, b, c, d, e, f = (x - y for x, y in zip(one, other, strict=True))
    return _norm((a, b, c, d, e, f))


def _norm(six: SymmetricTensor) -> float:
    """The Frobenius norm of a symmetric matrix."""
    xx, xy, xz, yy, yz, zz = six
    return math.sqrt(xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz))
