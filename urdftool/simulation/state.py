"""State of a robot at one sample of a run, with results that were computed from it."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import TypeVar, cast

from ..model.pose import Pose, rotation_from_quaternion
from .checks.thresholds import Thresholds
from .recording import Array, Contact
from .rigid_bodies import RigidBodyModel

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class StateSnapshot:
    """Poses and contacts at one sample of a run."""

    bodies: RigidBodyModel
    poses: Array
    contacts: list[Contact] = field(default_factory=list)
    known: dict[Hashable, object] = field(default_factory=dict)
    thresholds: Thresholds = field(default_factory=Thresholds)

    def get_pose(self, number: int) -> Pose:
        """Return the pose of a body in the world."""
        a, b, c, x, y, z, w = self.poses[number].tolist()
        return Pose(rotation_from_quaternion((w, x, y, z)), (a, b, c))

    def get_body(self, link: str) -> int:
        """Return the index of the body that a link belongs to."""
        bodies = self.bodies.bodies
        return next(number for number, body in enumerate(bodies) if link in body.links)

    def link_pose(self, link: str) -> Pose:
        """Return the pose of a link in the world."""
        number = self.get_body(link)
        return self.get_pose(number) @ self.bodies.bodies[number].places[link]

    def get_or_compute(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return the result for a key, computed once for this state; errors are not cached."""
        if key not in self.known:
            self.known[key] = make()
        return cast(T, self.known[key])
