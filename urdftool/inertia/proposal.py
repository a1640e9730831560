"""What was probably meant by a wrong tensor: the model's proposal, for arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..model import inertia_slips
from ..model.bounds import Bounds
from ..model.elements import Vector
from ..model.tensor3 import Six
from .tensor import Array, MassProperties, scale_mass, six_numbers, tensor_from_six

ROUNDING = inertia_slips.ROUNDING
SPREAD = inertia_slips.SPREAD


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
        rotation: Matrix of the inertial's own ``rpy``, if it is not zero.

    Returns:
        See ``urdftool.model.inertia_slips.propose``; None as well without any geometry.
    """
    if implied is None and box is None:
        return None
    found = inertia_slips.propose(
        float(mass),
        _vector(com),
        _six(inertia),
        solid=None if implied is None else _six(scale_mass(implied, mass).inertia),
        box=None if box is None else Bounds(_vector(box[0]), _vector(box[1])),
        rotation=None if rotation is None else tuple(_vector(row) for row in rotation),
    )
    if found is None:
        return None
    return Proposal(found.kind, tensor_from_six(*found.tensor), found.sentence)


def _vector(values: Sequence[float] | Array) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _six(inertia: Array) -> Six:
    return tuple(inertia[np.triu_indices(3)].tolist())
