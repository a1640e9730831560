"""How far the written inertia of a link is from what its geometry implies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..geometry.mesh import Array
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import principal_axes

ALIKE = 0.05
"""Two principal moments that differ by less, relatively, leave their axes undetermined."""


@dataclass(frozen=True)
class Comparison:
    """Written against implied, both at the written mass.

    Attributes:
        ratio: Principal moments, written by implied, from the smallest to the largest.
        angle: Largest angle [rad] between corresponding principal axes; None where the moments are
            too much alike to have axes.
        distance: Between the two centres of mass [m].
        density: The written mass by the volume of the geometry [kg/m³].
    """

    ratio: tuple[float, float, float]
    angle: float | None
    distance: float
    density: float

    def as_dict(self) -> dict[str, Any]:
        """The JSON form."""
        return {
            "moment_ratio": list(self.ratio),
            "axis_angle": self.angle,
            "com_distance": self.distance,
            "density": self.density,
        }


def compare(written: SpatialInertia, unit: SpatialInertia) -> Comparison:
    """Compare what is written with a body of unit density, in the same frame."""
    implied = unit.with_mass(written.mass)
    there, axes = principal_axes(written.tensor)
    meant, implied_axes = principal_axes(implied.tensor)
    ratio = [float(a / b) if b > 0 else math.inf for a, b in zip(there, meant, strict=True)]
    return Comparison(
        (ratio[0], ratio[1], ratio[2]),
        axis_angle(there, axes, meant, implied_axes),
        math.dist(written.com, unit.com),
        written.mass / unit.mass,
    )


def axis_angle(moments: Array, axes: Array, others: Array, other_axes: Array) -> float | None:
    """The largest angle [rad] between axes of one rank, where both tensors determine them."""
    angles = [
        math.acos(min(1.0, abs(float(axes[:, i] @ other_axes[:, i]))))
        for i in range(3)
        if _stands_out(moments, i) and _stands_out(others, i)
    ]
    # acos turns a rounding error of 1e-16 into an angle of 1e-8
    return max((angle if angle > 1e-7 else 0.0 for angle in angles), default=None)


def _stands_out(moments: Array, index: int) -> bool:
    size = float(np.abs(moments).max())
    gaps = [abs(float(moments[index] - moments[j])) for j in range(3) if j != index]
    return size > 0 and min(gaps) > ALIKE * size
