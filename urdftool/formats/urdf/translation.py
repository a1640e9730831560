"""State of an export to URDF, and elements that all its parts write."""

from __future__ import annotations

from dataclasses import dataclass, field

from lxml import etree

from ...model.elements import Origin, Robot
from ...model.numbers import NOTHING, format_numbers_text
from ...model.pose import make_pose, rpy_from_rotation
from ..written import Written
from .mesh_files import MeshFiles
from .names import Names
from .options import Options


@dataclass
class Translation:
    """State of an export."""

    robot: Robot
    options: Options
    written: Written
    names: Names
    meshes: MeshFiles
    root: etree._Element = field(default_factory=lambda: etree.Element("robot"))


def format_numbers(*values: float) -> str:
    """Return the texts of numbers, with spaces between them."""
    return format_numbers_text(values)


def add(parent: etree._Element, tag: str, text: str = "", /, **attributes: str) -> etree._Element:
    """Add an element with text and attributes."""
    node = etree.SubElement(parent, tag, attributes)
    node.text = text or None
    return node


def get_rpy(origin: Origin) -> tuple[float, float, float]:
    """Return the rotation of an origin as roll, pitch and yaw [rad]."""
    if origin.quaternion is None:
        return origin.rpy
    return rpy_from_rotation(make_pose(origin).rotation)


def add_origin(parent: etree._Element, origin: Origin | None) -> None:
    """Add ``<origin>``, unless it is the identity."""
    if origin is None:
        return
    xyz, rpy = (
        [x if abs(x) > NOTHING else 0.0 for x in part] for part in (origin.xyz, get_rpy(origin))
    )
    if any(xyz) or any(rpy):
        add(parent, "origin", xyz=format_numbers(*xyz), rpy=format_numbers(*rpy))
