"""Letting a robot settle, in whichever engine: the steps, when to stop, and the recording."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Mapping
from time import perf_counter
from typing import Any, Protocol

import numpy as np

from .bodies import Bodies
from .recording import Array, Contact, ReadBack, Recording
from .settings import Settings
from .stillness import PATIENCE, WINDOW, Stillness

SAMPLE = 1 / 30
"""Time between samples, as near as the timestep allows [s]."""

RUNAWAY = 1e3
"""How far a robot may get before it is lost, in its sizes or metres."""

Sample = dict[str, Any]
"""One value of each of a recording's columns, by name."""


Tell = Callable[[tuple[Array, list[Contact]]], None]


class Engine(Protocol):
    """A robot above a plane, which an engine steps.

    Attributes:
        name: Of the engine, with its version.
        bodies: The robot.
        settings: How it is spawned.
        read_back: What the engine took for other than it was given.
        capped: The damping of joints whose damping it does not bear [N·m·s/rad, N·s/m].
    """

    name: str
    bodies: Bodies
    settings: Settings
    read_back: list[ReadBack]
    capped: dict[str, float]

    def lean(self, gravity: tuple[float, float, float], poses: Array) -> None:
        """Set gravity [m/s²] for the steps up to the next sample, the last poses being these."""

    def step(self) -> None:
        """One timestep."""

    def sample(self, time: float) -> Sample:
        """What there is to measure at a time [s]."""

    def is_broken(self) -> bool:
        """Whether the engine itself says that its numbers are none."""

    def contacts(self) -> list[Contact]:
        """What touches the plane now, and what pushes what."""

    def overlaps(self, *, ground: bool = True) -> list[Contact]:
        """The deepest place of each two bodies that are in each other, whether they push or not."""


def settle(engine: Engine, tell: Tell = lambda _: None) -> Recording:
    """Step until nothing moves, the time is over, or the robot is lost.

    ``tell`` is given the poses and the contacts of the start before the first step.
    """
    bodies, settings = engine.bodies, engine.settings
    every = max(1, round(SAMPLE / settings.timestep))
    steps = max(1, round(settings.duration / settings.timestep))
    watch = Stillness(bodies.size, every * settings.timestep)
    late: deque[list[Contact]] = deque(maxlen=max(1, round(WINDOW / (every * settings.timestep))))
    start_contacts = engine.overlaps()
    samples = [engine.sample(0.0)]
    tell((samples[0]["poses"], start_contacts))
    began = perf_counter()
    still: float | None = None
    ended, done = "time", 0
    while done < steps and ended == "time":
        engine.lean(settings.gravity_at(done * settings.timestep), samples[-1]["poses"])
        for _ in range(min(every, steps - done)):
            engine.step()
            done += 1
        sample = engine.sample(done * settings.timestep)
        samples.append(sample)
        if engine.is_broken() or not _is_sane(sample, bodies):
            ended = "lost"
            break
        late.append([touch for touch in engine.contacts() if touch.force > 0])
        still = watch.add(sample["times"], sample["poses"], sample["positions"])
        if still is not None and sample["times"] > PATIENCE:
            ended = "still"
    seconds = perf_counter() - began
    columns = {name: np.array([sample[name] for sample in samples]) for name in samples[0]}
    columns["potential"] = columns["potential"] - columns["potential"][0]
    return Recording(
        engine=engine.name,
        bodies=tuple(body.name for body in bodies.bodies),
        joints=tuple(joint.name for joint in bodies.joints),
        **columns,
        held=bodies.held,
        targets=_targets(bodies.positions, bodies.held),
        start_contacts=start_contacts,
        contacts=engine.contacts() + engine.overlaps(ground=False),
        carrying=[touch for some in late for touch in some],
        carried=sum(touch.force for some in late for touch in some) / len(late)
        if late
        else math.nan,
        read_back=engine.read_back,
        capped=engine.capped,
        still_since=still,
        ended=ended,
        seconds=seconds,
        steps=done,
    )


def _targets(positions: Mapping[str, float], held: tuple[str, ...]) -> dict[str, float]:
    return {name: positions[name] for name in held}


def _is_sane(sample: Sample, bodies: Bodies) -> bool:
    poses = sample["poses"]
    far = RUNAWAY * max(1.0, bodies.size)
    return bool(
        np.isfinite(poses).all()
        and math.isfinite(sample["kinetic"])
        and np.abs(poses[:, :2]).max() < far
    )
