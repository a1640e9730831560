"""What URDF has: its elements, their attributes and children, and which attributes are numbers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from ...model.elements import Robot
from ...source.document import Element


class Kind(NamedTuple):
    """An element of URDF.

    Attributes:
        children: Tags of the elements it may hold.
        numbers: How many numbers each numeric attribute takes.
        words: The other attributes.
        many: Children of which there may be several; of the others readers take the first.
    """

    children: tuple[str, ...] = ()
    numbers: dict[str, int] = {}  # noqa: RUF012 -- a tuple's default, never changed
    words: tuple[str, ...] = ()
    many: tuple[str, ...] = ()


def _scalars(*names: str) -> dict[str, int]:
    return dict.fromkeys(names, 1)


VOCABULARY: dict[str, Kind] = {
    "robot": Kind(("link", "joint", "material"), words=("name", "version")),
    "link": Kind(
        ("inertial", "visual", "collision"),
        words=("name", "type"),
        many=("visual", "collision"),
    ),
    "inertial": Kind(("origin", "mass", "inertia")),
    "mass": Kind(numbers=_scalars("value")),
    "inertia": Kind(numbers=_scalars("ixx", "ixy", "ixz", "iyy", "iyz", "izz")),
    "visual": Kind(("origin", "geometry", "material"), words=("name",)),
    "collision": Kind(("origin", "geometry"), words=("name",)),
    "origin": Kind(numbers={"xyz": 3, "rpy": 3, "quat_xyzw": 4}),
    "geometry": Kind(("box", "cylinder", "sphere", "mesh", "capsule"), words=("name",)),
    "box": Kind(numbers={"size": 3}),
    "cylinder": Kind(numbers=_scalars("radius", "length")),
    "sphere": Kind(numbers=_scalars("radius")),
    "capsule": Kind(numbers=_scalars("radius", "length")),
    "mesh": Kind(numbers={"scale": 3}, words=("filename",)),
    "material": Kind(("color", "texture"), words=("name",)),
    "color": Kind(numbers={"rgba": 4}),
    "texture": Kind(words=("filename",)),
    "joint": Kind(
        (
            "origin",
            "parent",
            "child",
            "axis",
            "limit",
            "dynamics",
            "mimic",
            "safety_controller",
            "calibration",
        ),
        words=("name", "type"),
    ),
    "parent": Kind(words=("link",)),
    "child": Kind(words=("link",)),
    "axis": Kind(numbers={"xyz": 3}),
    "limit": Kind(
        numbers=_scalars(
            "lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"
        )
    ),
    "dynamics": Kind(numbers=_scalars("damping", "friction")),
    "mimic": Kind(numbers=_scalars("multiplier", "offset"), words=("joint",)),
    "safety_controller": Kind(
        numbers=_scalars("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity")
    ),
    "calibration": Kind(numbers=_scalars("rising", "falling", "reference_position")),
}

DIALECTS: dict[str, frozenset[str]] = {
    "robot": frozenset(
        (
            # ROS and Gazebo
            "gazebo",
            "transmission",
            "ros2_control",
            "sensor",
            "gripper",
            # simulators
            "mujoco",
            "loop_joint",
            "frame",
            "ball_constraint",
            "linear_bushing_rpy",
            "linear_spring_damper",
            "collision_filter_group",
            "self_collision_checking",
            "fixed_frame",
            "isaac_sim_config",
            "deformable",
            "reduced_deformable",
        )
    ),
    "link": frozenset(("contact", "audio_source", "self_collision_checking", "inertia_scaling")),
    "visual": frozenset(("meta",)),
    "collision": frozenset(("verbose", "contact_coefficients")),
    "material": frozenset(("specular",)),
    "geometry": frozenset(("plane", "cdf", "ellipsoid", "cone", "torus", "convex")),
    "joint": frozenset(("hardwareInterface",)),
}
"""Elements that URDF does not have and some reader does; what is in them is theirs."""

DIALECT_ATTRIBUTES: dict[str, frozenset[str]] = {
    "robot": frozenset(("xmlns",)),
    "link": frozenset(("concave",)),
    "collision": frozenset(("concave", "group", "mask")),
    "joint": frozenset(("dont_collapse",)),
    "limit": frozenset(("twist",)),
}
"""The same for attributes."""


class Census(NamedTuple):
    """The elements of a robot, sorted.

    Attributes:
        known: Elements of URDF by tag.
        strangers: Elements where URDF has none of that name; what is in them is not looked at.
    """

    known: dict[str, list[Element]]
    strangers: list[Element]


def census(robot: Robot) -> Census:
    """The elements of a robot as written."""
    return robot.memo.get("census", lambda: _census(robot.element))


def _census(root: Element) -> Census:
    known: dict[str, list[Element]] = {tag: [] for tag in VOCABULARY}
    strangers = []
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
                strangers.append(child)
    return Census(known, strangers)


def _is_of_sdf(element: Element) -> bool:
    """Tell whether an element is SDF's one of a name that PyBullet reads in URDF."""
    return element.tag == "specular" and "rgb" not in element.attributes


def is_for_another_reader(root: Element) -> bool:
    """Tell whether a robot uses what Drake or MuJoCo reads, and readers of plain URDF do not."""
    if "xmlns:drake" in root.attributes or root.child("mujoco") is not None:
        return True
    shapes = DIALECTS["geometry"]
    return any(
        element.tag.startswith("drake:")
        or (element.tag == "geometry" and any(child.tag in shapes for child in element.children))
        for element in root.walk()
    )


def attributes_of(tag: str) -> tuple[str, ...]:
    """The attributes an element of URDF may have."""
    kind = VOCABULARY[tag]
    return (*kind.words, *kind.numbers)


def meant(word: str, words: Iterable[str]) -> str | None:
    """Which of some words a misspelt one stands for; None where none or several are near.

    Near is one slip in a word of up to four letters and two in a longer one: a letter too many,
    missing, wrong, or two swapped. Upper and lower case count the same.
    """
    lower = word.lower()
    found = [(_slips(lower, candidate.lower()), candidate) for candidate in words]
    found.sort()
    if not found or found[0][0] > (1 if len(word) <= 4 else 2):
        return None
    return None if len(found) > 1 and found[1][0] == found[0][0] else found[0][1]


def _slips(a: str, b: str) -> int:
    """How many slips apart two words are (optimal string alignment); 9 where it is many."""
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


def misspelt_attributes(element: Element) -> dict[str, str]:
    """The attributes of an element that URDF does not have, with those they stand for."""
    known = attributes_of(element.tag)
    free = [name for name in known if name not in element.attributes]
    strange = [name for name in element.attributes if name not in known]
    return {name: word for name in strange if (word := meant(name, free))}


def misspelt_children(element: Element) -> dict[str, str]:
    """The tags in an element that URDF does not have there, with those they stand for."""
    known = VOCABULARY[element.tag].children
    strange = {child.tag for child in element.children if child.tag not in known}
    strange -= DIALECTS.get(element.tag, frozenset())
    return {tag: word for tag in strange if (word := meant(tag, known))}
