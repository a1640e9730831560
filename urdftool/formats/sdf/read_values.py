"""Values of SDF elements: numbers, poses and names, with the defaults of the specification."""

from __future__ import annotations

import math

from ...errors import ModelError
from ...model.elements import Vector
from ...model.pose import IDENTITY, Pose, rotation_from_quaternion, rotation_from_rpy
from ...model.settings import LIMIT_NAMES
from ...source.document import Element
from ..reading import LARGEST

Version = tuple[int, int]

_MAY_BE_INFINITE = LIMIT_NAMES
"""Elements in which a large number means no limit."""


def read_text(element: Element, tag: str, default: str = "") -> str:
    """Return the text of a child; the default if there is none."""
    child = element.find_child(tag)
    return default if child is None else child.text.strip()


def read_numbers(element: Element, count: int) -> tuple[float, ...]:
    """Return the numbers in the text of an element.

    Raises:
        ModelError: There are not ``count`` of them, one is not a number, or it is too large and
            not a limit.
    """
    words = element.text.split()
    try:
        values = tuple(map(float, words))
    except ValueError:
        values = ()
    if len(values) != count or any(map(math.isnan, values)):
        numbers = "a number" if count == 1 else f"{count} numbers"
        raise ModelError(
            f"<{element.tag}> is '{' '.join(words)}'; {numbers} required", at=element.place
        )
    if element.tag not in _MAY_BE_INFINITE and any(abs(value) > LARGEST for value in values):
        text = f"<{element.tag}> is '{' '.join(words)}', above {LARGEST:g}"
        raise ModelError(f"{text}; write a plausible number", at=element.place)
    return values


def number(element: Element | None, tag: str, default: float) -> float:
    """Return the number in a child; the default without it."""
    child = None if element is None else element.find_child(tag)
    return default if child is None else read_numbers(child, 1)[0]


def read_vector(element: Element, tag: str, default: Vector) -> Vector:
    """Return three numbers of a child; the default without it."""
    child = element.find_child(tag)
    if child is None:
        return default
    x, y, z = read_numbers(child, 3)
    return x, y, z


def read_flag(element: Element, tag: str, default: bool = False) -> bool:
    """Return whether the text of a child is ``true`` or ``1``."""
    child = element.find_child(tag)
    return default if child is None else child.text.strip().lower() in ("true", "1")


def read_pose(element: Element) -> tuple[Pose, str]:
    """Return the ``<pose>`` of an element, and the frame that it names; empty if none."""
    child = element.find_child("pose")
    if child is None:
        return IDENTITY, ""
    frame = child.get("relative_to") or child.get("frame") or ""
    if not child.text.strip():
        return IDENTITY, frame
    if child.get("rotation_format") == "quat_xyzw":
        x, y, z, a, b, c, d = read_numbers(child, 7)
        if not any((a, b, c, d)):
            raise ModelError("<pose> has a quaternion of zeros", at=child.place)
        return Pose(rotation_from_quaternion((d, a, b, c)), (x, y, z)), frame
    x, y, z, roll, pitch, yaw = read_numbers(child, 6)
    if (child.get("degrees") or "").lower() in ("true", "1"):
        roll, pitch, yaw = map(math.radians, (roll, pitch, yaw))
    return Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z)), frame


def read_version(root: Element) -> Version:
    """Return the version of an ``<sdf>`` element.

    Raises:
        ModelError: It has none.
    """
    text = root.get("version") or ""
    try:
        major, minor = (int(word) for word in text.split(".")[:2])
    except ValueError:
        wrong = f"version '{text}' of <sdf> is not like 1.9" if text else "<sdf> has no version"
        raise ModelError(wrong, at=root.locate_attribute("version")) from None
    return major, minor
