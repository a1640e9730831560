"""The one simple slip that explains a tensor no body, or not this body, can have.

A wrong tensor is often a right one mistyped: a decimal point, a sign, the order of the six numbers,
a unit, a frame. Each such slip is undone in turn; what remains is kept only if a rigid body can
have it, if it fits the geometry, and if no other slip explains the tensor as well. Physics is not
made up: without just one explanation there is no proposal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from .bound import spread_ratio
from .tensor import (
    Array,
    MassProperties,
    is_possible,
    rotate,
    scale_mass,
    shift_to_com,
    six_numbers,
    tensor_from_six,
)

NAMES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
DIAGONAL = ("ixx", "iyy", "izz")

POWERS = tuple(power for power in range(-9, 10) if power)
"""Powers of ten by which all numbers may be off: -9 is g·mm², -6 kg·mm², -3 g·m², and back."""

SLIPS = tuple(power for power in range(-6, 7) if power)
"""Powers of ten by which one number may be off."""

GROSS = 0.3
"""Distance from the geometry's tensor, relative to it, beyond which a possible one is in doubt."""

FIT = 0.25
"""Distance from the geometry's tensor, relative to it, within which a repair fits."""

LOOSE_FIT = 0.5
"""The same for a tensor that no body can have, which needs an explanation more."""

SPREAD = 1.1
"""How far beyond the spread of mass that the bounding box allows a tensor may be."""

ROUNDING = 0.01
"""By how much, relatively, written numbers may break the triangle inequality by rounding."""


@dataclass(frozen=True, eq=False)
class Proposal:
    """A tensor that was probably meant, and why."""

    kind: str
    """``decimal``, ``sign``, ``order``, ``axes``, ``unit``, ``origin``, ``frame`` or ``copied``."""
    inertia: Array
    """The tensor [kg·m²] about the centre of mass, along the axes the given one had."""
    sentence: str
    """What to change, and what speaks for it."""

    def as_dict(self) -> dict[str, object]:
        """The JSON form: kind, sentence and the six numbers [kg·m²]."""
        return {
            "kind": self.kind,
            "sentence": self.sentence,
            "inertia": six_numbers(self.inertia),
        }


def propose(
    mass: float,
    com: Sequence[float] | Array,
    inertia: Array,
    *,
    implied: MassProperties | None = None,
    box: tuple[Sequence[float] | Array, Sequence[float] | Array] | None = None,
    rotation: Array | None = None,
) -> Proposal | None:
    """The one simple repair of a tensor that makes it possible and fits the geometry, if any.

    Everything is in one frame: that of the link, or that of the inertial if its axes differ.

    Args:
        mass: Mass [kg] as written.
        com: Centre of mass [m] as written.
        inertia: Tensor [kg·m²] as written, about the centre of mass.
        implied: What the geometry makes of a uniform density; any mass, only its shape is used.
        box: Smallest and largest corner [m] of the geometry.
        rotation: Matrix of the inertial's own ``rpy``, if it is not zero: a tensor may have been
            written along the link's axes in spite of it, or have been turned twice.

    Returns:
        None if the tensor is possible and agrees with the geometry, or if no repair, or more than
        one, explains it. Without ``implied`` and ``box`` nothing can be judged.
    """
    if not (mass > 0 and np.all(np.isfinite(inertia))) or (implied is None and box is None):
        return None
    target = None if implied is None else scale_mass(implied, mass).inertia
    wrong = not _possible(inertia) or not _within(mass, com, inertia, box)
    distance = _distance(inertia, target)
    if not wrong and distance <= GROSS:
        return _copied(inertia, target)
    if copied := _copied(inertia, target):
        return copied
    limit = LOOSE_FIT if wrong else min(FIT, distance / 3)
    found: list[tuple[float, Proposal]] = []
    for candidate in _candidates(mass, com, inertia, rotation):
        off = _distance(candidate.inertia, target)
        fits = off <= limit and _within(mass, com, candidate.inertia, box)
        known = any(np.allclose(candidate.inertia, other.inertia, rtol=1e-9) for _, other in found)
        if fits and _possible(candidate.inertia) and not known:
            found.append((off, candidate))
    found.sort(key=lambda pair: pair[0])
    # two explanations: only if the geometry clearly speaks for the first
    if not found or (len(found) > 1 and not (target is not None and 3 * found[0][0] < found[1][0])):
        return None
    return found[0][1]


def _possible(inertia: Array) -> bool:
    return is_possible(inertia, positivity_tolerance=1e-6, triangle_tolerance=ROUNDING)


def _within(
    mass: float,
    com: Sequence[float] | Array,
    inertia: Array,
    box: tuple[Sequence[float] | Array, Sequence[float] | Array] | None,
) -> bool:
    return box is None or bool(np.all(spread_ratio(mass, com, inertia, *box) <= SPREAD))


def _distance(inertia: Array, target: Array | None) -> float:
    """Distance from the geometry's tensor, relative to it; 0 where there is none to compare."""
    if target is None:
        return 0.0
    return float(np.linalg.norm(inertia - target) / np.linalg.norm(target))


def _copied(inertia: Array, target: Array | None) -> Proposal | None:
    """The geometry's tensor, where one of its three moments was written on all three axes."""
    if target is None:
        return None
    moments, meant = np.diag(inertia), np.diag(target)
    largest = np.abs(target - np.diag(meant)).max()
    if np.ptp(moments) > 0 or np.any(inertia - np.diag(moments)) or largest > 0.01 * meant.max():
        return None
    near = np.isclose(meant, moments[0], rtol=0.02)
    if not near.any() or np.ptp(meant) <= 0.1 * meant.max():
        return None
    name = DIAGONAL[int(np.flatnonzero(near)[-1])]
    values = ", ".join(f"{value:.6g}" for value in meant)
    return Proposal(
        "copied",
        target,
        f"{moments[0]:.6g} is right for {name} and was copied to all three axes; the geometry has "
        f"ixx, iyy, izz = {values}",
    )


def _candidates(
    mass: float, com: Sequence[float] | Array, inertia: Array, rotation: Array | None
) -> Iterator[Proposal]:
    six = six_numbers(inertia)
    yield from _slips(six)
    yield from _signs(six)
    yield from _orders(six)
    yield from _axes(inertia)
    for power in POWERS:
        yield Proposal(
            "unit",
            inertia * 10.0**power,
            f"all six numbers times 1e{power:+d} fit the geometry: {_unit(power)}",
        )
    if np.any(com):
        yield Proposal(
            "origin",
            shift_to_com(inertia, mass, np.asarray(com, dtype=np.float64)),
            "the tensor was taken about the link's origin; about the centre of mass it is possible "
            "and fits the geometry",
        )
    if rotation is not None:
        why = "the tensor was written along the link's axes in spite of the inertial's rpy"
        yield Proposal("frame", rotate(inertia, rotation.T), why)
        why = "the tensor was turned by the inertial's rpy already, which turns it once more"
        yield Proposal("frame", rotate(inertia, rotation), why)


def _unit(power: int) -> str:
    units = {-9: "g·mm²", -7: "g·cm²", -6: "kg·mm²", -4: "kg·cm²", -3: "g·m²"}
    if power in units:
        return f"they were in {units[power]} instead of kg·m²"
    return "the decimal point of all six is off"


def _slips(six: dict[str, float]) -> Iterator[Proposal]:
    for name in NAMES:
        if not six[name]:
            continue
        for power in SLIPS:
            value = six[name] * 10.0**power
            places = f"{abs(power)} decimal place{'s' if abs(power) > 1 else ''}"
            yield Proposal(
                "decimal",
                tensor_from_six(**{**six, name: value}),
                f"{name} = {value:.6g} instead of {six[name]:.6g}, {places} off, is possible and "
                "fits the geometry",
            )


def _signs(six: dict[str, float]) -> Iterator[Proposal]:
    for name in NAMES:
        if six[name]:
            yield Proposal(
                "sign",
                tensor_from_six(**{**six, name: -six[name]}),
                f"{name} = {-six[name]:.6g} with the other sign is possible and fits the geometry",
            )


def _orders(six: dict[str, float]) -> Iterator[Proposal]:
    """The numbers read in one of the usual orders and written in another."""
    orders = {
        "row by row, ixx ixy ixz iyy iyz izz": NAMES,
        "ixx iyy izz ixy ixz iyz": ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"),
        "ixx iyy izz iyz ixz ixy": ("ixx", "iyy", "izz", "iyz", "ixz", "ixy"),
        "ixx iyy izz ixy iyz ixz": ("ixx", "iyy", "izz", "ixy", "iyz", "ixz"),
        "column by column, ixx ixy iyy ixz iyz izz": ("ixx", "ixy", "iyy", "ixz", "iyz", "izz"),
    }
    for (meant, wanted), (_, taken) in permutations(orders.items(), 2):
        numbers = [six[name] for name in taken]
        yield Proposal(
            "order",
            tensor_from_six(**dict(zip(wanted, numbers, strict=True))),
            f"the six numbers were in the order {meant} and were taken in another; put back, they "
            "are possible and fit the geometry",
        )


def _axes(inertia: Array) -> Iterator[Proposal]:
    """The tensor with its axes exchanged, as between a frame with Y up and one with Z up."""
    for order in permutations(range(3)):
        if order == (0, 1, 2):
            continue
        names = ", ".join("xyz"[axis] for axis in order)
        yield Proposal(
            "axes",
            inertia[np.ix_(order, order)],
            f"the tensor was written in a frame whose axes are exchanged; with {names} as x, y, z "
            "it fits the geometry",
        )
