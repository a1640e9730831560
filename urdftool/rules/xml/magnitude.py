"""Numbers that no robot has."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.read import numbers
from ..rule import ERROR, Problem, rule
from ..words import words
from .vocabulary_table import VOCABULARY

_MEASURED = words("origin mass inertia box cylinder capsule sphere mesh color axis mimic")
"""Elements whose numbers are measured; those of a limit may be as large as their author wants."""

_LONGEST = 30
"""Number of characters up to which a number without an exponent is below 1e30."""


@rule(ERROR)
def immense_number(robot: Robot, *, largest: float = 1e30) -> Iterator[Problem]:
    """A mass, a size, a pose, an axis or a color holds a number above 1e30.

    The exponent is a typing error. ``export`` and ``simulate`` refuse such a robot, as products of
    such numbers become infinite: the square of 1e30 is above the largest number of 32 bits,
    3.4e38, and a file of a few of them ends in values that are not numbers. A limit may be as
    large: a joint with it has none.
    """
    for part in (*robot.links, *robot.joints, *robot.materials):
        for element in part.element.walk():
            kind = VOCABULARY.get(element.tag)
            if kind is None or element.tag not in _MEASURED:
                continue
            for name, count in kind.numbers.items():
                text = element.attributes.get(name)
                if text is None or not _may_be_large(text):
                    continue
                if any(abs(value) > largest for value in numbers(text, count) or ()):
                    yield Problem(
                        part,
                        f'{name}="{text}" of <{element.tag}> in {part.element.tag} '
                        f"'{part.element.get('name') or ''}' is above {largest:g}; write one that "
                        "a robot can have",
                        at=element.attribute_place(name),
                    )


def _may_be_large(text: str) -> bool:
    return "e" in text or "E" in text or len(text) > _LONGEST
