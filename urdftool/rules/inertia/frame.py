"""Detect inertia tensors about the wrong point."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from ...mechanics.mass_bounds import spread_ratio
from ...mechanics.tensor import SymmetricTensor, rotate_tensor, shift_to_com
from ...mechanics.typo_detection import is_consistent
from ...model.bounds import Bounds
from ...model.elements import Collision, Inertial, Link, Mesh, Robot, Vector, Visual
from ...model.pose import make_pose, transpose
from ..mesh.link_extents import get_extents
from ..rule import UNSAFE, WARNING, Problem, rule
from .corrections import write_proposed_inertia
from .proposals import find_proposal, format_tensor
from .solids import compute_solid_tensor
from .tensors import get_tensors, is_zero

HOLLOW = 1.7
"""Second moment of a body, relative to that of a solid box of its size, above which it is
implausible: a hollow box, with all mass in its walls, has 5/3. Chosen, no source.
"""

PLAUSIBLE = (0.3, 1.3)
"""The same for a tensor that is accepted as correct: a solid ball has 0.6, a hollow one 1. Chosen,
no source.
"""

BEYOND = 1.1
"""Factor by which the mass must extend beyond the bounding box."""

UNIFORM = 0.1
"""Relative distance to the tensor of a solid primitive below which the two agree."""


@rule(
    WARNING,
    effects={
        "mujoco, pinocchio": (
            "take it as the tensor about the center of mass: a joint then moves mass × distance² "
            "twice"
        ),
        "pybullet": "does the same with URDF_USE_INERTIA_FROM_FILE; otherwise it computes its own",
    },
)
def inertia_about_link_frame(robot: Robot) -> Iterator[Problem]:
    """An inertia is given about the link frame instead of the center of mass.

    URDF expects the tensor about the center of mass, along the axes of the ``<inertial>``. CAD
    programs also print it about the output coordinate system, which is larger by mass × distance²
    (the parallel axis theorem). The joint then accelerates the link too slowly.

    It is reported only if the tensor as written does not fit the geometry and the tensor about
    the center of mass does: either it equals that of a solid primitive, or the written one is far
    above that of a solid box of the link's size and requires mass outside of the geometry, or has
    products of inertia that the parallel axis theorem explains.
    """
    for link, inertial, six in get_tensors(robot):
        right = compute_tensor_about_com(link, inertial, six, get_extents(robot).get_link_box(link))
        if right is not None:
            yield Problem(
                link,
                f"inertia of link '{link.name}' fits its geometry only about the link frame, but "
                f"readers take it about the center of mass; write {format_tensor(right)}",
                at=inertial.inertia,
                data={"inertia": list(right)},
            )


inertia_about_link_frame.fix(UNSAFE)(write_proposed_inertia)


def compute_tensor_about_com(
    link: Link, inertial: Inertial, six: SymmetricTensor, box: Bounds | None
) -> SymmetricTensor | None:
    """Compute the tensor about the center of mass, if the written one is about the link frame.

    Returns:
        The tensor [kg·m²] along the axes of the inertial; None if the written one may be correct,
        or is wrong in another way.
    """
    mass, pose = link.mass, make_pose(inertial.origin)
    if box is None or mass <= 0 or not any(pose.translation) or is_zero(six, mass):
        return None
    tensor = rotate_tensor(six, pose.rotation)
    shifted = shift_to_com(tensor, mass, pose.translation)
    right = rotate_tensor(shifted, transpose(pose.rotation))
    if not is_consistent(shifted):
        return None
    other = find_proposal(link, inertial, six)
    if other is not None and other.kind != "origin":
        return None
    solid = compute_solid_tensor(link)
    if solid is not None and not has_mesh(link):
        size = _compute_norm(solid)
        if (
            _compute_distance(right, solid) <= UNIFORM * size
            and _compute_distance(six, solid) >= 0.3 * size
        ):
            return right
    whole = mass / 12 * sum(length * length for length in box.size)
    if whole <= 0:  # the product of tiny numbers underflows
        return None
    written, meant = (sum(one[i] for i in (0, 3, 5)) / 2 / whole for one in (tensor, shifted))
    if written < max(HOLLOW, 2 * meant) or not PLAUSIBLE[0] <= meant <= PLAUSIBLE[1]:
        return None
    ratio, _ = spread_ratio(box, mass, pose.translation, tensor)
    if ratio > BEYOND or _explains_products(tensor, shifted):
        return right
    return None


def compute_tensor_about_center(
    link: Link, inertial: Inertial, center: Vector, box: Bounds
) -> SymmetricTensor | None:
    """Compute the tensor about a center of mass that only the geometry determines.

    Returns:
        The tensor [kg·m²] along the axes of the inertial: as written if it fits the geometry,
        or shifted if it fits the geometry about the link frame; None if neither is clear.
    """
    if inertial.inertia is None:
        return None
    six, rotation, mass = inertial.inertia.six, make_pose(inertial.origin).rotation, link.mass
    shifted = shift_to_com(rotate_tensor(six, rotation), mass, center)
    right = rotate_tensor(shifted, transpose(rotation))
    solid = compute_solid_tensor(link)
    if solid is not None and not has_mesh(link):
        for one in (six, right):
            if _compute_distance(one, solid) <= UNIFORM * _compute_norm(solid):
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
    """Tell whether considerable products of inertia nearly vanish about the other point."""
    before, after = (abs(one[1]) + abs(one[2]) + abs(one[4]) for one in (tensor, shifted))
    return before > 0.05 * max(tensor[0], tensor[3], tensor[5]) and after < 0.5 * before


def has_mesh(link: Link) -> bool:
    """Tell whether one of a link's visuals or collisions is a mesh."""
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    return any(isinstance(shape.geometry, Mesh) for shape in shapes)


def _compute_distance(one: SymmetricTensor, other: SymmetricTensor) -> float:
    a, b, c, d, e, f = (x - y for x, y in zip(one, other, strict=True))
    return _compute_norm((a, b, c, d, e, f))


def _compute_norm(six: SymmetricTensor) -> float:
    """Compute the Frobenius norm of a symmetric matrix."""
    xx, xy, xz, yy, yz, zz = six
    return math.sqrt(xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz))


_ALONG_AXES = 1e-3
"""Products of inertia, relative to the largest moment, of a body along the axes. Chosen, no source.
"""

_EXCHANGES = {
    "x and y": (3, 1, 4, 0, 2, 5),
    "x and z": (5, 4, 2, 3, 1, 0),
    "y and z": (0, 2, 1, 5, 4, 3),
}
"""Where each number of a tensor is after two axes are exchanged."""


def find_exchange(tensor: SymmetricTensor, judge: Callable[..., object]) -> str:
    """Find the two axes of a link whose exchange lets a tensor fit its geometry.

    That happens where the rotation of an inertial frame was lost, as of a cylinder along x that is
    written about its own z.

    Returns:
        The axes, such as ``x and z``; empty if no exchange fits, or several do, or the tensor is
        not that of a body along the axes.
    """
    if max(abs(tensor[i]) for i in (1, 2, 4)) > _ALONG_AXES * max(map(abs, tensor)):
        return ""
    fitting = [
        axes
        for axes, (a, b, c, d, e, f) in _EXCHANGES.items()
        if judge(tensor=(tensor[a], tensor[b], tensor[c], tensor[d], tensor[e], tensor[f])) is None
    ]
    return fitting[0] if len(fitting) == 1 else ""
