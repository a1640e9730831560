"""Determine which shapes urdfdom drops because of an unreadable element of their link."""

from __future__ import annotations

from ...model.link import COMPONENTS
from ...source.document import Element
from ..xml.numbers import has_readable_numbers
from .mesh_uses import MeshUse

_SHAPES = ("box", "sphere", "cylinder", "mesh")


def is_dropped(use: MeshUse) -> bool:
    """Tell whether urdfdom drops the shape of a mesh.

    urdfdom reads the inertial, the visuals and then the collisions of a link, and stops at the
    first element that it cannot read.
    """
    link = use.link.xml
    if link is None:
        return False
    if not (_reads_inertial(link) and _reads_shapes(link, "visual")):
        return True
    return use.collides and not _reads_shapes(link, "collision")


def _reads_inertial(link: Element) -> bool:
    inertial = link.find_child("inertial")
    if inertial is None:
        return True
    mass, inertia = inertial.find_child("mass"), inertial.find_child("inertia")
    if mass is None or inertia is None or not {"value"} <= mass.attributes.keys():
        return False
    if not inertia.attributes.keys() >= set(COMPONENTS):
        return False
    return all(map(has_readable_numbers, (*inertial.list_children("origin"), mass, inertia)))


def _reads_shapes(link: Element, tag: str) -> bool:
    return all(map(_reads_shape, link.list_children(tag)))


def _reads_shape(element: Element) -> bool:
    geometry = element.find_child("geometry")
    if geometry is None or not geometry.children or geometry.children[0].tag not in _SHAPES:
        return False
    return all(map(has_readable_numbers, (*element.list_children("origin"), geometry.children[0])))
