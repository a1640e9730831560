"""Rules on numbers in attributes."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ...model.elements import Robot
from ...model.read import number, parse_numbers
from ...model.urdf_schema import VOCABULARY
from ...source.description import Description
from ...source.document import Element
from ...source.tags import locate_value
from ..fix import (
    OUTER_BLANKS,
    FixContext,
    Proposal,
    find_attribute,
    safe,
    set_attribute,
    substitute,
    unsafe,
)
from ..rule import BOTH, ERROR, UNSAFE, Problem, rule, select_holding
from ..unexpanded import is_unexpanded
from .ignored_attributes import select_read_effects
from .owner import describe_owner
from .vocabulary_table import get_census

_VECTORS = {
    tag: tuple((name, count) for name, count in kind.numbers.items() if count > 1)
    for tag, kind in VOCABULARY.items()
}
_SCALARS = {
    tag: tuple(name for name, count in kind.numbers.items() if count == 1)
    for tag, kind in VOCABULARY.items()
}

_OF_URDFDOM = {
    "urdfdom, gz, gazebo-classic, pinocchio (in a joint)": "reject the robot",
    "urdfdom, gz, gazebo-classic, pinocchio (in a visual)": (
        "drop the visuals and collisions of the link, at least from this one on"
    ),
    "urdfdom, gz, gazebo-classic, pinocchio (in a collision)": (
        "drop the collisions of the link, at least from this one on"
    ),
    "urdfdom, pinocchio (in an inertial)": (
        "drop the inertial, the visuals and the collisions of the link"
    ),
    "gz, gazebo-classic (in an inertial)": "delete the link and its descendants",
    "urdfdom, gz, gazebo-classic, pinocchio (in a color)": "load the robot without the color",
}
_OF_MUJOCO = {
    "mujoco (in a visual)": "ignores it, like all visuals, unless discardvisual is false",
}
_OF_PYBULLET = {
    "pybullet (too few numbers, an axis)": "rejects the robot",
    "pybullet (too few numbers, an origin or size)": "takes 0 0 0",
    "pybullet (too few numbers, a scale)": "takes the first number for all three",
    "pybullet (in a color, of a material with a name)": "takes 0 0 0 0",
}


_WRONG_ARITY = {
    **_OF_URDFDOM,
    "mujoco (not in a visual, too few numbers, something written)": (
        "rejects the file: not enough data"
    ),
    "mujoco (not in a visual, nothing written, not an origin)": (
        "rejects the file: required attribute missing"
    ),
    "mujoco (nothing written, an origin)": "takes 0 0 0",
    "mujoco (not in a visual, too many numbers)": "rejects the file: too much data",
    **_OF_MUJOCO,
    **_OF_PYBULLET,
    "pybullet (too many numbers, not in a color)": "takes the first 3",
    "drake": "rejects the file",
}


@rule(
    ERROR,
    effects=_WRONG_ARITY,
)
def wrong_arity(robot: Robot) -> Iterator[Problem]:
    """A vector has too few or too many numbers.

    A position, rotation, axis, size and scale have three numbers, a color has four. urdfdom
    discards the element that contains the vector: it rejects the robot for a joint, but for a link
    it only drops visuals and collisions, and reports the robot as loaded.
    """
    for tag, vectors in _VECTORS.items():
        if not vectors:
            continue
        for element in get_census(robot).known[tag]:
            for name, count in vectors:
                text = element.attributes.get(name)
                if text is None:
                    continue
                words = text.split()
                if len(words) == count or is_unexpanded(text) or any(map(_describe_defect, words)):
                    continue
                amount = "too few numbers" if len(words) < count else "too many numbers"
                written = "something written" if words else "nothing written"
                yield Problem(
                    element,
                    _describe_arity(element, name, len(words), count),
                    at=element.locate_attribute(name),
                    effects=select_read_effects(
                        select_holding(_WRONG_ARITY, *_get_conditions(element), amount, written),
                        element,
                        name,
                    ),
                )


def _describe_arity(element: Element, name: str, written: int, count: int) -> str:
    where = f"{name} of <{element.tag}> in {describe_owner(element)}"
    return f"{where} has {_format_count(written)}; write {count}"


_PLACES = {
    "joint": ("in a joint", "not in a visual", "not in a color"),
    "visual": ("in a visual", "not in a color"),
    "collision": ("in a collision", "not in a visual", "not in a color"),
    "inertial": ("in an inertial", "not in a visual", "not in a color"),
    "material": ("in a color", "not in a visual", "of a material with a name"),
}
_VECTOR_OF = {
    "axis": "an axis",
    "origin": "an origin or size",
    "box": "an origin or size",
    "mesh": "a scale",
}


def _get_conditions(element: Element) -> tuple[str, ...]:
    """Get the conditions of effects that apply to a number in an element."""
    above: Element | None = element
    while above is not None and above.tag not in _PLACES:
        above = above.parent
    place = _PLACES[above.tag] if above is not None else ()
    if above is not None and above.tag == "material" and not above.get("name"):
        place = place[:-1]  # PyBullet takes one color for all materials without a name
    kind = _VECTOR_OF.get(element.tag)
    origin = "an origin" if element.tag == "origin" else "not an origin"
    return (*place, origin, kind) if kind else (*place, origin)


def _format_count(count: int) -> str:
    return {0: "no number", 1: "one number"}.get(count, f"{count} numbers")


_NOT_A_NUMBER = {
    **_OF_URDFDOM,
    "mujoco, pybullet, drake (a blank behind it)": "read it as intended",
    "mujoco, pybullet (hexadecimal, enough numbers)": "read it as a hexadecimal number: 0x10 is 16",
    "mujoco (not in a visual, unreadable)": "rejects the file",
    "mujoco (not in a visual, too large)": "rejects the file: number is too large",
    "mujoco (not in a visual, readable, too few numbers)": "rejects the file: not enough data",
    "mujoco (not in a visual, nothing written, required)": (
        "rejects the file: required attribute missing"
    ),
    "mujoco (in a collision, no size)": "rejects the file: size must be positive",
    "mujoco (in a visual, unreadable)": _OF_MUJOCO["mujoco (in a visual)"],
    "pybullet (unreadable, no short axis)": "reads the leading number: 0,1 is 0 and -1rad is -1",
    "pybullet (an axis, too few numbers)": "rejects the robot",
    "pybullet (nothing written)": "takes 0",
    "drake (no use to Drake)": "rejects the file",
    "drake (begins with a number)": "reads the leading number: 0,1 is 0 and -1rad is -1",
    "drake (three dampings)": "reads one for each of the three motions of a planar joint",
}


@wrong_arity.fix(BOTH, reveals=True)
def complete_vector(problem: Problem, context: FixContext) -> Proposal | None:
    """Make a color without opacity opaque; write one scale for all three axes.

    The scale is unsafe because urdfdom drops a mesh with one number, and loads it after the fix.
    """
    found = find_attribute(problem)
    if found is None:
        return None
    element, name = found
    words = (element.get(name) or "").split()
    if name == "rgba" and len(words) == 3:
        return safe(
            "write 1 as the fourth number", set_attribute(element, name, " ".join([*words, "1"]))
        )
    if name == "scale" and len(words) == 1:
        return unsafe(
            "write the scale three times", set_attribute(element, name, " ".join(words * 3))
        )
    return None


@rule(
    ERROR,
    effects=_NOT_A_NUMBER,
)
def not_a_number(robot: Robot) -> Iterator[Problem]:
    """An attribute is not a valid number.

    URDF requires decimal numbers with a point: no comma, no unit, no trailing space, not ``nan`` or
    ``inf``. urdfdom discards the element that contains the number; PyBullet reads the leading
    number. With a trailing space in a mass, the link has no mass, and Gazebo deletes it.
    """
    known = get_census(robot).known
    for tag, names in _SCALARS.items():
        for name in names:
            for element in known[tag]:
                text = element.attributes.get(name)
                if text is not None and (fault := _describe_defect(text)):
                    if not is_unexpanded(text):
                        yield _report_invalid_number(element, name, fault, text)
    for tag, vectors in _VECTORS.items():
        for name, _ in vectors:
            for element in known[tag]:
                text = element.attributes.get(name)
                if text is None:
                    continue
                for word in text.split():
                    if fault := _describe_defect(word):
                        if not is_unexpanded(text):
                            yield _report_invalid_number(element, name, fault, word)
                        break


@not_a_number.full
def report_invalid_numbers(robot: Robot) -> Iterator[Problem]:
    """Report each attribute without the required finite numbers, with its link or joint.

    Numbers with a trailing space are not reported, because they can be read. The pose of the robot
    is reported with the robot; only Gazebo reads it.
    """
    parts = (*robot.links, *robot.joints, *robot.materials)
    walked = [(part.element, element) for part in parts for element in part.element.walk()]
    origin = robot.element.find_child("origin")
    for holder, element in walked if origin is None else [*walked, (robot.element, origin)]:
        kind = VOCABULARY.get(element.tag)
        for name, count in kind.numbers.items() if kind is not None else ():
            text = element.get(name)
            if text is not None and parse_numbers(text, count) is None:
                yield Problem(
                    holder,
                    _describe_invalid_attribute(element, name, text, count),
                    at=element.locate_attribute(name),
                    data={"part": holder.tag, "element": element.tag, "attribute": name},
                )


def _describe_invalid_attribute(element: Element, name: str, text: str, count: int) -> str:
    for word in text.split() if count > 1 else [text]:
        if number(word) is None:
            return _describe_number(element, name, _describe_defect(word))
    return _describe_arity(element, name, len(text.split()), count)


def _describe_defect(text: str) -> str:
    """Describe the defect of a number's text, with its remedy; empty for a valid number."""
    try:
        value = float(text)
    except ValueError:
        return _describe_text(text)
    if value - value != 0.0:
        return f"'{text}', which is not finite; write a number"
    if text[-1].isspace():
        return f"a trailing space: '{text}'; write '{text.strip()}'"
    if "_" in text or not text.isascii():
        return f"'{text}', which is not a number"
    return ""


def has_readable_numbers(element: Element) -> bool:
    """Tell whether urdfdom can read every number of a URDF element."""
    for name, count in VOCABULARY[element.tag].numbers.items():
        text = element.attributes.get(name)
        if text is None:
            continue
        words = text.split() if count > 1 else [text]
        if len(words) != count or any(map(_describe_defect, words)):
            return False
    return True


_HEXADECIMAL = re.compile(r"\s*[-+]?0[xX][0-9a-fA-F]+\s*", re.ASCII)
_WORDS = re.compile(r"\s*[-+]?(?:nan|inf|infinity)\s*", re.IGNORECASE | re.ASCII)


def _get_text_condition(text: str) -> str:
    """Get the condition of effects that applies to a number's text."""
    if not text.strip():
        return "nothing written"
    if _HEXADECIMAL.fullmatch(text):
        return "hexadecimal"
    try:
        finite = math.isfinite(float(text))
    except ValueError:
        return "unreadable"
    if "_" in text or not text.isascii():
        return "unreadable"
    kind = "not finite" if _WORDS.fullmatch(text) else "too large"
    return "a blank behind it" if finite else kind


def _get_number_conditions(element: Element, name: str, word: str) -> Iterator[str]:
    """Yield the conditions of effects of the text of a number, and of those next to it."""
    kind = _get_text_condition(word)
    yield kind
    few = len((element.get(name) or "").split()) < VOCABULARY[element.tag].numbers[name]
    yield "too few numbers" if few else "enough numbers"
    if not (few and element.tag == "axis"):
        yield "no short axis"
    if kind in ("not finite", "hexadecimal"):
        yield "readable"
    if element.tag in ("mass", "inertia", *_SHAPES):
        yield "required"
    if element.tag in _SHAPES and not few and word.strip().lower() in ("nan", "-inf", "-infinity"):
        yield "no size"


_UNIT = re.compile(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*[^\W\d_]+[²³]?")


def _describe_text(text: str) -> str:
    stripped = text.strip()
    if not stripped:
        return "no number; write one"
    if stripped.count(",") > 1:
        return f"'{text}'; separate the numbers by spaces, not commas"
    if "," in stripped and _is_number(stripped.replace(",", ".")):
        return f"'{text}' with a comma; write '{stripped.replace(',', '.')}'"
    if (match := _UNIT.fullmatch(stripped)) and _is_number(match[1]):
        return f"'{text}'; write the number without a unit"
    return f"'{text}', which is not a number"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _report_invalid_number(element: Element, name: str, fault: str, word: str) -> Problem:
    in_drake = _get_drake_conditions(element, name, word)
    if "three dampings" in in_drake:
        fault = f"three numbers, '{word}', which only Drake reads; other readers require one"
    texts = _get_number_conditions(element, name, word)
    conditions = (*_get_conditions(element), *texts, *in_drake)
    return Problem(
        element,
        _describe_number(element, name, fault),
        at=element.locate_attribute(name),
        effects=select_read_effects(select_holding(_NOT_A_NUMBER, *conditions), element, name),
    )


def _describe_number(element: Element, name: str, fault: str) -> str:
    return f"{name} of <{element.tag}> in {describe_owner(element)} has {fault}"


def _is_damping_of_planar(element: Element, name: str) -> bool:
    """Tell whether an attribute is one of which Drake reads three numbers."""
    joint = element.parent
    return name == "damping" and joint is not None and joint.get("type") == "planar"


_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)")
_SHAPES = ("box", "cylinder", "capsule", "sphere")


def _get_drake_conditions(element: Element, name: str, word: str) -> tuple[str, ...]:
    """Get the conditions of Drake's effects for the first invalid number of an attribute.

    Drake reads the leading number. It rejects a vector whose invalid number is not the last,
    several numbers in place of one, text without a leading number, and 0 for a box, cylinder or
    capsule. For the damping of a planar joint it requires three numbers.
    """
    if _get_text_condition(word) == "a blank behind it":
        return ()
    begins = _NUMBER.match(word)
    words = element.attributes[name].split()
    if _is_damping_of_planar(element, name):
        sound = len(words) == 3 and not any(map(_describe_defect, words))
        return ("three dampings",) if sound else ("no use to Drake",)
    count = VOCABULARY[element.tag].numbers[name]
    several = (
        count == 1 and len(words) > 1 and not _describe_defect(words[0]) and _NUMBER.match(words[1])
    )
    if begins is None or several or (count > 1 and (len(words) != count or word != words[-1])):
        return ("no use to Drake",)
    if count > 1 and any(map(_describe_defect, words[:-1])):
        return ("no use to Drake",)
    value = float(begins[1])
    if math.isinf(value) or word[begins.end() :][:1] in ("e", "E"):
        return ("no use to Drake",)
    if element.tag in _SHAPES and (value < 0 or (value == 0 and element.tag != "sphere")):
        return ("no use to Drake",)
    return ("begins with a number",)


_TABBED = re.compile(
    rb"""\s(?:xyz|rpy|size|scale|rgba|quat_xyzw)\s*=\s*"""
    rb"""("[^"\t\r\n]*?(?:[\t\r\n]|&#)|'[^'\t\r\n]*?(?:[\t\r\n]|&#))"""
)
_REFERENCE = re.compile(rb"&#(?:0*(?:9|10|13)|x0*[9adAD]);")
"""A tab or line break as a reference, which every parser replaces by the character."""

_BLANKS = rf"(?:\s|{_REFERENCE.pattern.decode()})+"
_UNREADABLE = re.compile(rb"[^\s][\t\r\n]|[\t\r\n](?: |$)")


_TABBED_VECTOR = {
    **_OF_URDFDOM,
    **_OF_PYBULLET,
    "mujoco, drake": "read it as intended",
}


_ONE = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


@not_a_number.fix(UNSAFE, reveals=True)
def write_number(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove spaces around it, and write a point for a comma.

    The fix is unsafe because urdfdom drops the inertial or the shape with such a number, and loads
    it after the fix.
    """
    found = find_attribute(problem)
    if found is None:
        return None
    element, name = found
    text = element.get(name) or ""
    if text != text.strip() and number(text.strip()) is not None:
        return unsafe(f'write "{text.strip()}"', substitute(element, name, OUTER_BLANKS, ""))
    words = text.split()
    count = VOCABULARY[element.tag].numbers.get(name, 1)
    if len(words) == count and all(re.fullmatch(r"[-+]?\d*[.,]?\d+", word) for word in words):
        new = " ".join(word.replace(",", ".") for word in words)
        return unsafe(f'write "{new}"', set_attribute(element, name, new))
    parts = text.replace(",", " ").split()
    if count > 1 and len(parts) == count and all(re.fullmatch(_ONE, part) for part in parts):
        new = " ".join(parts)
        return unsafe(f'write "{new}"', set_attribute(element, name, new))
    return None


@rule(
    ERROR,
    effects=_TABBED_VECTOR,
)
def tab_or_newline_in_vector(robot: Robot, description: Description) -> Iterator[Problem]:
    """Numbers of a vector are separated by a tab or a line break.

    urdfdom splits only at spaces and cannot read the parts: it rejects the robot for a joint, and
    drops the shapes of a link without a message. Other XML parsers convert the tab to a space, so
    xacro and Python tools read the vector, and the output of xacro is correct.
    """
    if description.expansion is not None or not _TABBED.search(robot.element.file.data):
        return
    for tag, vectors in _VECTORS.items():
        for element in get_census(robot).known[tag] if vectors else ():
            spans = element.file.locate_attributes(element.start)
            for name, count in vectors:
                if name not in spans:
                    continue
                start, end = locate_value(element.file.data, spans[name])
                text = _REFERENCE.sub(b"\t", element.file.data[start:end])
                if _UNREADABLE.search(text):
                    parts = sum(1 for part in text.split(b" ") if part)
                    amount = "too few numbers" if parts < count else "enough numbers"
                    yield Problem(
                        element,
                        f"{name} of <{tag}> in {describe_owner(element)} has a tab or line break "
                        "between its numbers; write single spaces",
                        at=element.locate_attribute(name),
                        effects=select_read_effects(
                            select_holding(_TABBED_VECTOR, *_get_conditions(element), amount),
                            element,
                            name,
                        ),
                    )


@tab_or_newline_in_vector.fix(UNSAFE)
def write_blanks(problem: Problem, context: FixContext) -> Proposal | None:
    """Write single spaces between the numbers.

    The fix is unsafe because urdfdom and PyBullet, which split only at spaces, read different
    values after it.
    """
    found = find_attribute(problem)
    if found is None:
        return None
    element, name = found
    return unsafe("write single spaces", substitute(element, name, _BLANKS, " "))
