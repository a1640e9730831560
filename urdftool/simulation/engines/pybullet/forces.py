"""Forces that Gazebo's extensions of a robot ask for, and that PyBullet has no setting for.

Gravity acts on the world as a whole, so a link without gravity is pushed up by its own weight. A
spring of a joint is an effort in addition to that of its motor.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...bodies import Bodies

Frame = Callable[[int], tuple[Any, Any]]
"""The position [m] and quaternion x, y, z, w of a body's link frame in the world, by its number."""


class Forces:
    """Of one robot."""

    def __init__(
        self, p: Any, robot: int, bodies: Bodies, indices: list[int], frame: Frame
    ) -> None:
        """Take the engine's number of a robot and of the link of each joint, and its frames."""
        self.p, self.robot, self._frame = p, robot, frame
        self._lifted = [
            (number, indices[number - 1] if number else -1, body.weightless)
            for number, body in enumerate(bodies.bodies)
            if body.weightless is not None and not (number == 0 and bodies.nailed)
        ]
        springs = [
            (link, joint.stiffness, joint.spring_rest)
            for link, joint in zip(indices, bodies.joints, strict=True)
            if joint.stiffness
        ]
        self._sprung = [link for link, _, _ in springs]
        self._stiffness = np.array([stiffness for _, stiffness, _ in springs])
        self._rest = np.array([rest for _, _, rest in springs])

    def apply(self, gravity: tuple[float, float, float]) -> None:
        """Apply what acts in the next step, under gravity [m/s²]."""
        p = self.p
        for number, link, part in self._lifted:
            center, _ = p.multiplyTransforms(*self._frame(number), tuple(part.com), (0, 0, 0, 1))
            force = [-part.mass * along for along in gravity]
            p.applyExternalForce(self.robot, link, force, center, p.WORLD_FRAME)
        if self._sprung:
            states = p.getJointStates(self.robot, self._sprung)
            away = self._rest - np.array([state[0] for state in states])
            p.setJointMotorControlArray(
                self.robot, self._sprung, p.TORQUE_CONTROL, forces=(self._stiffness * away).tolist()
            )
