"""Where the bodies of a robot are at one time, and what has been found out of that."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import TypeVar, cast

from ..model.pose import Pose, rotation_of_quaternion
from .bodies import Bodies
from .checks.thresholds import Thresholds
from .recording import Array, Contact

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Moment:
    """One sample of a run.

    Attributes:
        bodies: The robot.
        poses: Of each body, as in a recording, shape (b, 7).
        contacts: What touches what.
        known: What was found out already; see :meth:`once`.
        thresholds: Of the checks, on which that depends.
    """

    bodies: Bodies
    poses: Array
    contacts: list[Contact] = field(default_factory=list)
    known: dict[Hashable, object] = field(default_factory=dict)
    thresholds: Thresholds = field(default_factory=Thresholds)

    def pose(self, number: int) -> Pose:
        """Where a body is in the world."""
        a, b, c, x, y, z, w = self.poses[number].tolist()
        return Pose(rotation_of_quaternion((w, x, y, z)), (a, b, c))

    def body_of(self, link: str) -> int:
        """Number of the body that a link belongs to."""
        bodies = self.bodies.bodies
        return next(number for number, body in enumerate(bodies) if link in body.links)

    def link_pose(self, link: str) -> Pose:
        """Where a link is in the world."""
        number = self.body_of(link)
        return self.pose(number) @ self.bodies.bodies[number].places[link]

    def once(self, key: Hashable, make: Callable[[], T]) -> T:
        """What ``make`` returns, made once for this moment and a key; errors are not kept."""
        if key not in self.known:
            self.known[key] = make()
        return cast(T, self.known[key])
