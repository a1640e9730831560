"""Fixes of words and numbers."""

from __future__ import annotations

import math
import re

from ...model.elements import Joint
from ...model.pose import rotation_of_quaternion, rpy_of_rotation
from ...model.read import number, numbers
from ...source.document import Element
from ..rule import Problem
from ..xml.shape import shapes_in
from ..xml.vocabulary_table import VOCABULARY, attributes_of, misspelt_children
from ..xml.vocabulary_table import meant as the_word_for
from .proposal import (
    Around,
    Change,
    Proposal,
    attribute_at,
    drop,
    element_at,
    figures,
    lines_of,
    put,
    quote,
    remove,
    rename,
    replace,
    retag,
    safe,
    same,
    stands_in,
    sub,
    unsafe,
    written,
)

_ONE = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def missing_name(problem: Problem, around: Around) -> Proposal | None:
    """The robot's name is that of its file."""
    element = problem.element
    stem = re.sub(r"\W+", "_", around.description.files[0].path.rpartition("/")[2].split(".")[0])
    if element.tag != "robot" or not stem.strip("_") or element.attributes.get("name", "").strip():
        return None
    return unsafe(f'call the robot "{stem}", as its file', put(element, "name", stem))


_AS_ATTRIBUTE = {
    "box": {"size": "size"},
    "cylinder": {"radius": "radius", "length": "length"},
    "sphere": {"radius": "radius"},
    "mesh": {"uri": "filename", "scale": "scale"},
    "axis": {"xyz": "xyz"},
    "limit": {name: name for name in ("lower", "upper", "effort", "velocity")},
    "inertia": {name: name for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")},
}
"""What SDF writes as elements and URDF as attributes, by the element around it."""


def unknown_element(problem: Problem, around: Around) -> Proposal | None:
    """The word that was meant, or the way URDF says it."""
    element = problem.element
    parent = element.parent
    if parent is None:
        return None
    told = _told_as_sdf(element, parent)
    if told is not None:
        return told
    word = the_word_for(element.tag, VOCABULARY[parent.tag].children)
    if word is None:
        return None
    if parent.child(word) is not None and word not in VOCABULARY[parent.tag].many:
        return None
    return unsafe(f"write <{word}>", retag(element, word))


def _told_as_sdf(element: Element, parent: Element) -> Proposal | None:
    """What is written as in SDF, or as in another dialect, as URDF writes it."""
    tag, inside = element.tag, parent.tag
    text = " ".join(element.text.split())
    name = _AS_ATTRIBUTE.get(inside, {}).get(tag)
    if name is not None:
        if name in parent.attributes or element.children or not text or "$" in text:
            return None
        return unsafe(f'write {name}="{text}"', remove(element), put(parent, name, text))
    if tag == "pose" and not element.children:
        return _as_origin(element, parent, text)
    if inside == "joint" and tag == "joint_properties":
        known = {"damping", "friction"}
        if parent.child("dynamics") is None and known & element.attributes.keys() <= known:
            extra = [drop(element, n) for n in element.attributes if n not in known]
            if known & element.attributes.keys():
                return unsafe("write <dynamics>", *extra, retag(element, "dynamics"))
        return None
    if inside == "joint" and tag in ("damping", "friction") and not element.attributes:
        if number(text) is not None and parent.child("dynamics") is None:
            if sum(child.tag in ("damping", "friction") for child in parent.children) == 1:
                return unsafe(
                    f'write <dynamics {tag}="{text}"/>',
                    replace(element, (f'<dynamics {tag}="{text}"/>',)),
                )
        return None
    if (inside, tag) == ("collision", "surface"):
        return _surface(element, parent)
    if inside == "geometry":
        return moved_up(element, parent)
    return None


def moved_up(element: Element, geometry: Element) -> Proposal | None:
    """Move a ``<material>`` or ``<origin>`` from a ``<geometry>`` to the visual or collision.

    It is safe where only a color comes of it.
    """
    around = geometry.parent
    if around is None or element.tag not in VOCABULARY[around.tag].children:
        return None
    if around.child(element.tag) is not None:
        return None
    if not (stands_in(element, geometry) and stands_in(geometry, around)):
        return None
    lines = tuple(lines_of(element))
    is_first = element is geometry.children[0]
    make = safe if element.tag == "material" and not is_first else unsafe
    message = f"move the <{element.tag}> to the <{around.tag}>"
    return make(message, remove(element), Change("after", geometry, blocks=(lines,)))


def _as_origin(element: Element, parent: Element, text: str) -> Proposal | None:
    values = numbers(text, 6)
    if values is None:
        return None
    if not any(values):
        return safe("take it away: it moves nothing", remove(element))
    if parent.tag not in ("visual", "collision", "inertial") or parent.child("origin") is not None:
        return None
    words = text.split()
    line = f'<origin xyz="{" ".join(words[:3])}" rpy="{" ".join(words[3:])}"/>'
    return unsafe(f"write {line}", replace(element, (line,)))


def _surface(element: Element, collision: Element) -> Proposal | None:
    """A ``<surface>`` moved to where Gazebo reads it."""
    link = collision.parent
    if link is None or link.tag != "link" or link.parent is None or not element.children:
        return None
    if sum(child.tag == "collision" for child in link.children) != 1:
        return None
    name = written(link, "name")
    if not name:
        return None
    lines = (
        f'<gazebo reference="{quote(name)}">',
        "\t<collision>",
        *(f"\t\t{line}" for line in lines_of(element)),
        "\t</collision>",
        "</gazebo>",
    )
    return unsafe(
        f'write it into <gazebo reference="{name}"><collision>',
        remove(element),
        Change("after", link, blocks=(lines,)),
    )


def unknown_attribute(problem: Problem, around: Around) -> Proposal | None:
    """The word that was meant."""
    found = attribute_at(problem)
    if found is None:
        return None
    element, name = found
    if (element.tag, name) == ("axis", "rpy"):
        return safe("take it away: a direction has no rotation", drop(element, name))
    free = [word for word in attributes_of(element.tag) if word not in element.attributes]
    direct = {"pos", "position", "rot", "rotation", "orientation", "mass", "min", "max", "height"}
    direct |= {"dimensions", "uri", "file", "url", "name", "value"}
    match = re.search(r"; write ([a-z]+)$", problem.message)
    word = match[1] if match else None
    if word not in free or (name not in direct and the_word_for(name, free) != word):
        return None
    count = VOCABULARY[element.tag].numbers.get(word)
    if count is not None and numbers(element.get(name), count) is None:
        if count != 1 or number(element.get(name)) is None:
            return None
    return unsafe(f"write {word}", rename(element, name, word))


def repeated_element(problem: Problem, around: Around) -> Proposal | None:
    """The first stays, which is the one that is read."""
    element = problem.element
    parent = element.parent
    if parent is None:
        return None
    one = parent.child(element.tag)
    if one is None or one is element:
        return None
    if same(one, element) or element.tag == "material":
        return safe(f"keep the first <{element.tag}>, which is read", remove(element))
    return unsafe(f"keep the first <{element.tag}>, which is read", remove(element))


def several_shapes_in_geometry(problem: Problem, around: Around) -> Proposal | None:
    """Each shape gets a visual or collision of its own."""
    shape = problem.element
    geometry = shape.parent
    around_it = geometry.parent if geometry is not None else None
    if geometry is None or around_it is None or around_it.tag not in ("visual", "collision"):
        return None
    changes: list[Change] = []
    for other in shapes_in(geometry)[1:]:
        inside = [line for c in around_it.all("origin") for line in lines_of(c)]
        material = [line for c in around_it.all("material") for line in lines_of(c)]
        lines = (
            f"<{around_it.tag}>",
            *(f"\t{line}" for line in inside),
            "\t<geometry>",
            *(f"\t\t{line}" for line in lines_of(other)),
            "\t</geometry>",
            *(f"\t{line}" for line in material),
            f"</{around_it.tag}>",
        )
        changes += [remove(other), Change("after", around_it, blocks=(lines,))]
    return unsafe(f"give each shape a <{around_it.tag}> of its own", *changes)


def empty_geometry(problem: Problem, around: Around) -> Proposal | None:
    """The shape of its one counterpart; without one, a visual or collision of nothing goes."""
    element = element_at(problem)
    while element is not None and element.tag not in ("visual", "collision"):
        element = element.parent
    if element is None or misspelt_children(element):
        return None
    geometry = element.child("geometry")
    if geometry is not None and geometry.children:
        return None
    link = element.parent
    other = "collision" if element.tag == "visual" else "visual"
    shapes = [g for c in link.all(other) for g in c.all("geometry")] if link is not None else []
    if len(shapes) == 1 and len(shapes[0].children) == 1:
        lines = tuple(lines_of(shapes[0]))
        origin = element.child("origin")
        if geometry is not None:
            change = replace(geometry, lines)
        elif origin is not None:
            change = Change("after", origin, blocks=(lines,))
        else:
            change = Change("first", element, blocks=(lines,))
        return unsafe(f"give it the shape of the {other}", change)
    return unsafe(f"take the empty <{element.tag}> out", remove(element))


def tab_or_newline_in_vector(problem: Problem, around: Around) -> Proposal | None:
    """Write single blanks between the numbers.

    urdfdom and PyBullet split at blanks alone: what they drop or take for zero until then, they
    read afterwards.
    """
    found = attribute_at(problem)
    if found is None:
        return None
    element, name = found
    return unsafe("write single blanks", sub(element, name, r"\s+", " "))


def not_a_number(problem: Problem, around: Around) -> Proposal | None:
    """Remove blanks around it; write a point for a comma.

    urdfdom drops the inertial or the shape with such a number, and has it afterwards.
    """
    found = attribute_at(problem)
    if found is None:
        return None
    element, name = found
    text = element.get(name) or ""
    if text != text.strip() and number(text.strip()) is not None:
        return unsafe(f'write "{text.strip()}"', sub(element, name, r"^\s+|\s+$", ""))
    words = text.split()
    count = VOCABULARY[element.tag].numbers.get(name, 1)
    if len(words) == count and all(re.fullmatch(r"[-+]?\d*[.,]?\d+", word) for word in words):
        new = " ".join(word.replace(",", ".") for word in words)
        return unsafe(f'write "{new}"', put(element, name, new))
    parts = text.replace(",", " ").split()
    if count > 1 and len(parts) == count and all(re.fullmatch(_ONE, part) for part in parts):
        new = " ".join(parts)
        return unsafe(f'write "{new}"', put(element, name, new))
    return None


def wrong_arity(problem: Problem, around: Around) -> Proposal | None:
    """Make a color without opacity opaque; write one scale for all three axes.

    urdfdom drops a mesh with one scale, and has it afterwards.
    """
    found = attribute_at(problem)
    if found is None:
        return None
    element, name = found
    words = (element.get(name) or "").split()
    if name == "rgba" and len(words) == 3:
        return safe("write 1 as the fourth number", put(element, name, " ".join([*words, "1"])))
    if name == "scale" and len(words) == 1:
        return unsafe("write it three times", put(element, name, " ".join(words * 3)))
    return None


def wrong_case_keyword(problem: Problem, around: Around) -> Proposal | None:
    """Write it in lower case.

    Every reader rejects a joint type, a parent or a child in another case. Of all other words they
    ignore what is written, and read it afterwards.
    """
    found = attribute_at(problem)
    if found is not None:
        element, name = found
        if name == "type" and element.tag == "joint":
            lower = (element.get(name) or "").lower()
            return safe(f"write {lower}", put(element, name, lower))
        return unsafe(f"write {name.lower()}", rename(element, name, name.lower()))
    element = problem.element
    if isinstance(problem.subject, Joint) or element.tag == element.tag.lower():
        return None
    parent, lower = element.parent, element.tag.lower()
    if parent is None or (
        parent.child(lower) is not None and lower not in VOCABULARY[parent.tag].many
    ):
        return None
    make = safe if parent.tag == "joint" and lower in ("parent", "child") else unsafe
    return make(f"write <{lower}>", retag(element, lower))


def padded_reference(problem: Problem, around: Around) -> Proposal | None:
    """Remove the blank.

    Every reader rejects a robot whose joint does not find its parent or child. A mimic joint that
    does not find its leader, and a block of Gazebo that does not find its link, are ignored, and
    are there afterwards.
    """
    found = attribute_at(problem)
    if found is None:
        return None
    element, name = found
    ends = {end for joint in around.robot.joints for end in (joint.parent, joint.child)}
    joins = element.tag in ("parent", "child")
    joins = joins or (element.tag == "link" and (element.get(name) or "").strip() in ends)
    make = safe if joins else unsafe
    return make("take the blank away", sub(element, name, r"^\s+|\s+$", ""))


def unsupported_urdf_version(problem: Problem, around: Around) -> Proposal | None:
    """1.0, where nothing newer is used."""
    if "do without" in problem.message:
        return None
    return unsafe('write version="1.0"', put(problem.element, "version", "1.0"))


def feature_needs_newer_version(problem: Problem, around: Around) -> Proposal | None:
    """A quaternion as rpy; a capsule as a cylinder and two spheres."""
    element = element_at(problem)
    if element is None:
        return None
    if element.tag == "origin" and "quat_xyzw" in element.attributes:
        quaternion = numbers(element.get("quat_xyzw"), 4)
        if quaternion is None or math.hypot(*quaternion) < 1e-9:
            return None
        x, y, z, w = quaternion
        rpy = figures(rpy_of_rotation(rotation_of_quaternion((w, x, y, z))), 12)
        return unsafe(f'write rpy="{rpy}"', drop(element, "quat_xyzw"), put(element, "rpy", rpy))
    return None


def rpy_and_quat(problem: Problem, around: Around) -> Proposal | None:
    """The rpy, which is what readers of URDF 1.0 take."""
    found = attribute_at(problem)
    if found is None:
        return None
    return unsafe("keep rpy", drop(found[0], "quat_xyzw"))
