"""The values in a ``<gazebo>`` block."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Robot
from ..rule import ERROR, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from .keywords import NUMBERS

_LEADING = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:inf|nan)", re.IGNORECASE)


@rule(
    ERROR,
    effects={
        "gazebo": "ends at once, with an uncaught 'stod', where there is no number at all",
        "others": "do not look",
    },
)
def bad_extension_number(robot: Robot) -> Iterator[Problem]:
    """A value that Gazebo reads as a number is none.

    sdformat converts mu1, kp and their like with a function that throws when the text does not
    begin with a number, and nobody catches it: the whole simulator ends. Of ``10.0d`` it reads the
    10 and passes over the rest; that is a warning.
    """
    for block in robot.gazebo:
        for child in block.element.children:
            if child.tag not in NUMBERS:
                continue
            written = child.get("value")
            text = (child.text if written is None else written).strip()
            if is_unexpanded(text):
                continue
            number = _LEADING.match(text)
            if number is not None and number.end() == len(text):
                continue
            at = None if written is None else child.attribute_place("value")
            if number is None:
                what = f"'{text}' is no number" if text else "it is empty"
                message = f"{child.tag} wants a number, and {what}; Gazebo ends when it reads it"
                yield Problem(block.element, message, at=at or child)
            else:
                yield Problem(
                    block.element,
                    f"{child.tag} is '{text}', of which Gazebo reads {number[0]}; write that",
                    at=at or child,
                    severity=WARNING,
                )
