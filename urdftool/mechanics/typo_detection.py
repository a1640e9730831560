"""Detection of the typing error that explains a wrong inertia tensor.

A tensor that is inconsistent or does not fit the geometry is often a correct one mistyped: a
decimal point, a sign, the order of the six numbers, a unit, a frame. Each such error is undone in
turn. A result is kept only if it is physically consistent and fits the geometry, and if no other
error explains the tensor as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from itertools import permutations
from typing import NamedTuple

from ..model.bounds import Bounds
from ..model.elements import Vector
from ..model.link import COMPONENTS
from ..model.pose import Rotation, transpose
from .tensor import SymmetricTensor, measure_consistency, rotate_tensor, shift_to_com

DIAGONAL = (0, 3, 5)
"""Positions of the three moments among the six numbers, by definition."""

POWERS = tuple(power for power in range(-9, 10) if power)
"""Powers of ten by which all six numbers may be off: -9 is g·mm², -6 kg·mm², -3 g·m², and
inverse."""

SLIPS = tuple(power for power in range(-6, 7) if power)
"""Powers of ten by which one number may be off."""

GROSS = 0.3
"""Distance to the geometry's tensor, relative to its norm, above which a tensor is suspect."""

FIT = 0.25
"""Distance to the geometry's tensor, relative to its norm, within which a repair fits."""

LOOSE_FIT = 0.5
"""Value of ``FIT`` for a physically inconsistent tensor, which is certainly wrong."""

SPREAD = 1.1
"""Factor by which a second moment may exceed the bound of the bounding box."""

BOX_MARGIN = 0.02
"""Margin of the bounding box on every side, relative to its diagonal. Chosen, no source."""

ROUNDING = 0.01
"""Relative violation of the triangle inequality that rounding of written numbers explains."""

SIMILAR = 2.5
"""Factor by which a moment may differ from what the other two imply, in the proportions of the
box."""

FILLED = (0.3, 3.0)
"""Range of the moments of real bodies, relative to those of a solid box of their size. Chosen, no
source."""

_LARGEST = 1e60
"""Moments above this, and below its inverse, are not examined: products would overflow."""

_UNITS = {-9: "g·mm²", -7: "g·cm²", -6: "kg·mm²", -4: "kg·cm²", -3: "g·m²"}

_ORDERS = {
    "row by row, ixx ixy ixz iyy iyz izz": COMPONENTS,
    "ixx iyy izz ixy ixz iyz": ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"),
    "ixx iyy izz iyz ixz ixy": ("ixx", "iyy", "izz", "iyz", "ixz", "ixy"),
    "ixx iyy izz ixy iyz ixz": ("ixx", "iyy", "izz", "ixy", "iyz", "ixz"),
    "column by column, ixx ixy iyy ixz iyz izz": ("ixx", "ixy", "iyy", "ixz", "iyz", "izz"),
}

_REORDERED = tuple(
    (meant, tuple(COMPONENTS.index(taken[expected.index(name)]) for name in COMPONENTS))
    for (meant, expected), (_, taken) in permutations(_ORDERS.items(), 2)
)
"""Permutations: the numbers intended in one of the usual orders and written in another."""

_ENTRY = ((0, 1, 2), (1, 3, 4), (2, 4, 5))
"""Positions of the entries of a matrix among the six numbers, by definition."""

_EXCHANGED = tuple(
    (
        ", ".join("xyz"[axis] for axis in (a, b, c)),
        tuple(_ENTRY[i][j] for i, j in ((a, a), (a, b), (a, c), (b, b), (b, c), (c, c))),
    )
    for a, b, c in permutations(range(3))
    if (a, b, c) != (0, 1, 2)
)
"""Permutations: the tensor with its axes exchanged, for example Y up instead of Z up."""


class Proposal(NamedTuple):
    """The tensor that was probably intended, and the reason."""

    kind: str
    """``decimal``, ``sign``, ``order``, ``axes``, ``unit``, ``origin``, ``frame`` or ``copied``."""
    tensor: SymmetricTensor
    """Tensor [kg·m²] about the center of mass, along the axes of the written tensor."""
    sentence: str
    """The change and the evidence for it."""
    name: str = ""
    """URDF name of the one number to change; empty if several change."""


class _Candidate(NamedTuple):
    kind: str
    tensor: SymmetricTensor
    detail: str = ""
    entry: int = -1


@lru_cache(maxsize=1024)
def infer_intended_tensor(
    mass: float,
    com: Vector,
    tensor: SymmetricTensor,
    *,
    solid: SymmetricTensor | None = None,
    box: Bounds | None = None,
    rotation: Rotation | None = None,
) -> Proposal | None:
    """Find the one typing error that explains an inconsistent or unfitting tensor.

    All arguments are in one frame: the link's, or the inertial's if its axes differ.

    Args:
        mass: Mass [kg] as written.
        com: Center of mass [m] as written.
        tensor: Tensor [kg·m²] as written, about the center of mass.
        solid: Tensor of the geometry with a uniform density and that mass [kg·m²].
        box: Bounding box of the geometry [m].
        rotation: Rotation matrix of the inertial's ``rpy``, if not zero: the tensor may be written
            along the link's axes, or may have been rotated twice.

    Returns:
        None if the tensor is consistent and fits the geometry, or if no typing error, or more than
        one, explains it. Without geometry only an inconsistent tensor is suspect, and decimal
        points are not checked.
    """
    if not (mass > 0 and 1 / _LARGEST < max(map(abs, tensor)) < _LARGEST):
        return None
    size = 0.0 if solid is None else _compute_squared_norm(solid)
    if size == 0.0:
        solid = None
    room = None if box is None else _compute_largest_moments(mass, com, box)
    wrong = not is_consistent(tensor) or not _is_within(tensor, room)
    away = 0.0 if solid is None else math.sqrt(_compute_squared_distance(tensor, solid) / size)
    copied = None if solid is None else _propose_copy(tensor, solid)
    if copied is not None or (not wrong and away <= GROSS):
        return copied
    limit = LOOSE_FIT if wrong else min(FIT, away / 3)
    reach = limit * limit * size
    found: list[tuple[float, _Candidate]] = []
    for candidate in _list_candidates(mass, com, tensor, rotation):
        meant = candidate.tensor
        off = 0.0 if solid is None else _compute_squared_distance(meant, solid)
        if off > reach or not _is_within(meant, room) or not is_consistent(meant):
            continue
        if candidate.kind == "decimal" and not _is_near(candidate, solid, room):
            continue
        if not any(_is_close(meant, other.tensor) for _, other in found):
            found.append((off, candidate))
    if not found:
        return None
    found.sort(key=lambda pair: pair[0])
    if len(found) > 1:  # accepted only if it fits the geometry three times better
        (first, _), (second, _) = found[:2]
        if second <= 9 * first:
            return None
    return _create_proposal(found[0][1], tensor, solid is not None or box is not None)


def infer_intended_moment(mass: float, tensor: SymmetricTensor, size: Vector) -> Proposal | None:
    """Find the decimal point error in the one moment that makes a tensor inconsistent.

    The other two moments show how the body fills its bounding box, which determines the third to
    much better than a power of ten.

    Args:
        mass: Mass [kg].
        tensor: Physically inconsistent tensor [kg·m²].
        size: Edges of the bounding box of the geometry [m], along the axes of the tensor.

    Returns:
        None if no moment, or more than one, can be wrong, or if a product of inertia can.
    """
    x, y, z = (length * length for length in size)
    solid = tuple(mass / 12 * part for part in (y + z, x + z, x + y))
    if not (mass > 0 and min(solid) > 0 and max(map(abs, tensor)) < _LARGEST):
        return None
    found = []
    for entry, value in enumerate(tensor):
        if not value:
            continue
        before, after = tensor[:entry], tensor[entry + 1 :]
        for power in SLIPS:
            meant: SymmetricTensor = (*before, _move_decimal_point(value, power), *after)  # type: ignore[assignment]
            if not is_consistent(meant):
                continue
            if entry not in DIAGONAL:
                return None
            if _is_in_proportion(meant, solid, DIAGONAL.index(entry)):
                found.append(_Candidate("decimal", meant, str(abs(power)), entry))
    return _create_proposal(found[0], tensor, True) if len(found) == 1 else None


def _is_in_proportion(tensor: SymmetricTensor, solid: tuple[float, ...], axis: int) -> bool:
    """Tell whether a moment agrees with the other two, and those with the bounding box."""
    filled = [tensor[i] / moment for i, moment in zip(DIAGONAL, solid, strict=True)]
    own = filled.pop(axis)
    if not all(FILLED[0] <= part <= FILLED[1] for part in filled):
        return False
    usual = math.sqrt(filled[0] * filled[1])
    return usual / SIMILAR <= own <= usual * SIMILAR


def is_consistent(tensor: SymmetricTensor) -> bool:
    """Tell whether a tensor is physically consistent, except for rounding of written numbers."""
    xx, _, _, yy, _, zz = tensor
    largest = max(xx, yy, zz)
    # a necessary condition along any axes that rejects most candidates cheaply
    if largest <= 0.0 or min(xx, yy, zz) < -1e-5 * largest:
        return False
    if 2 * largest > (xx + yy + zz) * (1 + 2 * ROUNDING):
        return False
    found = measure_consistency(tensor)
    return found.size > 0 and found.negativity <= 1e-6 and found.excess <= ROUNDING


def _compute_largest_moments(mass: float, com: Vector, box: Bounds) -> Vector:
    """Compute the largest second moments [kg·m²] along x, y and z of a body in a box.

    Mass inside the interval [lo, hi] with its mean at c has a variance of at most (hi − c)(c − lo)
    (Bhatia and Davis, "A Better Bound on the Variance", 2000).
    """
    margin = BOX_MARGIN * math.dist(box.low, box.high)
    x, y, z = (
        SPREAD * mass * (high + margin - center) * (center - low + margin)
        if low - margin < center < high + margin
        else -math.inf
        for low, high, center in zip(box.low, box.high, com, strict=True)
    )
    return x, y, z


def _is_within(tensor: SymmetricTensor, room: Vector | None) -> bool:
    if room is None:
        return True
    xx, _, _, yy, _, zz = tensor
    half = (xx + yy + zz) / 2
    return half - xx <= room[0] and half - yy <= room[1] and half - zz <= room[2]


def _compute_squared_norm(tensor: SymmetricTensor) -> float:
    xx, xy, xz, yy, yz, zz = tensor
    return xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)


def _compute_squared_distance(tensor: SymmetricTensor, other: SymmetricTensor) -> float:
    """Compute the squared norm of the difference of two tensors."""
    xx, xy, xz, yy, yz, zz = tensor
    a, b, c, d, e, f = other
    xx, xy, xz, yy, yz, zz = xx - a, xy - b, xz - c, yy - d, yz - e, zz - f
    return xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)


def _is_close(tensor: SymmetricTensor, other: SymmetricTensor) -> bool:
    return _compute_squared_distance(tensor, other) <= 1e-18 * _compute_squared_norm(other)


def _is_near(candidate: _Candidate, solid: SymmetricTensor | None, room: Vector | None) -> bool:
    """Tell whether a number with its decimal point moved is within 25 % of the geometry's.

    A small number among large ones adds little to the distance of the tensors, so it is compared by
    itself. Without a ``solid`` it is accepted only if there is a bounding box.
    """
    if solid is None:
        return room is not None
    value, expected = candidate.tensor[candidate.entry], solid[candidate.entry]
    return abs(value - expected) <= 0.25 * abs(expected)


def _propose_copy(tensor: SymmetricTensor, solid: SymmetricTensor) -> Proposal | None:
    """Return the geometry's tensor if one of its moments was written on all three axes."""
    moment = tensor[0]
    if not moment == tensor[3] == tensor[5] or tensor[1] or tensor[2] or tensor[4]:
        return None
    meant = [solid[i] for i in DIAGONAL]
    largest = max(meant)
    if max(abs(solid[1]), abs(solid[2]), abs(solid[4])) > 0.01 * largest:
        return None
    right = [COMPONENTS[i] for i in DIAGONAL if abs(solid[i] - moment) <= 0.02 * abs(moment)]
    if not right or largest - min(meant) <= 0.1 * largest:
        return None
    values = ", ".join(f"{value:.6g}" for value in meant)
    return Proposal(
        "copied",
        solid,
        f"{moment:.6g} is right for {' and '.join(right)} and was copied to all three axes; the "
        f"geometry has ixx, iyy, izz = {values}",
    )


def _list_candidates(
    mass: float, com: Vector, tensor: SymmetricTensor, rotation: Rotation | None
) -> Iterator[_Candidate]:
    for entry, value in enumerate(tensor):
        if not value:
            continue
        before, after = tensor[:entry], tensor[entry + 1 :]
        for power in SLIPS:
            yield _Candidate(
                "decimal",
                (*before, _move_decimal_point(value, power), *after),  # type: ignore[arg-type]
                str(abs(power)),
                entry,
            )
        yield _Candidate("sign", (*before, -value, *after), "", entry)  # type: ignore[arg-type]
    for kind, orders in (("order", _REORDERED), ("axes", _EXCHANGED)):
        for detail, order in orders:
            yield _Candidate(kind, tuple([tensor[i] for i in order]), detail)  # type: ignore[arg-type]
    for power in POWERS:
        scaled = tuple([_move_decimal_point(value, power) for value in tensor])
        yield _Candidate("unit", scaled, _format_unit(power))  # type: ignore[arg-type]
    if any(com):
        yield _Candidate("origin", shift_to_com(tensor, mass, com))
    if rotation is not None:
        yield _Candidate("frame", rotate_tensor(tensor, transpose(rotation)), "written")
        yield _Candidate("frame", rotate_tensor(tensor, rotation), "turned")


def _move_decimal_point(value: float, power: int) -> float:
    """Move the decimal point of a number; dividing by 1e3 rounds better than times 1e-3."""
    return float(value * 10**power if power > 0 else value / 10**-power)


def _format_unit(power: int) -> str:
    text = f"all six numbers times 1e{power:+d} fit the geometry: "
    if power in _UNITS:
        return f"{text}they were in {_UNITS[power]} instead of kg·m²"
    return f"{text}the decimal point of all six is misplaced"


def _create_proposal(candidate: _Candidate, tensor: SymmetricTensor, fits: bool) -> Proposal:
    """Create the proposal with its sentence."""
    kind, meant, detail, entry = candidate
    is_so = "is possible and fits the geometry" if fits else "is possible"
    are_so = "are possible and fit the geometry" if fits else "are possible"
    name = COMPONENTS[entry] if entry >= 0 else ""
    if kind == "decimal":
        places = f"{detail} decimal place{'s' if detail != '1' else ''}"
        change = f"{meant[entry]:.6g} instead of {tensor[entry]:.6g}"
        sentence = f"{name} = {change}, {places} off, {is_so}"
    elif kind == "sign":
        sentence = f"{name} = {meant[entry]:.6g} with the other sign {is_so}"
    elif kind == "order":
        sentence = f"the six numbers were written in the order {detail}; reordered, they {are_so}"
    elif kind == "axes":
        sentence = (
            f"the tensor was written in a frame whose axes are swapped; with {detail} as x, y, z "
            "it fits the geometry"
        )
    elif kind == "origin":
        sentence = (
            "the tensor was taken about the link's origin; about the center of mass it is possible "
            "and fits the geometry"
        )
    elif detail == "written":
        sentence = "the tensor was written along the link's axes although the inertial has an rpy"
    elif detail == "turned":
        sentence = "the tensor was already rotated by the inertial's rpy, which rotates it again"
    else:
        sentence = detail
    return Proposal(kind, meant, sentence, name)
