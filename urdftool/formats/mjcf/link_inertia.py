"""The mass properties of one link, as read and as MuJoCo is to read them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from lxml import etree

from ...model.elements import Link, Origin, Vector
from ...model.pose import pose_of, quaternion_of_rotation
from ...source.location import Place
from . import inertia as tensors
from .digits import number_text, numbers_text
from .frame import plain, quaternion_of
from .inertia import Array

POINT = 1e-15
"""Inertia [kg·m²] below which a body of 1 kg is a point, and a lighter one in proportion."""


@dataclass(frozen=True, eq=False)
class LinkInertia:
    """Mass properties in the link's frame.

    Attributes:
        mass: Mass [kg].
        com: Centre of mass [m].
        tensor: Inertia [kg·m²] about the centre of mass, along the link's axes.
        place: Where it is written.
        origin: The inertial frame, while the tensor is the one that is written in it.
        local: The tensor along the axes of that frame.
    """

    mass: float
    com: Vector
    tensor: Array
    place: Place
    origin: Origin | None = None
    local: Array | None = None

    @classmethod
    def about(cls, mass: float, com: Array, tensor: Array, place: Place) -> LinkInertia:
        """Mass properties that are written nowhere."""
        return cls(mass, (float(com[0]), float(com[1]), float(com[2])), tensor, place)

    @property
    def is_possible(self) -> bool:
        """Whether a rigid body can have them."""
        return tensors.is_possible(self.tensor) and (self.mass > 0 or not self.tensor.any())

    def is_heavy(self, least: float) -> bool:
        """Whether mass and every moment are above a bound."""
        return self.mass > least and bool(np.linalg.eigvalsh(self.tensor)[0] > least)

    def changed(self, tensor: Array) -> LinkInertia:
        """The same with another tensor."""
        return replace(self, tensor=(tensor + tensor.T) / 2, origin=None, local=None)


def inertia_of(link: Link) -> LinkInertia | None:
    """What a link's ``<inertial>`` says; None where it says nothing, or a negative mass."""
    inertial = link.inertial
    if inertial is None:
        return None
    mass = inertial.mass or 0.0
    local = np.zeros((3, 3))
    if inertial.inertia is not None:
        xx, yy, zz = inertial.inertia.moments
        xy, xz, yz = inertial.inertia.products
        local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if mass > 0 and abs(local).max() < POINT * min(mass, 1.0):
        local = np.zeros((3, 3))  # what arithmetic left of zeros
    if mass < 0 or not (mass or local.any()):
        return None
    pose = pose_of(inertial.origin)
    turn = np.array(pose.rotation)
    tensor = turn @ local @ turn.T
    return LinkInertia(
        mass, pose.translation, (tensor + tensor.T) / 2, inertial.place, inertial.origin, local
    )


def inertial_element(read: LinkInertia) -> etree._Element:
    """``<inertial>``, with the numbers of the source wherever MuJoCo takes them."""
    element = etree.Element("inertial", pos=numbers_text(read.com), mass=number_text(read.mass))
    quaternion = quaternion_of(read.origin) if read.origin is not None else None
    if read.local is not None and _is_diagonal(read.local):
        moments = np.diag(read.local)
        if tensors.is_safe_diagonal(moments):
            if quaternion is not None and len(set(moments.tolist())) > 1:
                element.set("quat", numbers_text(quaternion))
            element.set("diaginertia", numbers_text(moments))
            return element
    full = read.local if read.local is not None and quaternion is None else read.tensor
    if tensors.is_safe_tensor(full) and not _is_diagonal(full):
        element.set("fullinertia", numbers_text(full[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]))
        return element
    if _is_diagonal(full) and tensors.is_safe_diagonal(np.diag(full)):
        element.set("diaginertia", numbers_text(np.diag(full)))
        return element
    moments, axes = tensors.principal(full)
    turn = plain(quaternion_of_rotation(tuple(map(tuple, axes.tolist()))))  # type: ignore[arg-type]
    if turn is not None:
        element.set("quat", numbers_text(turn))
    element.set("diaginertia", numbers_text(moments))
    return element


def _is_diagonal(tensor: Array) -> bool:
    return not (tensor - np.diag(np.diag(tensor))).any()
