"""The one typing error that explains an inconsistent tensor, or one that misfits the geometry.

A wrong tensor is often a right one mistyped: a decimal point, a sign, the order of the six numbers,
a unit, a frame. Each such error is undone in turn; the result is kept only if it is physically
consistent, if it fits the geometry, and if no other error explains the tensor as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from itertools import permutations
from typing import NamedTuple

from ..model.bounds import Bounds
from ..model.elements import Vector
from ..model.pose import Rotation, transpose
from .tensor import COMPONENTS, SymmetricTensor, consistency, rotate_tensor, shift_to_com

DIAGONAL = (0, 3, 5)
"""Where the three moments are among the six numbers."""

POWERS = tuple(power for power in range(-9, 10) if power)
"""Powers of ten by which all numbers may be off: -9 is g·mm², -6 kg·mm², -3 g·m², and back."""

SLIPS = tuple(power for power in range(-6, 7) if power)
"""Powers of ten by which one number may be off."""

GROSS = 0.3
"""Distance from the geometry's tensor, relative to it, beyond which it is in doubt."""

FIT = 0.25
"""Distance from the geometry's tensor, relative to it, within which a repair fits."""

LOOSE_FIT = 0.5
"""The same for a physically inconsistent tensor, which needs an explanation more."""

SPREAD = 1.1
"""How far beyond the spread of mass that the bounding box allows a tensor may be."""

BOX_MARGIN = 0.02
"""By how much the box is widened on every side, relative to its diagonal."""

ROUNDING = 0.01
"""By how much, relatively, written numbers may break the triangle inequality by rounding."""

SIMILAR = 2.5
"""Factor within which a moment goes with the other two, in the proportions of the box."""

FILLED = (0.3, 3.0)
"""Moments of real bodies, relative to those of a solid box of their size."""

_LARGEST = 1e60

_UNITS = {-9: "g·mm²", -7: "g·cm²", -6: "kg·mm²", -4: "kg·cm²", -3: "g·m²"}

_ORDERS = {
    "row by row, ixx ixy ixz iyy iyz izz": COMPONENTS,
    "ixx iyy izz ixy ixz iyz": ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"),
    "ixx iyy izz iyz ixz ixy": ("ixx", "iyy", "izz", "iyz", "ixz", "ixy"),
    "ixx iyy izz ixy iyz ixz": ("ixx", "iyy", "izz", "ixy", "iyz", "ixz"),
    "column by column, ixx ixy iyy ixz iyz izz": ("ixx", "ixy", "iyy", "ixz", "iyz", "izz"),
}

_REORDERED = tuple(
    (meant, tuple(COMPONENTS.index(taken[wanted.index(name)]) for name in COMPONENTS))
    for (meant, wanted), (_, taken) in permutations(_ORDERS.items(), 2)
)
"""The numbers read in one of the usual orders and written in another."""

_ENTRY = ((0, 1, 2), (1, 3, 4), (2, 4, 5))

_EXCHANGED = tuple(
    (
        ", ".join("xyz"[axis] for axis in (a, b, c)),
        tuple(_ENTRY[i][j] for i, j in ((a, a), (a, b), (a, c), (b, b), (b, c), (c, c))),
    )
    for a, b, c in permutations(range(3))
    if (a, b, c) != (0, 1, 2)
)
"""The tensor with its axes exchanged, as between a frame with Y up and one with Z up."""


class Proposal(NamedTuple):
    """The tensor that was probably intended, and why."""

    kind: str
    """``decimal``, ``sign``, ``order``, ``axes``, ``unit``, ``origin``, ``frame`` or ``copied``."""
    tensor: SymmetricTensor
    """The tensor [kg·m²] about the centre of mass, along the axes the given one had."""
    sentence: str
    """What to change, and what speaks for it."""
    name: str = ""
    """The one number to change, where it is one."""


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
    """Find the one typing error that, undone, makes a tensor consistent and fit the geometry.

    Everything is in one frame: that of the link, or that of the inertial if its axes differ.

    Args:
        mass: Mass [kg] as written.
        com: Centre of mass [m] as written.
        tensor: Tensor [kg·m²] as written, about the centre of mass.
        solid: Tensor of the geometry with a uniform density and that mass [kg·m²].
        box: The box around the geometry [m].
        rotation: Matrix of the inertial's own ``rpy``, if it is not zero: a tensor may have been
            written along the link's axes in spite of it, or have been rotated twice.

    Returns:
        None if the tensor is consistent and agrees with the geometry, or if no typing error, or
        more than one, explains it. Without geometry only an inconsistent tensor is doubtful, and
        only a sign or the order of the numbers can be found.
    """
    if not (mass > 0 and 1 / _LARGEST < max(map(abs, tensor)) < _LARGEST):
        return None
    size = 0.0 if solid is None else _squared_norm(solid)
    if size == 0.0:
        solid = None
    room = None if box is None else _room(mass, com, box)
    wrong = not is_consistent(tensor) or not _within(tensor, room)
    away = 0.0 if solid is None else math.sqrt(_squared_distance(tensor, solid) / size)
    copied = None if solid is None else _copied(tensor, solid)
    if copied is not None or (not wrong and away <= GROSS):
        return copied
    limit = LOOSE_FIT if wrong else min(FIT, away / 3)
    reach = limit * limit * size
    found: list[tuple[float, _Candidate]] = []
    for candidate in _candidates(mass, com, tensor, rotation):
        meant = candidate.tensor
        off = 0.0 if solid is None else _squared_distance(meant, solid)
        if off > reach or not _within(meant, room) or not is_consistent(meant):
            continue
        if candidate.kind == "decimal" and not _is_near(candidate, solid, room):
            continue
        if not any(_alike(meant, other.tensor) for _, other in found):
            found.append((off, candidate))
    if not found:
        return None
    found.sort(key=lambda pair: pair[0])
    if len(found) > 1:  # only if the geometry clearly speaks for the first
        (first, _), (second, _) = found[:2]
        if second <= 9 * first:
            return None
    return _proposal(found[0][1], tensor, solid is not None or box is not None)


def infer_intended_moment(mass: float, tensor: SymmetricTensor, size: Vector) -> Proposal | None:
    """Move the decimal point of the one moment that makes a tensor inconsistent.

    The other two show how the body fills its bounding box, and so the size of the third, well
    within a power of ten.

    Args:
        mass: Mass [kg].
        tensor: Physically inconsistent tensor [kg·m²].
        size: Of the box around the geometry [m], along the axes of the tensor.

    Returns:
        None if no moment, or more than one, can be the wrong one, or if a product of inertia can.
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
            meant: SymmetricTensor = (*before, _moved(value, power), *after)  # type: ignore[assignment]
            if not is_consistent(meant):
                continue
            if entry not in DIAGONAL:
                return None
            if _is_in_proportion(meant, solid, DIAGONAL.index(entry)):
                found.append(_Candidate("decimal", meant, str(abs(power)), entry))
    return _proposal(found[0], tensor, True) if len(found) == 1 else None


def _is_in_proportion(tensor: SymmetricTensor, solid: tuple[float, ...], axis: int) -> bool:
    """Whether a moment goes with the other two, and those with a body of the size of the box."""
    filled = [tensor[i] / moment for i, moment in zip(DIAGONAL, solid, strict=True)]
    own = filled.pop(axis)
    if not all(FILLED[0] <= part <= FILLED[1] for part in filled):
        return False
    usual = math.sqrt(filled[0] * filled[1])
    return usual / SIMILAR <= own <= usual * SIMILAR


def is_consistent(tensor: SymmetricTensor) -> bool:
    """Whether a rigid body can have this tensor, except for the rounding of written numbers."""
    xx, _, _, yy, _, zz = tensor
    largest = max(xx, yy, zz)
    # what holds of the principal moments holds along any axes; this sorts out most
    if largest <= 0.0 or min(xx, yy, zz) < -1e-5 * largest:
        return False
    if 2 * largest > (xx + yy + zz) * (1 + 2 * ROUNDING):
        return False
    found = consistency(tensor)
    return found.size > 0 and found.negativity <= 1e-6 and found.excess <= ROUNDING


def _room(mass: float, com: Vector, box: Bounds) -> Vector:
    """Compute the largest second moments [kg·m²] along x, y and z of a body in a box.

    Mass inside the interval [lo, hi] with its mean at c has a variance of at most (hi − c)(c − lo)
    (Bhatia and Davis, "A Better Bound on the Variance", 2000).
    """
    margin = BOX_MARGIN * math.dist(box.low, box.high)
    x, y, z = (
        SPREAD * mass * (high + margin - centre) * (centre - low + margin)
        if low - margin < centre < high + margin
        else -math.inf
        for low, high, centre in zip(box.low, box.high, com, strict=True)
    )
    return x, y, z


def _within(tensor: SymmetricTensor, room: Vector | None) -> bool:
    if room is None:
        return True
    xx, _, _, yy, _, zz = tensor
    half = (xx + yy + zz) / 2
    return half - xx <= room[0] and half - yy <= room[1] and half - zz <= room[2]


def _squared_norm(tensor: SymmetricTensor) -> float:
    xx, xy, xz, yy, yz, zz = tensor
    return xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)


def _squared_distance(tensor: SymmetricTensor, other: SymmetricTensor) -> float:
    """Compute the squared norm of the difference of two tensors."""
    xx, xy, xz, yy, yz, zz = tensor
    a, b, c, d, e, f = other
    xx, xy, xz, yy, yz, zz = xx - a, xy - b, xz - c, yy - d, yz - e, zz - f
    return xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)


def _alike(tensor: SymmetricTensor, other: SymmetricTensor) -> bool:
    return _squared_distance(tensor, other) <= 1e-18 * _squared_norm(other)


def _is_near(candidate: _Candidate, solid: SymmetricTensor | None, room: Vector | None) -> bool:
    """Whether a number whose decimal point was moved is within a quarter of the geometry's.

    A small number next to two large ones adds little to the distance, whatever its decimal point.
    Without any geometry no decimal point can be judged.
    """
    if solid is None:
        return room is not None
    value, wanted = candidate.tensor[candidate.entry], solid[candidate.entry]
    return abs(value - wanted) <= 0.25 * abs(wanted)


def _copied(tensor: SymmetricTensor, solid: SymmetricTensor) -> Proposal | None:
    """Return the geometry's tensor, if one of its three moments was written on all three axes."""
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


def _candidates(
    mass: float, com: Vector, tensor: SymmetricTensor, rotation: Rotation | None
) -> Iterator[_Candidate]:
    for entry, value in enumerate(tensor):
        if not value:
            continue
        before, after = tensor[:entry], tensor[entry + 1 :]
        for power in SLIPS:
            yield _Candidate(
                "decimal",
                (*before, _moved(value, power), *after),  # type: ignore[arg-type]
                str(abs(power)),
                entry,
            )
        yield _Candidate("sign", (*before, -value, *after), "", entry)  # type: ignore[arg-type]
    for kind, orders in (("order", _REORDERED), ("axes", _EXCHANGED)):
        for detail, order in orders:
            yield _Candidate(kind, tuple([tensor[i] for i in order]), detail)  # type: ignore[arg-type]
    for power in POWERS:
        scaled = tuple([_moved(value, power) for value in tensor])
        yield _Candidate("unit", scaled, _unit(power))  # type: ignore[arg-type]
    if any(com):
        yield _Candidate("origin", shift_to_com(tensor, mass, com))
    if rotation is not None:
        yield _Candidate("frame", rotate_tensor(tensor, transpose(rotation)), "written")
        yield _Candidate("frame", rotate_tensor(tensor, rotation), "turned")


def _moved(value: float, power: int) -> float:
    """Move the decimal point of a number; a division is rounded better than times 1e-3."""
    return float(value * 10**power if power > 0 else value / 10**-power)


def _unit(power: int) -> str:
    text = f"all six numbers times 1e{power:+d} fit the geometry: "
    if power in _UNITS:
        return f"{text}they were in {_UNITS[power]} instead of kg·m²"
    return f"{text}the decimal point of all six is off"


def _proposal(candidate: _Candidate, tensor: SymmetricTensor, fits: bool) -> Proposal:
    """Make the proposal with its sentence."""
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
        sentence = (
            f"the six numbers were in the order {detail} and were taken in another; put back, they "
            f"{are_so}"
        )
    elif kind == "axes":
        sentence = (
            f"the tensor was written in a frame whose axes are exchanged; with {detail} as x, y, z "
            "it fits the geometry"
        )
    elif kind == "origin":
        sentence = (
            "the tensor was taken about the link's origin; about the centre of mass it is possible "
            "and fits the geometry"
        )
    elif detail == "written":
        sentence = "the tensor was written along the link's axes in spite of the inertial's rpy"
    elif detail == "turned":
        sentence = "the tensor was turned by the inertial's rpy already, which turns it once more"
    else:
        sentence = detail
    return Proposal(kind, meant, sentence, name)
