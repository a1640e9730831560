"""The mass properties of one link, as read and as written for MuJoCo."""

from __future__ import annotations

from dataclasses import dataclass, replace

from lxml import etree

from ...mechanics.spatial_inertia import SpatialInertia
from ...mechanics.tensor import (
    ROUNDING,
    ZERO_TENSOR,
    SymmetricTensor,
    compute_principal_moments,
    get_diagonal,
    get_excess,
    get_written_tensor,
)
from ...model.elements import ZERO, Link, Origin, Vector
from ...model.numbers import format_numbers_text, number_text
from ...model.pose import make_pose, quaternion_from_rotation
from ...source.location import Place
from . import inertia as tensors
from .frame import get_quaternion, simplify_quaternion

POINT = 1e-15
"""Inertia [kg·m²] below which a body of 1 kg is a point mass; proportional for lighter bodies."""


@dataclass(frozen=True)
class LinkInertia:
    """Mass properties in the link's frame.

    Attributes:
        body: Mass, center of mass and tensor in the link's frame.
        place: Location in the source.
        origin: Inertial frame; None after the tensor was changed.
        local: Tensor along the axes of the inertial frame; None after it was changed.
    """

    body: SpatialInertia
    place: Place
    origin: Origin | None = None
    local: SymmetricTensor | None = None

    @property
    def mass(self) -> float:
        """Return the mass [kg]."""
        return self.body.mass

    @property
    def com(self) -> Vector:
        """Return the center of mass [m]."""
        return self.body.com

    @property
    def tensor(self) -> SymmetricTensor:
        """Return the inertia tensor [kg·m²] about the center of mass, along the link's axes."""
        return self.body.tensor

    @property
    def is_possible(self) -> bool:
        """Tell whether mass and tensor are physically consistent."""
        if self.mass > 0:
            return get_excess(self.tensor, self.mass) <= ROUNDING
        return not any(self.tensor)

    def is_heavy(self, least: float) -> bool:
        """Tell whether mass and every principal moment exceed a bound."""
        return self.mass > least and compute_principal_moments(self.tensor)[0] > least

    def get_changed(self, tensor: SymmetricTensor) -> LinkInertia:
        """Return a copy with another tensor."""
        return LinkInertia(replace(self.body, tensor=tensor), self.place)


def read_inertia(link: Link) -> LinkInertia | None:
    """Read a link's ``<inertial>``; None if it is missing, empty, or has a negative mass."""
    inertial = link.inertial
    if inertial is None:
        return None
    mass = inertial.mass or 0.0
    local = get_written_tensor(inertial.inertia)
    if mass > 0 and max(map(abs, local)) < POINT * min(mass, 1.0):
        local = ZERO_TENSOR  # rounding errors of a computed zero
    if mass < 0 or not (mass or any(local)):
        return None
    body = SpatialInertia(mass, ZERO, local).transform(make_pose(inertial.origin))
    return LinkInertia(body, inertial.place, inertial.origin, local)


def build_inertial_element(read: LinkInertia) -> etree._Element:
    """Build ``<inertial>``, with the numbers of the source if MuJoCo accepts them."""
    element = etree.Element(
        "inertial", pos=format_numbers_text(read.com), mass=number_text(read.mass)
    )
    quaternion = get_quaternion(read.origin) if read.origin is not None else None
    if read.local is not None and _is_diagonal(read.local):
        diagonal = get_diagonal(read.local)
        if tensors.is_safe_diagonal(diagonal):
            if quaternion is not None and len(set(diagonal)) > 1:
                element.set("quat", format_numbers_text(quaternion))
            element.set("diaginertia", format_numbers_text(diagonal))
            return element
    full = read.local if read.local is not None and quaternion is None else read.tensor
    if tensors.is_safe_tensor(full) and not _is_diagonal(full):
        element.set("fullinertia", format_numbers_text([full[i] for i in (0, 3, 5, 1, 2, 4)]))
        return element
    if _is_diagonal(full) and tensors.is_safe_diagonal(get_diagonal(full)):
        element.set("diaginertia", format_numbers_text(get_diagonal(full)))
        return element
    moments, axes = tensors.compute_principal(full)
    turn = simplify_quaternion(quaternion_from_rotation(tuple(map(tuple, axes.tolist()))))  # type: ignore[arg-type]
    if turn is not None:
        element.set("quat", format_numbers_text(turn))
    element.set("diaginertia", format_numbers_text(moments))
    return element


def _is_diagonal(tensor: SymmetricTensor) -> bool:
    return not any(tensor[i] for i in (1, 2, 4))
