"""Where the mass of some of a robot's bodies is, at one sample of a run."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..model.pose import rotation_of_quaternion
from .run import Run


def centre_of(run: Run, numbers: Iterable[int], moment: int) -> tuple[float, float, float] | None:
    """The centre of what of some bodies gravity acts on, in the world [m]; None without any.

    Args:
        run: A run.
        numbers: Of its bodies.
        moment: Of its samples.
    """
    total, summed = 0.0, np.zeros(3)
    for number in numbers:
        mass, center = run.bodies.bodies[number].weight
        if not mass:
            continue
        pose = run.recording.poses[moment, number]
        x, y, z, w = pose[3:].tolist()
        turn = np.array(rotation_of_quaternion((w, x, y, z)))
        summed += mass * (pose[:3] + turn @ center)
        total += mass
    if not total or not np.isfinite(summed).all():
        return None
    a, b, c = (summed / total).tolist()
    return a, b, c
