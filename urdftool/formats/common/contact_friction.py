"""Friction of contact that a description gives a link, in tags of Gazebo and Bullet."""

from __future__ import annotations

import math

from ...model.elements import Robot
from ...model.read import number


def get_gazebo_friction(robot: Robot, link: str) -> float | None:
    """Return the friction coefficient of a link in the first direction, ``mu1`` of Gazebo."""
    found = None
    for block in robot.extensions.get(link, ()):
        for keyword in ("mu1", "mu"):
            value = number(block.get_value(keyword))
            found = value if value is not None and value >= 0 else found
    return found


def get_second_gazebo_friction(robot: Robot, link: str) -> float | None:
    """Return the friction coefficient of a link in the second direction, ``mu2`` of Gazebo."""
    found = None
    for block in robot.extensions.get(link, ()):
        value = number(block.get_value("mu2"))
        found = value if value is not None and value >= 0 else found
    return found


def get_bullet_friction(robot: Robot, link: str) -> float | None:
    """Return ``<lateral_friction>`` of the ``<contact>`` of a link, which Bullet reads."""
    element = robot.link[link].xml
    contact = None if element is None else element.find_child("contact")
    inner = None if contact is None else contact.find_child("lateral_friction")
    value = None if inner is None else number(inner.get("value") or inner.text)
    return value if value is not None and math.isfinite(value) and value >= 0 else None
