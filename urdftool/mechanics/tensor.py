"""Symmetric 3 × 3 tensors as six numbers ``xx, xy, xz, yy, yz, zz``, as URDF orders them.

An inertia tensor has the negative products of inertia off the diagonal (ixy = -∫ x y dm). Unless
stated otherwise it is about the center of mass, along the axes of the frame in use, in kg·m².
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from ..model.elements import Inertia, Vector
from ..model.link import COMPONENTS
from ..model.pose import IDENTITY_ROTATION, Rotation, multiply_matrices, transpose

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

SymmetricTensor = tuple[float, float, float, float, float, float]


ZERO_TENSOR: SymmetricTensor = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

MIN_GYRATION_RADIUS = 1e-5
"""Smallest meaningful radius of gyration [m]; moments below it are rounding noise."""

ROUNDING = 1e-9
"""Excess of a tensor, relative to its size, up to which it counts as consistent. Chosen, no source:
above the rounding of computed moments, below that of written numbers. All exports and
``urdftool inertia`` use it."""

WRITTEN_ROUNDING = 0.01
"""Excess that rounding of written numbers explains: exports lift such a tensor, and report it.
Chosen, no source."""

_CLOSE = 1e-6
"""Distance from a bound, relative to the largest moment, where it is computed exactly. Chosen, no
source."""

_SMALL = 1e-60
"""Moments below this, and above its inverse, are scaled: their cubes would overflow."""


class Consistency(NamedTuple):
    """Deviation of a tensor from physical consistency.

    A rigid body has no negative principal moment, and none above the sum of the other two (the
    triangle inequality). A negative moment breaks the inequality, too, so ``excess`` alone decides
    both. A body with all mass in a plane has an excess of 0.

    Attributes:
        moments: Principal moments [kg·m²], ascending.
        size: Largest absolute principal moment [kg·m²], or ``least_size`` if that is larger.
        excess: Largest moment minus the sum of the others, relative to ``size``; 0 if that is 0.
        negativity: Smallest moment, negated, relative to ``size``; never above the excess.
    """

    moments: Vector
    size: float
    excess: float
    negativity: float


def measure_consistency(tensor: SymmetricTensor, *, least_size: float = 0.0) -> Consistency:
    """Measure the deviation of a tensor from physical consistency; the caller picks a tolerance.

    Args:
        tensor: Inertia about the center of mass [kg·m²].
        least_size: Smallest size [kg·m²] to which excess and negativity are relative, see
            :func:`get_noise`.
    """
    moments = low, middle, high = compute_principal_moments(tensor)
    size = max(abs(low), abs(high), least_size)
    if size == 0.0:
        return Consistency(moments, 0.0, 0.0, 0.0)
    return Consistency(moments, size, (high - low - middle) / size, -low / size)


def get_noise(mass: float) -> float:
    """Return the moment [kg·m²] below which moments of a body of this mass [kg] are noise."""
    return abs(mass) * MIN_GYRATION_RADIUS**2


def get_excess(tensor: SymmetricTensor, mass: float) -> float:
    """Return the excess of a body's tensor, relative to a size that discounts noise.

    Args:
        tensor: Inertia about the center of mass [kg·m²].
        mass: Mass [kg].
    """
    return measure_consistency(tensor, least_size=get_noise(mass)).excess


@lru_cache(maxsize=4096)
def compute_principal_moments(tensor: SymmetricTensor) -> Vector:
    """Compute the eigenvalues, ascending.

    Uses the closed form, which has half the digits if two eigenvalues are equal. If one is near
    zero, or near the sum or difference of the others, uses Jacobi rotations, which are exact to
    rounding.
    """
    xx, xy, xz, yy, yz, zz = tensor
    off = xy * xy + xz * xz + yz * yz
    if off == 0.0:
        low, middle, high = sorted((xx, yy, zz))
        return low, middle, high
    size = max(map(abs, tensor))
    if 0.0 < size <= _SMALL or 1 / _SMALL <= size < math.inf:  # avoids overflow in the cube
        low, middle, high = compute_principal_moments(as_tensor([part / size for part in tensor]))
        return low * size, middle * size, high * size
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((a * a + b * b + c * c + 2 * off) / 6)
    determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    angle = math.acos(max(-1.0, min(1.0, determinant / (2 * spread**3)))) / 3
    high = mean + 2 * spread * math.cos(angle)
    low = mean + 2 * spread * math.cos(angle + 2 * math.pi / 3)
    middle = 3 * mean - high - low
    size = max(abs(low), abs(high))
    if min(abs(low), abs(low + middle - high)) <= _CLOSE * size:
        return _diagonalize(tensor)
    return low, middle, high


def _diagonalize(tensor: SymmetricTensor) -> Vector:
    xx, xy, xz, yy, yz, zz = tensor
    matrix = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    for _ in range(12):
        off = abs(matrix[0][1]) + abs(matrix[0][2]) + abs(matrix[1][2])
        if off <= 1e-17 * max(abs(matrix[i][i]) for i in range(3)):
            break
        for p, q, r in ((0, 1, 2), (0, 2, 1), (1, 2, 0)):
            apq = matrix[p][q]
            if apq == 0.0:
                continue
            theta = (matrix[q][q] - matrix[p][p]) / (2 * apq)
            t = math.copysign(1.0, theta) / (abs(theta) + math.hypot(theta, 1.0))
            cosine = 1 / math.hypot(t, 1.0)
            sine = t * cosine
            apr, aqr = matrix[p][r], matrix[q][r]
            matrix[p][p] -= t * apq
            matrix[q][q] += t * apq
            matrix[p][q] = matrix[q][p] = 0.0
            matrix[p][r] = matrix[r][p] = cosine * apr - sine * aqr
            matrix[q][r] = matrix[r][q] = sine * apr + cosine * aqr
    low, middle, high = sorted(matrix[i][i] for i in range(3))
    return low, middle, high


def compute_principal_axes(tensor: SymmetricTensor) -> tuple[Array, Array]:
    """Compute principal moments and axes with numpy.

    Returns:
        The moments, ascending, shape (3,), and a right-handed rotation matrix whose columns are
        their axes in the frame of the tensor.
    """
    import numpy as np

    moments, axes = np.linalg.eigh(to_matrix(tensor))
    if np.linalg.det(axes) < 0:
        axes = axes * np.array([1.0, 1.0, -1.0])
    return moments, axes


def rotate_tensor(tensor: SymmetricTensor, rotation: Rotation) -> SymmetricTensor:
    """Express a tensor along the axes of the parent frame, ``R T Rᵀ``.

    Args:
        tensor: Along the axes of the rotated frame.
        rotation: Matrix R that maps coordinates of the rotated frame to the parent's.
    """
    if rotation is IDENTITY_ROTATION:
        return tensor
    xx, xy, xz, yy, yz, zz = tensor
    matrix = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    (a, b, c), (_, d, e), (_, _, f) = multiply_matrices(
        multiply_matrices(rotation, matrix), transpose(rotation)
    )
    return a, b, c, d, e, f


def shift_from_com(tensor: SymmetricTensor, mass: float, offset: Vector) -> SymmetricTensor:
    """Shift a tensor from the center of mass to another point (parallel axis theorem).

    I' = I + m (|d|² E − d dᵀ), also named after Huygens and Steiner.

    Args:
        tensor: About the center of mass [kg·m²].
        mass: Mass of the body [kg].
        offset: From the point to the center of mass, or back [m].
    """
    xx, xy, xz, yy, yz, zz = tensor
    x, y, z = offset
    return (
        xx + mass * (y * y + z * z),
        xy - mass * x * y,
        xz - mass * x * z,
        yy + mass * (x * x + z * z),
        yz - mass * y * z,
        zz + mass * (x * x + y * y),
    )


def shift_to_com(tensor: SymmetricTensor, mass: float, offset: Vector) -> SymmetricTensor:
    """Shift a tensor from another point to the center of mass, see :func:`shift_from_com`."""
    return shift_from_com(tensor, -mass, offset)


def compute_second_moment(tensor: SymmetricTensor) -> SymmetricTensor:
    """Return S = ∫ x xᵀ dm [kg·m²] of an inertia tensor: S = ½ tr(I) E − I.

    A tensor is physically consistent exactly if S has no negative eigenvalue (Wensing, Kim and
    Slotine, "Linear Matrix Inequalities for Physically Consistent Inertial Parameter
    Identification", 2018).
    """
    xx, xy, xz, yy, yz, zz = tensor
    half = 0.5 * (xx + yy + zz)
    return half - xx, 0.0 - xy, 0.0 - xz, half - yy, 0.0 - yz, half - zz


def compute_inertia_from_second_moment(moment: SymmetricTensor) -> SymmetricTensor:
    """Return the inertia tensor I = tr(S) E − S [kg·m²] of S = ∫ x xᵀ dm."""
    xx, xy, xz, yy, yz, zz = moment
    trace = xx + yy + zz
    return trace - xx, 0.0 - xy, 0.0 - xz, trace - yy, 0.0 - yz, trace - zz


def get_written_tensor(inertia: Inertia | None) -> SymmetricTensor:
    """Return the six numbers of an ``<inertia>`` [kg·m²]; zeros if it is None."""
    return ZERO_TENSOR if inertia is None else inertia.six


def get_diagonal(tensor: SymmetricTensor) -> Vector:
    """Return the moments xx, yy, zz."""
    return tensor[0], tensor[3], tensor[5]


def make_diagonal_tensor(xx: float, yy: float, zz: float) -> SymmetricTensor:
    """Return the tensor with these moments and zero products of inertia."""
    return xx, 0.0, 0.0, yy, 0.0, zz


def trace_of(tensor: SymmetricTensor) -> float:
    """Return the sum of the diagonal."""
    return tensor[0] + tensor[3] + tensor[5]


def as_tensor(values: Sequence[float]) -> SymmetricTensor:
    """Convert a sequence of six numbers to a tensor."""
    xx, xy, xz, yy, yz, zz = values
    return xx, xy, xz, yy, yz, zz


def format_moments_text(tensor: SymmetricTensor) -> str:
    """Format the principal moments for a message, ascending."""
    return ", ".join(f"{moment:.6g}" for moment in compute_principal_moments(tensor))


def add_tensors(*tensors: SymmetricTensor) -> SymmetricTensor:
    """Add tensors about the same point."""
    return as_tensor([sum(values) for values in zip(*tensors, strict=True)])


def scale_tensor(tensor: SymmetricTensor, factor: float) -> SymmetricTensor:
    """Multiply a tensor by a factor."""
    return as_tensor([factor * value for value in tensor])


def get_components(tensor: SymmetricTensor) -> dict[str, float]:
    """Return the six numbers by their URDF names."""
    return dict(zip(COMPONENTS, tensor, strict=True))


def to_matrix(tensor: SymmetricTensor) -> Array:
    """Return the tensor as an array, shape (3, 3)."""
    import numpy as np

    xx, xy, xz, yy, yz, zz = tensor
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], dtype=np.float64)


def from_matrix(matrix: Array) -> SymmetricTensor:
    """Return the symmetric part of an array, shape (3, 3)."""
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = (0.5 * (matrix + matrix.T)).tolist()
    return xx, xy, xz, yy, yz, zz
