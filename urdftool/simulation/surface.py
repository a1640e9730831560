"""Friction and contact parameters of links: Gazebo's tags, and ``<contact>`` of Bullet."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ..model.elements import Robot
from ..model.read import number


@dataclass(frozen=True)
class Surface:
    """How a body touches; None for what the file leaves open.

    Attributes:
        friction: Coulomb's coefficient [–]; the smaller one where there are two.
        stiffness: Of a contact [N/m].
        damping: Of a contact [N·s/m].
        where: Which words of the file say so.
    """

    friction: float | None = None
    stiffness: float | None = None
    damping: float | None = None
    where: tuple[str, ...] = ()


# what a Surface holds -> Gazebo's tags, tags of Bullet's <contact>
_WORDS = {
    "friction": (("mu1", "mu", "mu2"), "lateral_friction"),
    "stiffness": (("kp",), "stiffness"),
    "damping": (("kd",), "damping"),
}


def read_surface(robot: Robot, links: Iterable[str]) -> Surface:
    """Read the surface of a rigid body of some links.

    Where links differ, the smaller friction counts, and the softer contact.
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
    if values.get("stiffness") == 0:  # what the tag means where it is left at zero: the default
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
