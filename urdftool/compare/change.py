"""Difference between two robots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..source.location import Place


@dataclass(frozen=True)
class Change:
    """Difference between two robots.

    Attributes:
        kind: ``link``, ``joint``, ``robot``, ``gazebo``, ``transmission`` or ``ros2_control``; or
            what plain URDF lacks, such as ``closed loop``.
        name: Name of the object, in the second robot unless it was removed.
        what: ``added``, ``removed``, ``renamed``, or the property, such as ``mass``.
        before: Value in the first robot; None if absent.
        after: Value in the second robot; None if absent.
        unit: Unit of both values, for display.
        remark: Size of the change, for display, such as the distance moved.
        place: Location, in the second robot unless it was removed.
        owner: Link or joint of an element that only the format has; None for other objects.
    """

    kind: str
    name: str
    what: str
    before: Any = None
    after: Any = None
    unit: str = ""
    remark: str = ""
    place: Place | None = None
    owner: str | None = None
