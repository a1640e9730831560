"""Rules on unknown elements and attributes."""

from __future__ import annotations

from collections.abc import Iterator

from ...diagnostic import Severity
from ...model.elements import Joint, Robot
from ...model.joint import JOINT_TYPES
from ...model.read import number, parse_numbers
from ...model.settings import RESISTANCE_OF_URDF
from ...model.urdf_schema import BLOCKS, DIALECT_ATTRIBUTES, VOCABULARY
from ...source.description import Description
from ...source.document import Element
from ...source.xacro_names import UNPREFIXED
from ..fix import (
    FixContext,
    Proposal,
    find_attribute,
    remove_attribute,
    rename_attribute,
    rename_element,
    safe,
    set_attribute,
    unsafe,
)
from ..rule import BOTH, ERROR, INFO, WARNING, Problem, rule, select_holding
from ..xacro.definitions import get_macro_names
from .from_sdf import propose_urdf_spelling
from .owner import describe_owner
from .vocabulary_table import ELEMENT_REMEDIES, get_census, is_zero_default, suggest_word

_HARMLESS = frozenset((("collision", "material"),))
"""Elements that readers ignore without a loss. They are not reported."""

_OTHER_NAMES = {
    ("origin", "pos"): "xyz",
    ("origin", "position"): "xyz",
    ("origin", "rot"): "rpy",
    ("origin", "rotation"): "rpy",
    ("origin", "orientation"): "rpy",
    ("origin", "quat"): "rpy",
    ("mass", "mass"): "value",
    ("box", "dimensions"): "size",
    ("cylinder", "height"): "length",
    ("sphere", "size"): "radius",
    ("mesh", "uri"): "filename",
    ("mesh", "file"): "filename",
    ("mesh", "url"): "filename",
    ("texture", "uri"): "filename",
    ("texture", "file"): "filename",
    ("color", "value"): "rgba",
    ("parent", "name"): "link",
    ("child", "name"): "link",
    ("parent", "joint"): "link",
    ("child", "joint"): "link",
    ("mimic", "name"): "joint",
    ("limit", "min"): "lower",
    ("limit", "max"): "upper",
}
"""Attribute that a wrong name stands for, by element and name."""

_ATTRIBUTE_REMEDIES = {
    ("axis", "rpy"): "write the rotated axis in xyz",
    ("origin", "x"): 'write xyz="x y z"',
    ("box", "x"): 'write size="x y z"',
    ("box", "length"): 'write size="x y z"',
    ("cylinder", "diameter"): "write radius, which is half of it",
    ("sphere", "diameter"): "write radius, which is half of it",
    ("color", "rgb"): "write rgba, with a fourth number for opacity",
    ("material", "rgba"): 'write <color rgba="…"/> inside it',
    ("material", "color"): 'write <color rgba="…"/> inside it',
    ("limit", "k_velocity"): "write it in <safety_controller>",
    ("limit", "k_position"): "write it in <safety_controller>",
    ("limit", "soft_lower_limit"): "write it in <safety_controller>",
    ("limit", "soft_upper_limit"): "write it in <safety_controller>",
    **{("limit", name): "write it in <dynamics>" for name in RESISTANCE_OF_URDF},
    ("joint", "parent"): 'write <parent link="…"/> inside it',
    ("joint", "child"): 'write <child link="…"/> inside it',
    ("inertia", "mass"): 'write <mass value="…"/> next to it',
}
"""Remedy for a wrong attribute, by element and name."""


_DOCUMENTATION = frozenset(("name", "id", "comment", "note", "description"))
"""Attributes that document an element; readers lose nothing."""

_REDUNDANT = ("iyx", "izx", "izy")

_WITH_DEFAULT = {
    "origin": ("xyz", "rpy"),
    "axis": ("xyz",),
    "limit": ("lower", "upper"),
    "mesh": ("scale",),
    "mimic": ("multiplier", "offset"),
}
"""Optional attributes, by element."""

_OF_FRANKA = frozenset(("D", "K", "mu_coulomb", "mu_viscous"))
"""Attributes of ``<dynamics>`` in franka_description, next to those of URDF."""


_NEEDED = {
    "robot": ("link", "joint"),
    "joint": ("parent", "child", "limit"),
    "inertial": ("mass", "inertia"),
    "visual": ("geometry",),
    "collision": ("geometry",),
}
"""Elements without which most readers reject the robot, or drop a part, by the one around them."""

_UNITS = ("unit", "units")
"""Attributes that name other units than m, kg, s and rad; no reader reads them."""


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "ignore it, without a message"
        ),
    },
    group="repository",
)
def unknown_element(robot: Robot, description: Description) -> Iterator[Problem]:
    """An element is not in URDF at this place.

    Readers ignore unknown elements without a message. With a misspelled ``<colision>`` the link
    falls through the ground; with an ``<inertia>`` outside ``<inertial>`` it has no mass. SDF
    elements in a URDF are ignored too. An element that is not similar to any of URDF may be for a
    different program; it is an info, and so is a misspelled ``<origin>`` of zeros. A misspelled
    ``<gazebo>``, ``<transmission>`` or ``<ros2_control>`` is a warning. A
    ``<material>`` in a ``<collision>`` is not reported: a collision has no color, and nothing is
    lost. ``<collision_checking>`` is an extension of pinocchio; it is reported if it names a shape
    that is not the name of a ``<collision>`` of the link.
    """
    yield from _report_unnamed_shapes(robot)
    unknown = get_census(robot).unknown
    in_xacro = bool(unknown) and description.expansion is not None
    of_xacro = UNPREFIXED | get_macro_names(description) if in_xacro else frozenset()
    other: dict[tuple[str, str], list[Element]] = {}
    file = str(description.packages.file)
    for element in unknown:
        parent = element.parent
        if parent is None or parent.tag == "dynamics" or element.tag in of_xacro:
            continue
        if (parent.tag, element.tag) in _HARMLESS:
            continue
        if element.tag == "origin" and _moves_nothing(element):
            continue
        if element.tag == "gravity" and number(element.text.strip()) == 1:
            continue  # it acts anyway
        if parent.tag == "geometry" and not _is_misplaced(element, parent):
            continue
        word = suggest_word(element.tag, VOCABULARY[parent.tag].children)
        instead = ELEMENT_REMEDIES.get((parent.tag, element.tag))
        block = suggest_word(element.tag, BLOCKS) if parent.tag == "robot" and not word else None
        if block is not None and not instead:
            what = f"{_describe(parent)} has the unknown element <{element.tag}>; write <{block}>"
            yield Problem(element, what, alike=(file, "block", element.tag))
        elif word is None and not instead:
            other.setdefault((parent.tag, element.tag), []).append(element)
        elif instead:
            what = f"<{element.tag}> does not belong in {_describe(parent)}; {instead}"
            yield Problem(element, what, alike=(file, parent.tag, element.tag))
        elif word is not None and word != element.tag.lower():
            what = f"{_describe(parent)} has the unknown element <{element.tag}>; write <{word}>"
            is_needless = word == "origin" and _moves_nothing(element)
            severity = INFO if is_needless else ERROR
            alike = (file, parent.tag, element.tag)
            effects = () if word in _NEEDED.get(parent.tag, ()) else None  # see unknown-attribute
            yield Problem(element, what, severity=severity, effects=effects, alike=alike)
    for kind, elements in other.items():
        where = f"{_describe(elements[0].parent)}{_format_count(elements)}"
        message = f"<{kind[1]}> does not belong in {where}; URDF readers ignore it"
        yield Problem(
            elements[0],
            message,
            severity=INFO,
            alike=kind,
            group=f"<{kind[1]}> does not belong in <{kind[0]}>; URDF readers ignore it "
            "(in {count} places)",
        )


def _report_unnamed_shapes(robot: Robot) -> Iterator[Problem]:
    """Report shapes that ``<collision_checking>`` of pinocchio (run with 4.1) does not find."""
    for link in robot.links:
        names = {collision.name for collision in link.collisions}
        for element in link.element.list_children("collision_checking"):
            for child in element.children:
                name = child.get("name")
                if child.tag in ("capsule", "convex") and name and name not in names:
                    yield Problem(
                        child,
                        f"<{child.tag}> names '{name}', but no <collision> of link '{link.name}' "
                        f'has that name, so pinocchio ignores it; write <collision name="{name}">',
                        effects=(),
                        alike=child.tag,
                    )


def _moves_nothing(element: Element) -> bool:
    """Tell whether an ``<origin>`` does not move anything, as exporters write one into links."""
    words = f"{element.get('xyz') or ''} {element.get('rpy') or ''}".split()
    return all(number(word) == 0 for word in words)


def _is_misplaced(element: Element, geometry: Element) -> bool:
    """Tell whether an unknown element in a ``<geometry>`` is not read as a shape."""
    return element.tag in VOCABULARY and element is not geometry.children[0]


_ATTRIBUTE_EFFECTS = {
    "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
        "ignore it, without a message"
    ),
    "urdfdom, gz, gazebo-classic, pybullet, pinocchio (one with a default is meant)": (
        "take the default of the intended attribute"
    ),
}


@unknown_element.fix(BOTH, reveals=True)
def write_known_element(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the element with the most similar name, or the URDF form of an SDF element."""
    element = problem.element
    parent = element.parent
    if parent is None or parent.tag not in VOCABULARY:
        return None
    proposal = propose_urdf_spelling(element, parent)
    if proposal is not None:
        return proposal
    word = suggest_word(element.tag, VOCABULARY[parent.tag].children)
    if word is None:
        return None
    if parent.find_child(word) is not None and word not in VOCABULARY[parent.tag].many:
        return None
    return unsafe(f"write <{word}>", rename_element(element, word))


@rule(
    WARNING,
    effects=_ATTRIBUTE_EFFECTS,
    group="robot",
    pedantic=f"additional parameters of a <dynamics> that has {' and '.join(RESISTANCE_OF_URDF)}",
)
def unknown_attribute(robot: Robot) -> Iterator[Problem]:
    """An attribute is not in URDF for this element.

    Readers ignore it without a message, and take the default of the intended attribute: a
    misspelled ``uper`` makes the upper limit 0, and a cylinder with ``height`` has no length. An
    unknown attribute whose value is 0 is not reported, because it has no effect; a misspelled one
    is an info if its value is the default. An attribute for a different program is an info if the
    element has all required attributes, such as an additional parameter of a ``<dynamics>`` or a
    ``<limit>``. An attribute that names units is a warning: numbers are in m, kg, s and rad.
    """
    nothing: frozenset[str] = frozenset()
    other: dict[tuple[str, tuple[str, ...], Severity], list[Element]] = {}
    for tag, elements in get_census(robot).known.items():
        known = {*VOCABULARY[tag].attributes, *DIALECT_ATTRIBUTES.get(tag, nothing)}
        for element in elements:
            if element.attributes.keys() <= known:
                continue
            yield from _report_misspelled_attributes(element, known)
            strange = [
                n
                for n in _iterate_unknown_attributes(element, known)
                if _is_unsuggested(element, n)
                and number(element.get(n)) != 0
                and not (n in _OF_FRANKA and {*RESISTANCE_OF_URDF} <= element.attributes.keys())
            ]
            for severity in (WARNING, INFO):
                is_info = severity is INFO
                names = tuple(n for n in strange if _is_ignorable(element, n) == is_info)
                if names:
                    other.setdefault((tag, names, severity), []).append(element)
    for (_, names, severity), elements in other.items():
        first = elements[0]
        which = ", ".join(f"'{name}'" for name in names)
        words, them = ("attributes", "them") if len(names) > 1 else ("attribute", "it")
        yield Problem(
            first,
            f"{_describe(first)}{_format_count(elements)} has the unknown {words} {which}; "
            f"URDF readers ignore {them}",
            at=first.locate_attribute(names[0]),
            severity=severity,
            effects=select_holding(_ATTRIBUTE_EFFECTS),
            pedantic=severity is INFO and first.tag == "dynamics",
            alike=(first.tag, len(names) > 1, len(elements) > 1),
        )


def _is_ignorable(element: Element, name: str) -> bool:
    """Tell whether readers lose nothing if they ignore an attribute."""
    if name in _DOCUMENTATION or (element.tag, name) == ("robot", "path"):  # as foam writes it
        return True
    if name in _UNITS:
        return False
    tag = element.tag
    optional = (*_WITH_DEFAULT.get(tag, ()), *VOCABULARY[tag].unread)
    needed = set(VOCABULARY[tag].attributes).difference(optional)
    return bool(needed) and needed <= element.attributes.keys()


def _iterate_unknown_attributes(element: Element, known: set[str]) -> Iterator[str]:
    for name in element.attributes:
        if name not in known and ":" not in name and name not in _REDUNDANT:
            if not _is_zero_rotation(element, name):
                yield name


def _is_zero_rotation(element: Element, name: str) -> bool:
    """Tell whether an attribute is a zero rotation of an axis, which has no effect."""
    text = element.attributes[name]
    return (element.tag, name) == ("axis", "rpy") and set(text) <= set("+-0. ")


def _is_unsuggested(element: Element, name: str) -> bool:
    """Tell whether the intended attribute is unknown."""
    kind = (element.tag, name)
    return (
        kind not in _ATTRIBUTE_REMEDIES
        and kind not in _OTHER_NAMES
        and _suggest_attribute(element, name) is None
    )


def _suggest_attribute(element: Element, name: str) -> str | None:
    return suggest_word(
        name, [w for w in VOCABULARY[element.tag].attributes if w not in element.attributes]
    )


def _report_misspelled_attributes(element: Element, known: set[str]) -> Iterator[Problem]:
    for name in _iterate_unknown_attributes(element, known):
        what = f"{_describe(element)} has the unknown attribute '{name}'"
        at = element.locate_attribute(name)
        kind = (element.tag, name)
        if kind in _ATTRIBUTE_REMEDIES:
            effects = select_holding(_ATTRIBUTE_EFFECTS)
            message = f"{what}; {_ATTRIBUTE_REMEDIES[kind]}"
            yield Problem(element, message, at=at, effects=effects, alike=kind)
            continue
        word = _OTHER_NAMES.get(kind) or _suggest_attribute(element, name)
        if word is not None and word != name.lower():
            has_default = word in _WITH_DEFAULT.get(element.tag, ())
            yield Problem(
                element,
                f"{what}; write {word}",
                at=at,
                data={"write": word},
                alike=(element.tag, word),
                severity=_get_severity(element, name, word),
                effects=select_holding(
                    _ATTRIBUTE_EFFECTS, *["one with a default is meant"] * has_default
                )
                if has_default or word in VOCABULARY[element.tag].unread
                else (),  # most readers reject the robot, or drop the link, without it
            )


def _get_severity(element: Element, name: str, word: str) -> Severity:
    """Get the severity of a misspelled attribute: an info if it has the value that is the default.

    Args:
        element: The element.
        name: Name as written.
        word: Name that is meant.
    """
    if is_zero_default(element.tag, word, element.attributes[name]):
        return INFO
    return WARNING if (element.tag, name) in _OTHER_NAMES else ERROR


@unknown_attribute.fix(BOTH, reveals=True)
def write_known_attribute(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the attribute with the most similar name."""
    found = find_attribute(problem)
    if found is None:
        return None
    element, name = found
    if (element.tag, name) == ("axis", "rpy"):
        return safe("remove it: an axis has no rotation", remove_attribute(element, name))
    free = [word for word in VOCABULARY[element.tag].attributes if word not in element.attributes]
    direct = {"pos", "position", "rot", "rotation", "orientation", "mass", "min", "max", "height"}
    direct |= {"dimensions", "uri", "file", "url", "name", "value"}
    word: str | None = problem.data.get("write")
    if (
        word is None
        or word not in free
        or (name not in direct and suggest_word(name, free) != word)
    ):
        return None
    count = VOCABULARY[element.tag].numbers.get(word)
    if count is not None and parse_numbers(element.get(name), count) is None:
        if count != 1 or number(element.get(name)) is None:
            return None
    return unsafe(f"write {word}", rename_attribute(element, name, word))


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "reject a joint type in capitals; ignore an element"
        ),
    },
)
def wrong_case_keyword(robot: Robot) -> Iterator[Problem]:
    """An element, attribute or joint type differs from that of URDF only in case.

    URDF is in lower case, and readers compare names exactly. They reject the robot for a joint of
    type ``Revolute``, and ignore ``<Inertial>`` without a message.
    """
    for element in get_census(robot).unknown:
        parent = element.parent
        lower = element.tag.lower()
        if parent is None or parent.tag == "geometry" or lower == element.tag:
            continue
        if lower in VOCABULARY[parent.tag].children:
            what = f"{_describe(parent)} has the unknown element <{element.tag}>; write <{lower}>"
            yield Problem(element, what)
    for tag, elements in get_census(robot).known.items():
        known = set(VOCABULARY[tag].attributes)
        for element in elements:
            if element.attributes.keys() <= known:
                continue
            for name in element.attributes:
                lower = name.lower()
                if name != lower and lower in known and lower not in element.attributes:
                    what = f"{_describe(element)} has the unknown attribute '{name}'; write {lower}"
                    yield Problem(element, what, at=element.locate_attribute(name))
    for joint in robot.joints:
        if joint.type != joint.type.lower() and joint.type.lower() in JOINT_TYPES:
            yield Problem(
                joint,
                f"joint '{joint.name}' has type '{joint.type}'; write {joint.type.lower()}",
                at=joint.locate_attribute("type"),
            )


def _format_count(elements: list[Element]) -> str:
    return f" (and {len(elements) - 1} more)" if len(elements) > 1 else ""


def _describe(element: Element | None) -> str:
    """Describe an element: ``link 'arm'``, or ``<inertial> of link 'arm'``."""
    if element is None:
        return "the document"
    if element.tag in ("link", "joint"):
        return describe_owner(element)
    return (
        f"<{element.tag}>"
        if element.tag == "robot"
        else f"<{element.tag}> of {describe_owner(element)}"
    )


@wrong_case_keyword.fix(BOTH, reveals=True)
def write_lower_case(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the keyword in lower case.

    The fix is safe for a joint type, a parent or a child, because every reader rejects the robot
    without it. It is unsafe for other keywords, which readers ignore before the fix.
    """
    found = find_attribute(problem)
    if found is not None:
        element, name = found
        if name == "type" and element.tag == "joint":
            lower = (element.get(name) or "").lower()
            return safe(f"write {lower}", set_attribute(element, name, lower))
        return unsafe(f"write {name.lower()}", rename_attribute(element, name, name.lower()))
    element = problem.element
    if isinstance(problem.subject, Joint) or element.tag == element.tag.lower():
        return None
    parent, lower = element.parent, element.tag.lower()
    if parent is None or (
        parent.find_child(lower) is not None and lower not in VOCABULARY[parent.tag].many
    ):
        return None
    make = safe if parent.tag == "joint" and lower in ("parent", "child") else unsafe
    return make(f"write <{lower}>", rename_element(element, lower))
