"""Misplaced and misspelled elements of URDF, and those of a robot by their tags."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from ...model.elements import Robot
from ...model.settings import RESISTANCE_OF_URDF
from ...model.urdf_schema import DIALECTS, VOCABULARY
from ...source.document import Element

_WRITE_DYNAMICS = "write <dynamics " + " ".join(f'{name}="…"' for name in RESISTANCE_OF_URDF) + "/>"

_ZERO_BY_DEFAULT = frozenset(
    (("origin", "xyz"), ("origin", "rpy"), ("limit", "lower"), ("limit", "upper"))
)
"""Attributes, with their element, whose default is 0."""

ELEMENT_REMEDIES = {
    ("robot", "inertial"): "write it inside a <link>",
    ("robot", "visual"): "write it inside a <link>",
    ("robot", "collision"): "write it inside a <link>",
    ("robot", "origin"): "write it in the joint of the root link, or set the pose when spawning",
    ("robot", "plugin"): "write it inside a <gazebo>",
    ("robot", "model"): "write links and joints directly in <robot>, not in an SDF <model>",
    ("link", "pose"): "write the pose in the <origin> of the parent joint",
    ("link", "origin"): "write it in the <origin> of the parent joint",
    ("link", "mass"): "write it inside <inertial>",
    ("link", "inertia"): "write it inside <inertial>",
    ("link", "geometry"): "write it inside <visual>, <collision> or both",
    ("link", "material"): "write it inside <visual>",
    ("link", "color"): "write it inside <visual><material>",
    ("link", "sensor"): 'write it inside <gazebo reference="the link">',
    ("link", "gravity"): "remove it, since gravity acts by default; to switch it off for Gazebo, "
    'write <turnGravityOff>true</turnGravityOff> inside <gazebo reference="the link">',
    ("link", "self_collide"): 'write <selfCollide> inside <gazebo reference="the link">',
    ("link", "surface"): 'write mu1, mu2, kp and kd inside <gazebo reference="the link">',
    ("link", "parent"): "only joints have a parent",
    ("visual", "pose"): "write <origin> in place of the SDF element",
    ("visual", "color"): "write it inside <material>",
    ("visual", "texture"): "write it inside <material>",
    ("geometry", "material"): "write it one level up, in <visual>",
    ("geometry", "origin"): "write it one level up, next to <geometry>",
    ("collision", "pose"): "write <origin> in place of the SDF element",
    ("collision", "surface"): 'write mu1, mu2, kp and kd inside <gazebo reference="the link">',
    ("collision", "max_contacts"): 'write <maxContacts> inside <gazebo reference="the link">',
    ("inertial", "pose"): "write <origin> in place of the SDF element",
    ("inertial", "ixx"): "write the six numbers as attributes of <inertia>",
    ("inertia", "ixx"): "write six attributes in place of the SDF elements",
    ("box", "size"): 'write <box size="x y z"/> in place of the SDF element',
    ("cylinder", "radius"): 'write <cylinder radius="…" length="…"/> in place of the SDF element',
    ("cylinder", "length"): 'write <cylinder radius="…" length="…"/> in place of the SDF element',
    ("sphere", "radius"): 'write <sphere radius="…"/> in place of the SDF element',
    ("mesh", "uri"): 'write <mesh filename="…"/> in place of the SDF element',
    ("mesh", "scale"): 'write <mesh scale="x y z"/> in place of the SDF element',
    ("material", "ambient"): "write <color rgba=…> in place of the SDF element",
    ("material", "diffuse"): "write <color rgba=…> in place of the SDF element",
    ("material", "specular"): "write <color rgba=…> in place of the SDF element",
    ("material", "script"): 'write materials of Gazebo inside <gazebo reference="the link">',
    ("joint", "pose"): "write <origin> in place of the SDF element",
    ("joint", "joint_properties"): _WRITE_DYNAMICS,
    ("joint", "joint_limits"): 'write <limit lower="…" upper="…" effort="…" velocity="…"/>',
    **{("joint", name): f'write <dynamics {name}="…"/>' for name in RESISTANCE_OF_URDF},
    ("joint", "physics"): 'write it inside <gazebo reference="the joint">',
    ("joint", "actuator"): "write it inside a <transmission>",
    ("axis", "xyz"): 'write <axis xyz="x y z"/> in place of the SDF element',
    ("axis", "limit"): "write <limit> next to <axis>, not inside as in SDF",
    ("axis", "dynamics"): "write <dynamics> next to <axis>, not inside as in SDF",
    ("limit", "lower"): "write an attribute in place of the SDF element",
    ("limit", "upper"): "write an attribute in place of the SDF element",
    ("limit", "effort"): "write an attribute in place of the SDF element",
    ("limit", "velocity"): "write an attribute in place of the SDF element",
}
"""Remedy for a misplaced element, by parent and tag."""


class Census(NamedTuple):
    """The elements of a robot by kind.

    Attributes:
        known: Elements of URDF by tag.
        unknown: Elements that are not in URDF at their place; their contents are not checked.
    """

    known: dict[str, list[Element]]
    unknown: list[Element]


def get_census(robot: Robot) -> Census:
    """Sort the elements of a robot as written."""
    return robot.memo.get("census", lambda: _make_census(robot.element))


def _make_census(root: Element) -> Census:
    known: dict[str, list[Element]] = {tag: [] for tag in VOCABULARY}
    unknown = []
    todo = [root]
    nothing: frozenset[str] = frozenset()
    while todo:
        element = todo.pop()
        tag = element.tag
        known[tag].append(element)
        if not element.children:
            continue
        children = VOCABULARY[tag].children
        dialect = DIALECTS.get(tag, nothing)
        todo += [child for child in reversed(element.children) if child.tag in children]
        for child in element.children:
            if child.tag in children:
                continue
            if ":" not in child.tag and (child.tag not in dialect or _is_of_sdf(child)):
                unknown.append(child)
    return Census(known, unknown)


def _is_of_sdf(element: Element) -> bool:
    """Tell whether an element is SDF, although PyBullet has one with the same name."""
    return element.tag == "specular" and "rgb" not in element.attributes


def is_for_another_reader(root: Element | None) -> bool:
    """Tell whether a robot has elements of Drake or MuJoCo, which other readers ignore."""
    if root is None:
        return False
    if "xmlns:drake" in root.attributes or root.find_child("mujoco") is not None:
        return True
    shapes = DIALECTS["geometry"]
    return any(
        element.tag.startswith("drake:")
        or (element.tag == "geometry" and any(child.tag in shapes for child in element.children))
        for element in root.walk()
    )


def suggest_word(word: str, words: Iterable[str]) -> str | None:
    """Find the word that a misspelled one stands for; None if none or several are similar.

    Similar is one edit in a word of up to four letters and two in a longer one: an added, missing,
    wrong letter or two swapped. Case is ignored.
    """
    lower = word.lower()
    found = [(_compute_edit_distance(lower, candidate.lower()), candidate) for candidate in words]
    found.sort()
    if not found or found[0][0] > (1 if len(word) <= 4 else 2):
        return None
    return None if len(found) > 1 and found[1][0] == found[0][0] else found[0][1]


def _compute_edit_distance(a: str, b: str) -> int:
    """Compute the edit distance of two words (optimal string alignment); 9 if it is large."""
    if abs(len(a) - len(b)) > 2:
        return 9
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        last, row, before_last = row, [i], before
        for j, y in enumerate(b, 1):
            cost = min(last[j] + 1, row[j - 1] + 1, last[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                cost = min(cost, before_last[j - 2] + 1)
            row.append(cost)
        before = last
    return row[-1]


def find_misspelled_attributes(element: Element) -> dict[str, str]:
    """Find misspelled attributes of an element, with the correct names."""
    known = VOCABULARY[element.tag].attributes
    free = [name for name in known if name not in element.attributes]
    strange = [name for name in element.attributes if name not in known and ":" not in name]
    return {name: word for name in strange if (word := suggest_word(name, free))}


def find_misspelled_children(element: Element | None) -> dict[str, str]:
    """Find misspelled tags in an element of URDF, with the correct names; none without one."""
    if element is None:
        return {}
    known = VOCABULARY[element.tag].children
    strange = {c.tag for c in element.children if c.tag not in known and ":" not in c.tag}
    strange -= DIALECTS.get(element.tag, frozenset())
    return {tag: word for tag in strange if (word := suggest_word(tag, known))}


def is_zero_default(tag: str, word: str, text: str) -> bool:
    """Tell whether a text is the default of an attribute that is 0 by default.

    Args:
        tag: Tag of the element.
        word: Name of the attribute that is meant.
        text: Value as written.
    """
    return (tag, word) in _ZERO_BY_DEFAULT and set(text) <= set("+-0. ")
