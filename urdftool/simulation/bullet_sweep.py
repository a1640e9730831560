"""Each joint moved through its limits, the others where they start: what runs into what."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from .bodies import Bodies
from .bullet import World, bullet_module
from .settings import Settings
from .sweep import Hit, Swept

STEPS = 36
"""Positions that a joint is put to, between its limits."""


def sweep(bodies: Bodies, settings: Settings, folder: Path) -> list[Swept]:
    """Sweep a robot in PyBullet.

    Args:
        bodies: The robot; ``folder`` holds it as ``urdf.write_folder`` wrote it.
        settings: Where the others are.
        folder: Where the URDF is.
    """
    world = World(bullet_module(), bodies, settings, folder)
    world.lift()
    return sweep_world(world, bodies)


def sweep_world(world: Any, bodies: Bodies) -> list[Swept]:
    """Put each joint that follows none to places between its limits, and look for overlaps.

    What overlaps where the robot starts is left out. A continuous joint, and one without limits,
    goes through half a turn to each side.

    Args:
        world: Of either engine.
        bodies: The robot in it.
    """
    at_start = {_pair(contact) for contact in world.overlaps(ground=False)}
    found = []
    for number, joint in enumerate(bodies.joints):
        if joint.leader is not None:
            continue
        low, high = joint.lower, joint.upper
        if not (math.isfinite(low) and math.isfinite(high)):
            low, high = (-math.pi, math.pi) if joint.kind != "prismatic" else (-1.0, 1.0)
        hits: dict[frozenset[str], list[tuple[float, float, tuple[str, str]]]] = {}
        start = bodies.positions[joint.name]
        for value in _values(low, high, start):
            world.put(number, value)
            for contact in world.overlaps(ground=False):
                if _pair(contact) not in at_start:
                    where = (value, contact.depth, (contact.one, contact.other))
                    hits.setdefault(_pair(contact), []).append(where)
        world.put(number, start)
        free_low, free_high = _free(low, high, start, [v for h in hits.values() for v, _, _ in h])
        found.append(
            Swept(
                joint.name,
                low,
                high,
                free_low,
                free_high,
                [
                    Hit(*h[0][2], min(v for v, _, _ in h), max(v for v, _, _ in h),
                        max(d for _, d, _ in h))
                    for h in hits.values()
                ],
            )
        )  # fmt: skip
    return found


def _values(low: float, high: float, start: float) -> list[float]:
    inner = np.linspace(low, high, STEPS + 1)
    return sorted({*inner.tolist(), min(max(start, low), high)})


def _free(low: float, high: float, start: float, hit: list[float]) -> tuple[float, float]:
    """The range around the start in which nothing is hit."""
    below = [value for value in hit if value < start]
    above = [value for value in hit if value > start]
    return max(below, default=low), min(above, default=high)


def _pair(contact: Any) -> frozenset[str]:
    return frozenset((contact.one, contact.other))
