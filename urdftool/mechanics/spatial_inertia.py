"""Mass, center of mass and inertia tensor of a rigid body."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..model.attached import Attached
from ..model.elements import ZERO, Link, Vector
from ..model.pose import Pose, Rotation, compute_cross, compute_dot, compute_norm, make_pose, rotate
from .tensor import (
    ZERO_TENSOR,
    SymmetricTensor,
    as_tensor,
    compute_principal_moments,
    from_matrix,
    get_components,
    get_noise,
    get_written_tensor,
    rotate_tensor,
    scale_tensor,
    shift_from_com,
    to_matrix,
)

if TYPE_CHECKING:
    from .tensor import Array


@dataclass(frozen=True, slots=True)
class SpatialInertia:
    """Mass properties of a rigid body in one frame.

    Attributes:
        mass: Mass [kg].
        com: Center of mass [m].
        tensor: Inertia about the center of mass, along the frame's axes [kg·m²].
    """

    mass: float = 0.0
    com: Vector = ZERO
    tensor: SymmetricTensor = ZERO_TENSOR

    @classmethod
    def from_arrays(cls, mass: float, com: Array, inertia: Array) -> SpatialInertia:
        """Create one from a center of mass [m], shape (3,), and a tensor [kg·m²], shape (3, 3)."""
        x, y, z = com.tolist()
        return cls(float(mass), (x, y, z), from_matrix(inertia))

    @property
    def inertia(self) -> Array:
        """Return the tensor [kg·m²] as an array, shape (3, 3)."""
        return to_matrix(self.tensor)

    @property
    def is_thin(self) -> bool:
        """Tell whether the inertia about some axis is zero, except for rounding."""
        return compute_principal_moments(self.tensor)[0] <= get_noise(self.mass)

    @property
    def is_finite(self) -> bool:
        """Tell whether mass, center of mass and tensor are finite."""
        return all(map(math.isfinite, (self.mass, *self.com, *self.tensor)))

    @property
    def about_origin(self) -> SymmetricTensor:
        """Return the tensor about the origin of the frame [kg·m²]."""
        return shift_from_com(self.tensor, self.mass, self.com)

    def transform(self, pose: Pose) -> SpatialInertia:
        """Express the body in the parent frame, in which its own frame has this pose."""
        tensor = rotate_tensor(self.tensor, pose.rotation)
        return SpatialInertia(self.mass, pose.transform(self.com), tensor)

    def rotate(self, rotation: Rotation) -> SpatialInertia:
        """Express the body in a rotated frame of the same origin (:func:`tensor.rotate_tensor`)."""
        tensor = rotate_tensor(self.tensor, rotation)
        return SpatialInertia(self.mass, rotate(rotation, self.com), tensor)

    def compute_moment_about(self, point: Vector, axis: Vector) -> float:
        """Compute the moment of inertia [kg·m²] about an axis."""
        length = compute_norm(axis)
        unit = x, y, z = axis[0] / length, axis[1] / length, axis[2] / length
        a, b, c, d, e, f = self.tensor
        about_com = x * x * a + y * y * d + z * z * f + 2 * (x * y * b + x * z * c + y * z * e)
        (p, q, r), (s, t, u) = self.com, point
        arm = compute_cross((p - s, q - t, r - u), unit)
        return about_com + self.mass * compute_dot(arm, arm)

    def with_mass(self, mass: float) -> SpatialInertia:
        """Scale the density of the body so that its mass is this one [kg], above zero."""
        factor = mass / self.mass
        if math.isinf(factor):  # the density ratio alone may overflow
            tensor = as_tensor([value / self.mass * mass for value in self.tensor])
            return SpatialInertia(mass, self.com, tensor)
        return SpatialInertia(mass, self.com, scale_tensor(self.tensor, factor))

    def as_dict(self) -> dict[str, object]:
        """Return the JSON form: ``mass`` [kg], ``com`` [m], six numbers of ``inertia`` [kg·m²]."""
        return {
            "mass": self.mass,
            "com": list(self.com),
            "inertia": get_components(self.tensor),
        }


def combine(bodies: Iterable[SpatialInertia]) -> SpatialInertia:
    """Combine bodies in one frame into one rigid body, by the parallel axis theorem.

    Returns:
        The sum of the masses, and the sum of the tensors about the common center of mass. If the
        total mass is zero, the center of mass is the origin and tensors are added unshifted.
    """
    parts = list(bodies)
    mass = _sum(part.mass for part in parts)
    if mass == 0.0:
        return SpatialInertia(0.0, ZERO, _sum_tensors([part.tensor for part in parts]))
    x, y, z = (_sum(part.mass * part.com[axis] for part in parts) / mass for axis in range(3))
    shifted = [
        shift_from_com(part.tensor, part.mass, (part.com[0] - x, part.com[1] - y, part.com[2] - z))
        for part in parts
    ]
    return SpatialInertia(mass, (x, y, z), _sum_tensors(shifted))


def _sum_tensors(tensors: list[SymmetricTensor]) -> SymmetricTensor:
    return as_tensor([_sum(tensor[i] for tensor in tensors) for i in range(6)])


def _sum(values: Iterable[float]) -> float:
    numbers = list(values)
    try:
        return math.fsum(numbers)
    except (OverflowError, ValueError):  # beyond the range of floats, or infinite
        return sum(numbers)


def link_inertia(link: Link) -> SpatialInertia:
    """Return the mass properties of a link as written, in the link's frame.

    A missing mass or tensor counts as zero.
    """
    if link.inertial is None:
        return SpatialInertia()
    own = SpatialInertia(link.mass, ZERO, get_written_tensor(link.inertial.inertia))
    return own.transform(make_pose(link.inertial.origin))


def combine_links(members: Attached) -> SpatialInertia:
    """Combine the written mass properties of rigidly attached links with poses in one frame.

    Links without a positive mass are skipped; a missing tensor counts as zero.

    Returns:
        The rigid body in that frame.
    """
    return combine(
        SpatialInertia(link.mass, ZERO, get_written_tensor(link.inertial.inertia)).transform(
            pose @ make_pose(link.inertial.origin)
        )
        for link, pose in members
        if link.inertial is not None and link.mass > 0
    )
