"""One thing that changed between two robots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..source.location import Place


@dataclass(frozen=True)
class Change:
    """One thing that changed.

    Attributes:
        kind: ``link``, ``joint``, ``robot``, ``gazebo``, ``transmission`` or ``ros2_control``.
        name: The name of that, in the second robot unless it is gone.
        what: ``added``, ``removed``, ``renamed``, or the property, such as ``mass``.
        before: Its value in the first robot; None where it had none.
        after: Its value in the second robot; None where it has none.
        unit: The unit of both values, for people.
        remark: What the change comes to, for people, such as how far something moved.
        place: Where it is written, in the second robot unless it is gone.
    """

    kind: str
    name: str
    what: str
    before: Any = None
    after: Any = None
    unit: str = ""
    remark: str = ""
    place: Place | None = None
