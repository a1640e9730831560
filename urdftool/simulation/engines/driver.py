"""Run an engine in its process: step until the robot is at rest, and sweep its joints."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from pathlib import Path
from time import process_time

import numpy as np

from ...errors import ModelError
from ..checks.thresholds import Thresholds
from ..recording import Array, Contact, Hit, Recording, Swept
from ..rigid_bodies import RigidBodyModel
from ..settings import Settings
from .base import Capabilities, Sample, World
from .registry import load_engine, name_alternative

SAMPLE = 1 / 30
"""Time between samples, rounded to time steps [s]. Chosen, no source."""

RUNAWAY = 1e3
"""Horizontal distance at which a robot has diverged [its size, at least m]."""

SWEEP_STEPS = 36
"""Number of intervals between the limits of a swept joint. Chosen, no source."""

Emit = Callable[[tuple[Array, list[Contact]]], None]


def run(
    engine: str,
    bodies: RigidBodyModel,
    settings: Settings,
    folder: Path,
    thresholds: Thresholds,
    emit: Emit = lambda _: None,
) -> Recording:
    """Spawn a robot in an engine, and let it settle.

    Raises:
        MissingDependency: The engine is not installed.
        ModelError: The engine cannot load the robot.
    """
    loaded = load_engine(engine)
    _check_joints(loaded.capabilities, len(bodies.joints))
    world = loaded.open_world(bodies, settings, folder)
    return settle(world, loaded.capabilities, thresholds, emit)


def _check_joints(known: Capabilities, count: int) -> None:
    most = known.max_joints
    if most is None or count <= most:
        return
    other = name_alternative(known.name, lambda c: c.max_joints is None or c.max_joints >= count)
    raise ModelError(
        f"the robot has {count} moving joints; {known.title} supports at most {most}"
        + (f"; use {other}" if other else "")
    )


def settle(
    world: World, capabilities: Capabilities, thresholds: Thresholds, emit: Emit
) -> Recording:
    """Step until the robot is at rest, the duration is over, or the simulation diverged."""
    bodies, settings = world.bodies, world.settings
    every = max(1, round(SAMPLE / settings.timestep))
    steps = max(1, round(settings.duration / settings.timestep))
    interval = every * settings.timestep
    watch = Stillness(bodies, interval, thresholds)
    late: deque[list[Contact]] = deque(maxlen=max(1, round(thresholds.settle_window / interval)))
    start_contacts = world.find_overlaps()
    samples = [world.sample(0.0)]
    emit((samples[0]["poses"], start_contacts))
    began = process_time()
    still: float | None = None
    ended, done = "time", 0
    while done < steps and ended == "time":
        world.set_gravity(
            settings.compute_gravity_at(done * settings.timestep), samples[-1]["poses"]
        )
        for _ in range(min(every, steps - done)):
            world.step()
            done += 1
        sample = world.sample(done * settings.timestep)
        samples.append(sample)
        if world.has_diverged() or _has_diverged(sample, bodies):
            ended = "lost"
            break
        late.append([touch for touch in world.list_contacts() if touch.force > 0])
        still = watch.add(sample["times"], sample["poses"], sample["positions"])
        if still is not None and sample["times"] > thresholds.settle_min_time:
            ended = "still"
    seconds = process_time() - began
    columns = {name: np.array([sample[name] for sample in samples]) for name in samples[0]}
    columns["potential"] = columns["potential"] - columns["potential"][0]
    return Recording(
        engine=f"{capabilities.title} {world.version}",
        capabilities=capabilities,
        bodies=tuple(body.name for body in bodies.bodies),
        joints=tuple(joint.name for joint in bodies.joints),
        **columns,
        held=bodies.held,
        targets={name: bodies.positions[name] for name in bodies.held},
        start_contacts=start_contacts,
        contacts=world.list_contacts() + world.find_overlaps(ground=False),
        carrying=[touch for some in late for touch in some],
        carried=sum(touch.force for some in late for touch in some) / len(late)
        if late
        else math.nan,
        read_back=world.read_back,
        capped=world.capped,
        still_since=still,
        ended=ended,
        seconds=seconds,
        steps=done,
    )


def _has_diverged(sample: Sample, bodies: RigidBodyModel) -> bool:
    """Tell whether the simulation diverged: a value is not finite, or the robot is far away."""
    poses = sample["poses"]
    far = RUNAWAY * max(1.0, bodies.size)
    return not (
        np.isfinite(poses).all()
        and math.isfinite(sample["kinetic"])
        and np.abs(poses[:, :2]).max() < far
    )


class Stillness:
    """Detects when a robot is at rest, from positions of samples instead of velocities.

    It is if its positions in a window are equal within bounds, and would stay so: a slow motion
    that does not slow down, such as the first second of a fall, is not rest.
    """

    def __init__(self, bodies: RigidBodyModel, interval: float, thresholds: Thresholds) -> None:
        """Initialize without samples."""
        joint_bounds = [
            thresholds.settle_slide if joint.kind == "prismatic" else thresholds.settle_turn
            for joint in bodies.joints
        ]
        count = len(bodies.bodies)
        creep = max(thresholds.settle_creep * bodies.size, 1e-5)
        self.bounds = np.concatenate(
            [joint_bounds, np.repeat([creep, thresholds.settle_turn], 3 * count)]
        )
        self.horizon = thresholds.settle_horizon
        self.window = max(2, round(thresholds.settle_window / interval))
        self.seen: deque[tuple[float, Array, Array]] = deque(maxlen=self.window + 1)

    def add(self, time: float, poses: Array, positions: Array) -> float | None:
        """Add a sample; return the time since which the robot is at rest, or None if it moves.

        Args:
            time: Time of the sample [s].
            poses: Poses of the bodies, shape (b, 7), as in ``Recording``.
            positions: Joint positions, shape (j,) [rad, m].
        """
        self.seen.append((time, poses, positions))
        if len(self.seen) <= self.window:
            return None
        values = np.array([self._compare(*sample[1:]) for sample in self.seen])
        quiet = np.abs(values).max(axis=0, initial=0.0) < self.bounds
        if not quiet.all() or not (self._estimate_moves(values) < self.bounds).all():
            return None
        return self.seen[0][0]

    def _compare(self, poses: Array, positions: Array) -> Array:
        """Subtract the last sample: joints, places and turns of bodies, shape (j + 6 b,)."""
        _, last, joints = self.seen[-1]
        moved = poses[:, :3] - last[:, :3]
        xyz, w = poses[:, 3:6], poses[:, 6:]
        one, real = -last[:, 3:6], last[:, 6:]
        turned = 2 * (real * xyz + w * one + np.cross(one, xyz))  # small angles
        turned *= np.sign(real * w - np.einsum("ij,ij->i", one, xyz)[:, None])
        return np.concatenate([positions - joints, moved.ravel(), turned.ravel()])

    def _estimate_moves(self, values: Array) -> Array:
        """Estimate how far each value would move from here within the horizon.

        The rate changes in each half of a window by the same factor, but does not grow. Values
        that go to and fro do not move; nor do those that slow down within two windows, in which
        they stay within twice their bounds.
        """
        times = np.array([time for time, *_ in self.seen])
        half = len(times) // 2 + 1
        before = np.polyfit(times[:half], values[:half], 1)[0]
        after = np.polyfit(times[-half:], values[-half:], 1)[0]
        ratio = np.abs(after) / np.maximum(np.abs(before), 1e-12)
        window = times[-1] - times[0]
        lasts = window / 2 * ratio / np.maximum(1 - ratio, 1e-12)
        goes_on = (before * after > 0) & (lasts > 2 * window)
        return np.where(goes_on, np.abs(after) * np.minimum(lasts, self.horizon), 0.0)


def sweep(engine: str, bodies: RigidBodyModel, settings: Settings, folder: Path) -> list[Swept]:
    """Move each joint of a robot through its limits in an engine."""
    world = load_engine(engine).open_world(bodies, settings, folder)
    world.clear_ground()
    return sweep_world(world, bodies)


def sweep_world(world: World, bodies: RigidBodyModel) -> list[Swept]:
    """Move each joint, except mimic joints, through its limits, and find overlaps.

    Overlaps of the start are ignored. A joint without limits moves by half a turn, or a meter, to
    each side.
    """
    at_start = {_pair(contact) for contact in world.find_overlaps(ground=False)}
    found = []
    for number, joint in enumerate(bodies.joints):
        if joint.leader is not None:
            continue
        low, high = joint.lower, joint.upper
        if not (math.isfinite(low) and math.isfinite(high)):
            low, high = (-math.pi, math.pi) if joint.kind != "prismatic" else (-1.0, 1.0)
        hits: dict[frozenset[str], list[tuple[float, float, tuple[str, str]]]] = {}
        start = bodies.positions[joint.name]
        for value in _collect_values(low, high, start):
            world.set_joint_position(number, value)
            for contact in world.find_overlaps(ground=False):
                if _pair(contact) not in at_start:
                    where = (value, contact.depth, (contact.one, contact.other))
                    hits.setdefault(_pair(contact), []).append(where)
        world.set_joint_position(number, start)
        free_low, free_high = _get_free_range(
            low, high, start, [v for h in hits.values() for v, _, _ in h]
        )
        found.append(
            Swept(joint.name, low, high, free_low, free_high, [_make_hit(h) for h in hits.values()])
        )
    return found


def _make_hit(found: list[tuple[float, float, tuple[str, str]]]) -> Hit:
    values = [value for value, _, _ in found]
    return Hit(*found[0][2], min(values), max(values), max(depth for _, depth, _ in found))


def _collect_values(low: float, high: float, start: float) -> list[float]:
    inner = np.linspace(low, high, SWEEP_STEPS + 1)
    return sorted({*inner.tolist(), min(max(start, low), high)})


def _get_free_range(low: float, high: float, start: float, hit: list[float]) -> tuple[float, float]:
    """Return the range around the start in which nothing is hit."""
    below = [value for value in hit if value < start]
    above = [value for value in hit if value > start]
    return max(below, default=low), min(above, default=high)


def _pair(contact: Contact) -> frozenset[str]:
    return frozenset((contact.one, contact.other))
