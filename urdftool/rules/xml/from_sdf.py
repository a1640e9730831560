"""Propose URDF for SDF elements."""

from __future__ import annotations

from ...model.link import COMPONENTS
from ...model.read import number, parse_numbers
from ...model.settings import LIMIT_NAMES, RESISTANCE_OF_URDF
from ...model.urdf_schema import VOCABULARY
from ...source.document import Element
from ..fix import (
    Change,
    Proposal,
    escape_attribute,
    get_written_lines,
    get_written_value,
    is_written_inside,
    remove_attribute,
    remove_element,
    rename_element,
    replace_element,
    safe,
    set_attribute,
    unsafe,
)

_AS_ATTRIBUTE = {
    "box": {"size": "size"},
    "cylinder": {"radius": "radius", "length": "length"},
    "sphere": {"radius": "radius"},
    "mesh": {"uri": "filename", "scale": "scale"},
    "axis": {"xyz": "xyz"},
    "limit": {name: name for name in LIMIT_NAMES},
    "inertia": {name: name for name in COMPONENTS},
}

"""Child elements of SDF that are attributes in URDF, by parent element."""


def propose_urdf_spelling(element: Element, parent: Element) -> Proposal | None:
    """Propose the URDF form of an element of SDF or of a similar dialect."""
    tag, inside = element.tag, parent.tag
    text = " ".join(element.text.split())
    name = _AS_ATTRIBUTE.get(inside, {}).get(tag)
    if name is not None:
        if name in parent.attributes or element.children or not text or "$" in text:
            return None
        return unsafe(
            f'write {name}="{text}"', remove_element(element), set_attribute(parent, name, text)
        )
    if tag == "pose" and not element.children:
        return _convert_pose(element, parent, text)
    if inside == "joint" and tag == "joint_properties":
        known = {*RESISTANCE_OF_URDF}
        if parent.find_child("dynamics") is None and known & element.attributes.keys() <= known:
            extra = [remove_attribute(element, n) for n in element.attributes if n not in known]
            if known & element.attributes.keys():
                return unsafe("write <dynamics>", *extra, rename_element(element, "dynamics"))
        return None
    if inside == "joint" and tag in RESISTANCE_OF_URDF and not element.attributes:
        if number(text) is not None and parent.find_child("dynamics") is None:
            if sum(child.tag in RESISTANCE_OF_URDF for child in parent.children) == 1:
                return unsafe(
                    f'write <dynamics {tag}="{text}"/>',
                    replace_element(element, (f'<dynamics {tag}="{text}"/>',)),
                )
        return None
    if (inside, tag) == ("collision", "surface"):
        return _move_surface(element, parent)
    if inside == "geometry":
        return move_out_of_geometry(element, parent)
    return None


def move_out_of_geometry(element: Element, geometry: Element) -> Proposal | None:
    """Move a ``<material>`` or ``<origin>`` from a ``<geometry>`` to the visual or collision.

    The fix is safe if it only adds a color.
    """
    shape = geometry.parent
    if shape is None or element.tag not in VOCABULARY[shape.tag].children:
        return None
    if shape.find_child(element.tag) is not None:
        return None
    if not (is_written_inside(element, geometry) and is_written_inside(geometry, shape)):
        return None
    lines = tuple(get_written_lines(element))
    is_first = element is geometry.children[0]
    make = safe if element.tag == "material" and not is_first else unsafe
    message = f"move the <{element.tag}> to the <{shape.tag}>"
    return make(message, remove_element(element), Change("after", geometry, blocks=(lines,)))


def _convert_pose(element: Element, parent: Element, text: str) -> Proposal | None:
    values = parse_numbers(text, 6)
    if values is None:
        return None
    if not any(values):
        return safe("remove it: it is the identity", remove_element(element))
    if (
        parent.tag not in ("visual", "collision", "inertial")
        or parent.find_child("origin") is not None
    ):
        return None
    words = text.split()
    line = f'<origin xyz="{" ".join(words[:3])}" rpy="{" ".join(words[3:])}"/>'
    return unsafe(f"write {line}", replace_element(element, (line,)))


def _move_surface(element: Element, collision: Element) -> Proposal | None:
    """Move a ``<surface>`` to the ``<gazebo>`` block that Gazebo reads."""
    link = collision.parent
    if link is None or link.tag != "link" or link.parent is None or not element.children:
        return None
    if sum(child.tag == "collision" for child in link.children) != 1:
        return None
    name = get_written_value(link, "name")
    if not name:
        return None
    lines = (
        f'<gazebo reference="{escape_attribute(name)}">',
        "\t<collision>",
        *(f"\t\t{line}" for line in get_written_lines(element)),
        "\t</collision>",
        "</gazebo>",
    )
    return unsafe(
        f'write it into <gazebo reference="{name}"><collision>',
        remove_element(element),
        Change("after", link, blocks=(lines,)),
    )
