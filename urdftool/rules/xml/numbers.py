"""Numbers as text."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ...source.document import Element
from ...source.tags import value_span
from ..rule import ERROR, Problem, rule
from ..unexpanded import is_unexpanded
from .owner import owner
from .vocabulary_table import VOCABULARY, census

_VECTORS = {
    tag: tuple((name, count) for name, count in kind.numbers.items() if count > 1)
    for tag, kind in VOCABULARY.items()
}
_SCALARS = {
    tag: tuple(name for name, count in kind.numbers.items() if count == 1)
    for tag, kind in VOCABULARY.items()
}

_LOST = {
    "urdfdom, gz, gazebo-classic": "reject the robot for a joint; for a link, silently drop all "
    "its visuals and collisions",
}


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": (
            "reject the robot for a joint; for a link, drop its shapes (the collisions alone "
            "where a collision is wrong)"
        ),
        "pybullet": "rejects the robot for a joint; takes 0 0 0 for a link",
        "mujoco, drake": "reject the file: not enough values",
    },
)
def wrong_arity(robot: Robot) -> Iterator[Problem]:
    """A vector has too few or too many numbers.

    A position, rotation, axis, size and scale take three numbers, a colour four. urdfdom gives up
    on what holds the vector: a joint takes the whole robot with it, a link silently loses all it
    shows and touches with while the robot is reported as parsed.
    """
    for tag, vectors in _VECTORS.items():
        if not vectors:
            continue
        for element in census(robot.element).known[tag]:
            for name, count in vectors:
                text = element.attributes.get(name)
                if text is None:
                    continue
                words = text.split()
                if len(words) == count or is_unexpanded(text) or any(map(_fault, words)):
                    continue
                yield Problem(
                    element,
                    f"{name} of <{tag}> in {owner(element)} has "
                    f"{_counted(len(words))}; write {count}",
                    at=element.attribute_place(name),
                )


def _counted(count: int) -> str:
    return {0: "no number", 1: "one number"}.get(count, f"{count} numbers")


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": (
            "reject the robot for a joint; for a link, drop its shapes (the collisions alone "
            "where a collision is wrong)"
        ),
        "gz, gazebo-classic": "delete the link and all below it where the mass is unreadable",
        "pybullet": "reads as far as it can: 0,1 is 0 and -1rad is -1",
        "mujoco": "rejects the file",
    },
)
def not_a_number(robot: Robot) -> Iterator[Problem]:
    """A number is not one, or not all of it is.

    URDF's numbers are plain decimals: a point and no comma, no unit, no blank behind, not ``nan``
    or ``inf``. urdfdom gives up on what holds the number; PyBullet reads as far as it can and goes
    on with that. So one blank behind a mass makes the link weightless, and Gazebo deletes it.
    """
    known = census(robot.element).known
    for tag, names in _SCALARS.items():
        for name in names:
            for element in known[tag]:
                text = element.attributes.get(name)
                if text is not None and (fault := _fault(text)):
                    if not is_unexpanded(text):
                        yield _unreadable(element, name, fault)
    for tag, vectors in _VECTORS.items():
        for name, _ in vectors:
            for element in known[tag]:
                text = element.attributes.get(name)
                if text is None:
                    continue
                for word in text.split():
                    if fault := _fault(word):
                        if not is_unexpanded(text):
                            yield _unreadable(element, name, fault)
                        break


def _fault(text: str) -> str:
    """What is wrong with a number's text, with what would be right; empty if nothing is."""
    try:
        value = float(text)
    except ValueError:
        return _unreadable_text(text)
    if value - value != 0.0:
        return f"'{text}', which is not finite; write a number"
    if text[-1].isspace():
        return f"a blank behind it: '{text}'; write '{text.strip()}'"
    if "_" in text or not text.isascii():
        return f"'{text}', which is not a number"
    return ""


_UNIT = re.compile(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*[^\W\d_]+[²³]?")


def _unreadable_text(text: str) -> str:
    stripped = text.strip()
    if not stripped:
        return "nothing written; write a number"
    if stripped.count(",") > 1:
        return f"'{text}'; put blanks between numbers, not commas"
    if "," in stripped and _is_number(stripped.replace(",", ".")):
        return f"'{text}' with a comma; write '{stripped.replace(',', '.')}'"
    if (match := _UNIT.fullmatch(stripped)) and _is_number(match[1]):
        return f"'{text}'; write the number alone, without a unit"
    return f"'{text}', which is not a number"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _unreadable(element: Element, name: str, fault: str) -> Problem:
    return Problem(
        element,
        f"{name} of <{element.tag}> in {owner(element)} has {fault}",
        at=element.attribute_place(name),
    )


_TABBED = re.compile(
    rb"""\s(?:xyz|rpy|size|scale|rgba|quat_xyzw)\s*=\s*("[^"\t\r\n]*[\t\r\n]|'[^'\t\r\n]*[\t\r\n])"""
)
_UNREADABLE = re.compile(rb"[^\s][\t\r\n]|[\t\r\n](?: |$)")


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": (
            "reject the robot for a joint; for a link, drop its shapes (the collisions alone "
            "where a collision is wrong)"
        ),
        "pybullet": "rejects the robot for a joint; takes 0 0 0 for a link",
        "mujoco, drake": "read it as meant",
    },
)
def tab_or_newline_in_vector(robot: Robot, description: Description) -> Iterator[Problem]:
    """Numbers of a vector are separated by a tab or a line break.

    urdfdom splits at blanks alone and then cannot read what is left; the joint and with it the
    robot is rejected, or the link silently loses its shapes. Other XML parsers turn the tab into a
    blank, so xacro and Python see nothing wrong, and a robot that went through xacro is mended.
    """
    if description.expansion is not None or not _TABBED.search(robot.element.file.data):
        return
    for tag, vectors in _VECTORS.items():
        for element in census(robot.element).known[tag] if vectors else ():
            spans = element.file.attribute_spans(element.start)
            for name, _ in vectors:
                if name not in spans:
                    continue
                start, end = value_span(element.file.data, spans[name])
                if _UNREADABLE.search(element.file.data, start, end):
                    yield Problem(
                        element,
                        f"{name} of <{tag}> in {owner(element)} has a tab or line break between "
                        "its numbers; write single blanks",
                        at=element.attribute_place(name),
                    )
