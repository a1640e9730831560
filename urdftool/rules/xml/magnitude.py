"""Rules on implausibly large numbers."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.read import parse_numbers
from ...model.urdf_schema import VOCABULARY
from ..rule import ERROR, Problem, rule
from ..words import split_words

_MEASURED = split_words("origin mass inertia box cylinder capsule sphere mesh color axis mimic")
"""Elements with measured numbers; a limit may have any value."""

_LONGEST = 30
"""Maximum number of characters of a number below 1e30 without exponent. Chosen, no source."""


@rule(
    ERROR,
    evidence="products of such numbers overflow, and export and simulate reject the robot "
    "(`tests/formats`, `tests/simulation`)",
)
def immense_number(robot: Robot, *, largest: float = 1e30) -> Iterator[Problem]:
    """A mass, size, pose, axis or color is above 1e30.

    The exponent is a typing error. ``export`` and ``simulate`` reject such a robot, because
    products of such numbers overflow: the square of 1e30 is above the largest 32-bit number,
    3.4e38, and results are not finite. Joint limits are not checked, because a large limit means no
    limit. ``largest`` is the largest number that is not reported.
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
                if any(abs(value) > largest for value in parse_numbers(text, count) or ()):
                    yield Problem(
                        part,
                        f'{name}="{text}" of <{element.tag}> in {part.element.tag} '
                        f"'{part.element.get('name') or ''}' is above {largest:g}; write a "
                        "plausible number",
                        at=element.locate_attribute(name),
                    )


def _may_be_large(text: str) -> bool:
    return "e" in text or "E" in text or len(text) > _LONGEST
