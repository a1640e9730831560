"""The mass properties of one link, as read and as MuJoCo is to read them."""

from __future__ import annotations

from dataclasses import dataclass, replace

from lxml import etree

from ...mechanics.spatial_inertia import SpatialInertia
from ...mechanics.tensor import (
    ZERO_TENSOR,
    SymmetricTensor,
    diagonal_of,
    principal_moments,
    written_tensor,
)
from ...model.elements import ZERO, Link, Origin, Vector
from ...model.pose import pose_of, quaternion_of_rotation
from ...source.location import Place
from . import inertia as tensors
from .digits import number_text, numbers_text
from .frame import plain, quaternion_of

POINT = 1e-15
"""Inertia [kg·m²] below which a body of 1 kg is a point, and a lighter one in proportion."""


@dataclass(frozen=True)
class LinkInertia:
    """Mass properties in the link's frame.

    Attributes:
        body: Mass, center of mass and tensor in the link's frame.
        place: Where it is written.
        origin: The inertial frame, while the tensor is the one that is written in it.
        local: The tensor along the axes of that frame.
    """

    body: SpatialInertia
    place: Place
    origin: Origin | None = None
    local: SymmetricTensor | None = None

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.body.mass

    @property
    def com(self) -> Vector:
        """Center of mass [m]."""
        return self.body.com

    @property
    def tensor(self) -> SymmetricTensor:
        """Inertia [kg·m²] about the center of mass, along the link's axes."""
        return self.body.tensor

    @property
    def is_possible(self) -> bool:
        """Whether a rigid body can have them."""
        return tensors.is_possible(self.tensor) and (self.mass > 0 or not any(self.tensor))

    def is_heavy(self, least: float) -> bool:
        """Whether mass and every moment are above a bound."""
        return self.mass > least and principal_moments(self.tensor)[0] > least

    def changed(self, tensor: SymmetricTensor) -> LinkInertia:
        """Return the same with another tensor."""
        return LinkInertia(replace(self.body, tensor=tensor), self.place)


def inertia_of(link: Link) -> LinkInertia | None:
    """What a link's ``<inertial>`` says; None where it says nothing, or a negative mass."""
    inertial = link.inertial
    if inertial is None:
        return None
    mass = inertial.mass or 0.0
    local = written_tensor(inertial.inertia)
    if mass > 0 and max(map(abs, local)) < POINT * min(mass, 1.0):
        local = ZERO_TENSOR  # what arithmetic left of zeros
    if mass < 0 or not (mass or any(local)):
        return None
    body = SpatialInertia(mass, ZERO, local).moved(pose_of(inertial.origin))
    return LinkInertia(body, inertial.place, inertial.origin, local)


def inertial_element(read: LinkInertia) -> etree._Element:
    """``<inertial>``, with the numbers of the source wherever MuJoCo takes them."""
    element = etree.Element("inertial", pos=numbers_text(read.com), mass=number_text(read.mass))
    quaternion = quaternion_of(read.origin) if read.origin is not None else None
    if read.local is not None and _is_diagonal(read.local):
        diagonal = diagonal_of(read.local)
        if tensors.is_safe_diagonal(diagonal):
            if quaternion is not None and len(set(diagonal)) > 1:
                element.set("quat", numbers_text(quaternion))
            element.set("diaginertia", numbers_text(diagonal))
            return element
    full = read.local if read.local is not None and quaternion is None else read.tensor
    if tensors.is_safe_tensor(full) and not _is_diagonal(full):
        element.set("fullinertia", numbers_text([full[i] for i in (0, 3, 5, 1, 2, 4)]))
        return element
    if _is_diagonal(full) and tensors.is_safe_diagonal(diagonal_of(full)):
        element.set("diaginertia", numbers_text(diagonal_of(full)))
        return element
    moments, axes = tensors.principal(full)
    turn = plain(quaternion_of_rotation(tuple(map(tuple, axes.tolist()))))  # type: ignore[arg-type]
    if turn is not None:
        element.set("quat", numbers_text(turn))
    element.set("diaginertia", numbers_text(moments))
    return element


def _is_diagonal(tensor: SymmetricTensor) -> bool:
    return not any(tensor[i] for i in (1, 2, 4))
