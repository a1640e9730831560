"""Friction and contact parameters of links: Gazebo's tags, and ``<contact>`` of Bullet."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ..model.elements import Robot
from ..model.read import number


@dataclass(frozen=True)
class Surface:
    """Contact parameters of a body; None for values that the file does not set.

    Attributes:
        friction: Coulomb friction coefficient [–]; the smaller one of two.
        stiffness: Contact stiffness [N/m].
        damping: Contact damping [N·s/m].
        where: Tags of the file with these values.
    """

    friction: float | None = None
    stiffness: float | None = None
    damping: float | None = None
    where: tuple[str, ...] = ()


# attribute of Surface -> tags of Gazebo, tag of Bullet's <contact>
_WORDS = {
    "friction": (("mu1", "mu", "mu2"), "lateral_friction"),
    "stiffness": (("kp",), "stiffness"),
    "damping": (("kd",), "damping"),
}


def read_surface(robot: Robot, links: Iterable[str]) -> Surface:
    """Read the contact parameters of a rigid body of several links.

    If links differ, the smaller friction and the softer contact are used.
    """
    values: dict[str, float] = {}
    where: dict[str, None] = {}
    for name in links:
        for what, (tags, tag) in _WORDS.items():
            for word, text in _list_texts(robot, name, tags, tag):
                value = number(text)
                if value is not None and math.isfinite(value) and value >= 0:
                    values[what] = min(value, values.get(what, math.inf))
                    where[word] = None
    if values.get("stiffness") == 0:  # zero means the default
        del values["stiffness"]
    return Surface(**values, where=tuple(where))


def _list_texts(
    robot: Robot, link: str, tags: Iterable[str], tag: str
) -> Iterable[tuple[str, str]]:
    for block in robot.extensions.get(link, ()):
        for word in tags:
            text = block.get_value(word)
            if text is not None:
                yield f"<{word}>", text
    element = robot.link[link].xml
    contact = None if element is None else element.find_child("contact")
    inner = None if contact is None else contact.find_child(tag)
    if inner is not None:
        yield f"<{tag}>", inner.get("value") or inner.text
