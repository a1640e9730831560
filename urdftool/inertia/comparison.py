"""Deviation of a link's written inertia from the inertia that its geometry implies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..geometry.mesh import Array
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import compute_principal_axes

ALIKE = 0.05
"""Relative difference of two principal moments below which their axes are undetermined."""


@dataclass(frozen=True)
class Comparison:
    """Written inertia relative to implied inertia, both at the written mass.

    Attributes:
        ratio: Ratios of principal moments, written over implied, in ascending order of the moments.
        angle: Largest angle [rad] between corresponding principal axes; None if none is determined.
        distance: Distance between the centers of mass [m].
        density: Written mass divided by the volume of the geometry [kg/m³].
    """

    ratio: tuple[float, float, float]
    angle: float | None
    distance: float
    density: float

    def as_dict(self) -> dict[str, Any]:
        """Return the JSON form."""
        return {
            "moment_ratio": list(self.ratio),
            "axis_angle": self.angle,
            "com_distance": self.distance,
            "density": self.density,
        }


def compare(written: SpatialInertia, unit: SpatialInertia) -> Comparison:
    """Compare written mass properties with a body of unit density in the same frame."""
    implied = unit.with_mass(written.mass)
    there, axes = compute_principal_axes(written.tensor)
    meant, implied_axes = compute_principal_axes(implied.tensor)
    ratio = [float(a / b) if b > 0 else math.inf for a, b in zip(there, meant, strict=True)]
    return Comparison(
        (ratio[0], ratio[1], ratio[2]),
        get_axis_angle(there, axes, meant, implied_axes),
        math.dist(written.com, unit.com),
        written.mass / unit.mass,
    )


def get_axis_angle(moments: Array, axes: Array, others: Array, other_axes: Array) -> float | None:
    """Return the largest angle [rad] between corresponding axes that both tensors determine.

    Args:
        moments: Principal moments, ascending, shape (3,).
        axes: Principal axes as columns, shape (3, 3).
        others: Principal moments of the other tensor.
        other_axes: Principal axes of the other tensor.
    """
    angles = [
        math.acos(min(1.0, abs(float(axes[:, i] @ other_axes[:, i]))))
        for i in range(3)
        if _is_outlier(moments, i) and _is_outlier(others, i)
    ]
    # acos amplifies a rounding error of 1e-16 to an angle of 1e-8
    return max((angle if angle > 1e-7 else 0.0 for angle in angles), default=None)


def _is_outlier(moments: Array, index: int) -> bool:
    size = float(np.abs(moments).max())
    gaps = [abs(float(moments[index] - moments[j])) for j in range(3) if j != index]
    return size > 0 and min(gaps) > ALIKE * size
