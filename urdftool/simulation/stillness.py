"""When a robot has come to rest: by where it is, not by how fast an engine says it moves."""

from __future__ import annotations

from collections import deque

import numpy as np

from .recording import Array

WINDOW = 0.5
"""How long nothing may move for a robot to be at rest [s]."""

PATIENCE = 1.5
"""How long a robot is watched at least: what balances falls slowly at first [s]."""

CREEP = 0.002
"""How far a body may creep in that time, as a part of the robot's size."""

TURN = 0.01
"""How far a body may turn, or a joint, in that time [rad]."""


class Stillness:
    """Watches samples go by."""

    def __init__(self, size: float, sample: float) -> None:
        """Begin.

        Args:
            size: The largest extent of the robot [m].
            sample: Time between samples [s].
        """
        self.creep = max(CREEP * size, 1e-5)
        self.window = max(2, round(WINDOW / sample))
        self.seen: deque[tuple[float, Array, Array]] = deque(maxlen=self.window + 1)

    def add(self, time: float, poses: Array, positions: Array) -> float | None:
        """Take a sample; since when nothing moved, or None while something does.

        Args:
            time: Of the sample [s].
            poses: Shape (b, 7), as in ``Recording``.
            positions: Shape (j,).
        """
        self.seen.append((time, poses, positions))
        if len(self.seen) <= self.window:
            return None
        quiet = all(self._near(poses, positions, *old[1:]) for old in self.seen)
        return self.seen[0][0] if quiet else None

    def _near(self, poses: Array, positions: Array, before: Array, joints: Array) -> bool:
        moved = np.abs(poses[:, :3] - before[:, :3]).max(initial=0.0)
        dots = np.abs(np.einsum("ij,ij->i", poses[:, 3:], before[:, 3:]))
        turned = 2 * np.arccos(np.clip(dots, 0.0, 1.0)).max(initial=0.0)
        bent = np.abs(positions - joints).max(initial=0.0)
        return bool(moved < self.creep and turned < TURN and bent < TURN)
