"""Inertia tensors: shift, rotate, combine, principal moments, and which of them are possible.

Conventions: a tensor is the symmetric matrix with ``ixx`` … ``izz`` in URDF's sense, that is with
the negative products of inertia off the diagonal (ixy = -∫ x y dm). Unless said otherwise it is
taken about the centre of mass, along the axes of the frame at hand.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .inertia_error import InertiaError

Array = npt.NDArray[np.float64]

POSITIVITY_TOLERANCE = 1e-9
"""How far below zero the smallest principal moment may lie, relative to the largest."""

TRIANGLE_TOLERANCE = 1e-9
"""By how much the largest principal moment may exceed the sum of the others, relative to it."""


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Mass, centre of mass and inertia of one rigid body in one frame."""

    mass: float
    """Mass [kg]."""
    com: Array
    """Centre of mass [m], shape (3,), in the frame at hand."""
    inertia: Array
    """Tensor [kg·m²], shape (3, 3), about the centre of mass, along the frame's axes."""

    def as_dict(self) -> dict[str, object]:
        """The JSON form: ``mass`` [kg], ``com`` [m] and the six numbers of ``inertia`` [kg·m²]."""
        return {
            "mass": float(self.mass),
            "com": [float(value) for value in self.com],
            "inertia": six_numbers(self.inertia),
        }


def six_numbers(inertia: Array) -> dict[str, float]:
    """The tensor's six independent numbers by their URDF names [kg·m²]."""
    rows, columns = np.triu_indices(3)
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    return {name: float(inertia[i, j]) for name, i, j in zip(names, rows, columns, strict=True)}


def tensor_from_six(
    ixx: float, ixy: float, ixz: float, iyy: float, iyz: float, izz: float
) -> Array:
    """The symmetric tensor [kg·m²] of URDF's six numbers."""
    return np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]], dtype=np.float64)


def rotation_from_rpy(rpy: Sequence[float]) -> Array:
    """The rotation matrix of URDF's roll, pitch, yaw [rad].

    The turns are about the fixed axes X, then Y, then Z, so R = Rz(yaw) Ry(pitch) Rx(roll); R takes
    coordinates in the turned frame to the parent frame.
    """
    roll, pitch, yaw = (float(angle) for angle in rpy)
    cr, sr = math.cos(roll), math.sin(roll)
    cp, sp = math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rotate(inertia: Array, rotation: Array) -> Array:
    """The tensor R I Rᵀ [kg·m²]: given along a turned frame's axes, wanted along the parent's.

    Args:
        inertia: Tensor [kg·m²] along the axes of the turned frame.
        rotation: Matrix R from the turned frame to the parent, see ``rotation_from_rpy``.
    """
    return _symmetric(rotation @ inertia @ rotation.T)


def point_mass_inertia(mass: float, offset: Array) -> Array:
    """The tensor [kg·m²] about the origin of a point of ``mass`` [kg] at ``offset`` [m]."""
    offset = np.asarray(offset, dtype=np.float64)
    inertia: Array = mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))
    return inertia


def shift_from_com(inertia: Array, mass: float, offset: Array) -> Array:
    """The tensor [kg·m²] about a point at ``offset`` [m] from the centre of mass.

    Parallel axis theorem (Huygens–Steiner) in its tensor form: I' = I + m (|d|² E − d dᵀ).
    """
    return inertia + point_mass_inertia(mass, offset)


def shift_to_com(inertia: Array, mass: float, offset: Array) -> Array:
    """The tensor [kg·m²] about the centre of mass, of one about a point ``offset`` [m] from it."""
    return inertia - point_mass_inertia(mass, offset)


def move(
    properties: MassProperties,
    *,
    xyz: Sequence[float] = (0, 0, 0),
    rpy: Sequence[float] = (0, 0, 0),
) -> MassProperties:
    """The same body seen from a parent frame, in which its own frame sits at ``xyz``, ``rpy``.

    Args:
        properties: The body in its own frame.
        xyz: Origin of the body's frame in the parent frame [m].
        rpy: Fixed-axis roll, pitch, yaw of the body's frame in the parent frame [rad].
    """
    rotation = rotation_from_rpy(rpy)
    com = rotation @ properties.com + np.asarray(xyz, dtype=np.float64)
    return MassProperties(properties.mass, com, rotate(properties.inertia, rotation))


def combine(bodies: Iterable[MassProperties]) -> MassProperties:
    """Several bodies of one frame as one rigid body: masses add, tensors add about the common COM.

    Raises:
        InertiaError: There is no body, or their masses add up to nothing.
    """
    pieces = list(bodies)
    mass = math.fsum(piece.mass for piece in pieces)
    if not mass > 0:
        raise InertiaError(
            f"the {len(pieces)} bodies weigh {mass:g} kg together; a centre of mass needs a mass "
            "above zero"
        )
    com = np.array([math.fsum(p.mass * p.com[axis] for p in pieces) / mass for axis in range(3)])
    inertia = np.zeros((3, 3))
    for piece in pieces:
        inertia = inertia + shift_from_com(piece.inertia, piece.mass, piece.com - com)
    return MassProperties(mass, com, inertia)


def scale_mass(properties: MassProperties, mass: float) -> MassProperties:
    """The same body made of denser or lighter stuff, so that it weighs ``mass`` [kg]."""
    factor = mass / properties.mass
    if math.isinf(factor):  # the body's own size is in both, and may yet bring them together
        with np.errstate(over="ignore"):
            inertia = properties.inertia / properties.mass * mass
    else:
        inertia = properties.inertia * factor
    return MassProperties(float(mass), properties.com, inertia)


def principal(inertia: Array) -> tuple[Array, Array]:
    """Principal moments [kg·m²], ascending, and the principal axes.

    Returns:
        The moments, shape (3,), and a right-handed rotation matrix whose columns are their axes in
        the frame of the tensor.
    """
    moments, axes = np.linalg.eigh(_symmetric(inertia))
    if np.linalg.det(axes) < 0:
        axes = axes * np.array([1.0, 1.0, -1.0])
    return moments, axes


def second_moment(inertia: Array) -> Array:
    """The matrix S = ∫ x xᵀ dm [kg·m²] of a tensor: S = ½ tr(I) E − I.

    A tensor belongs to a rigid body exactly when S has no negative eigenvalue (Wensing, Kim and
    Slotine, "Linear Matrix Inequalities for Physically Consistent Inertial Parameter
    Identification", 2018), which is positivity and the triangle inequality in one.
    """
    return 0.5 * float(np.trace(inertia)) * np.eye(3) - inertia


def from_second_moment(moment: Array) -> Array:
    """The tensor I = tr(S) E − S [kg·m²] of the matrix S = ∫ x xᵀ dm."""
    return float(np.trace(moment)) * np.eye(3) - moment


def triangle_excess(inertia: Array) -> float:
    """By how much the largest principal moment exceeds the sum of the others, relative to it.

    Negative or zero for a possible tensor; 0 for a flat one. A zero tensor gives 0.
    """
    low, middle, high = principal(inertia)[0]
    return float((high - low - middle) / high) if high > 0 else 0.0


def is_positive(inertia: Array, *, tolerance: float = POSITIVITY_TOLERANCE) -> bool:
    """Whether no principal moment is below −``tolerance`` times the largest, and one is above 0."""
    moments = principal(inertia)[0]
    return bool(moments[2] > 0 and moments[0] >= -tolerance * moments[2])


def is_possible(
    inertia: Array,
    *,
    positivity_tolerance: float = POSITIVITY_TOLERANCE,
    triangle_tolerance: float = TRIANGLE_TOLERANCE,
) -> bool:
    """Whether a rigid body can have this tensor about its centre of mass.

    It can if the numbers are finite, no principal moment is negative and none is larger than the
    sum of the others, each within its tolerance relative to the largest moment.
    """
    if not np.all(np.isfinite(inertia)):
        return False
    return (
        is_positive(inertia, tolerance=positivity_tolerance)
        and triangle_excess(inertia) <= triangle_tolerance
    )


def require_possible(properties: MassProperties, what: str = "the result") -> MassProperties:
    """The argument itself, if a rigid body can have it.

    Raises:
        InertiaError: The mass is not above zero, or the tensor breaks positivity or the triangle
            inequality.
    """
    if not (math.isfinite(properties.mass) and properties.mass > 0):
        raise InertiaError(
            f"{what} would weigh {properties.mass:g} kg; a mass above zero is needed"
        )
    if not (np.all(np.isfinite(properties.com)) and is_possible(properties.inertia)):
        if np.all(np.isfinite(properties.inertia)):
            moments = ", ".join(f"{moment:.6g}" for moment in principal(properties.inertia)[0])
        else:
            moments = "not finite"
        raise InertiaError(
            f"{what} has principal moments {moments} kg·m², which no rigid body has: each must be "
            "positive and none larger than the sum of the other two"
        )
    return properties


def _symmetric(matrix: Array) -> Array:
    symmetric: Array = 0.5 * (matrix + matrix.T)
    return symmetric
