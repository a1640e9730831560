"""From a robot to recordings: prepared, given to an engine in its own process, watched."""

from __future__ import annotations

import math
import random
import tempfile
from collections.abc import Callable, Hashable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from time import perf_counter

import numpy as np

from ..errors import ModelError
from ..model.elements import Robot
from ..model.pose import rotation_of_quaternion
from .bodies import Bodies
from .checks.thresholds import Thresholds
from .child import Child
from .engines.registry import REGISTRY, library_of, load_engine
from .meanwhile import meanwhile
from .moment import Moment
from .prepare import prepare
from .recording import Array, Contact, Recording, Swept
from .settings import Settings

_DRIVER = "engines.driver"

Progress = Callable[[int, int], None]

Known = dict[Hashable, object]

Look = Callable[[Robot, Moment], None]

Start = tuple[Array, list[Contact]]
"""Poses and contacts before the first step, as the engine's process tells them."""


@dataclass(frozen=True, eq=False)
class Run:
    """One trial.

    Attributes:
        settings: Of this trial.
        bodies: The robot as it started.
        recording: What the engine measured.
        swept: Each joint moved through its limits; empty where that was not asked for.
        known: What was found out of its start while the engine was waited for.
        thresholds: Of the checks.
    """

    settings: Settings
    bodies: Bodies
    recording: Recording
    swept: list[Swept] = field(default_factory=list)
    known: Known = field(default_factory=dict)
    thresholds: Thresholds = field(default_factory=Thresholds)

    @cached_property
    def start(self) -> Moment:
        """Before the first step."""
        told = self.recording
        return Moment(self.bodies, told.poses[0], told.start_contacts, self.known, self.thresholds)

    @cached_property
    def end(self) -> Moment:
        """The last sample."""
        recorded = self.recording
        return Moment(
            self.bodies, recorded.poses[-1], recorded.contacts, thresholds=self.thresholds
        )

    def center_of_mass(
        self, numbers: Iterable[int], sample: int
    ) -> tuple[float, float, float] | None:
        """Compute the center of mass of some bodies in the world [m], of what gravity acts on.

        Args:
            numbers: Of bodies.
            sample: Of the recording.

        Returns:
            None if they have no mass, or a pose is not finite.
        """
        total, summed = 0.0, np.zeros(3)
        for number in numbers:
            mass, center = self.bodies.bodies[number].weight
            if not mass:
                continue
            pose = self.recording.poses[sample, number]
            x, y, z, w = pose[3:].tolist()
            turn = np.array(rotation_of_quaternion((w, x, y, z)))
            summed += mass * (pose[:3] + turn @ center)
            total += mass
        if not total or not np.isfinite(summed).all():
            return None
        a, b, c = (summed / total).tolist()
        return a, b, c


def simulate(
    robot: Robot,
    settings: Settings,
    *,
    engine: str | None = None,
    progress: Progress = lambda *_: None,
    child: Child | None = None,
    look: Look = lambda *_: None,
    thresholds: Thresholds | None = None,
) -> list[Run]:
    """Spawn a robot and let it settle, as often as the settings say.

    Args:
        robot: Any robot, read from a description, which finds its meshes.
        settings: How it is spawned.
        engine: The name of an engine; None is the first of the registry.
        progress: Told before each trial: its number, how many.
        child: A process of this engine that waits for the first trial.
        look: Told of each start while the engine goes on from it, to find out what it will be
            asked for.
        thresholds: When a robot is at rest, and what is reported; None is the defaults.

    Raises:
        ModelError: The robot is one that no engine can be given.
        EngineDied: The engine crashed or took too long.
        MissingDependency: It is not installed.
    """
    engine, bounds = engine or next(iter(REGISTRY)), thresholds or Thresholds()
    runs = []
    ends = perf_counter() + settings.time_limit
    for number, trial in enumerate(trials(settings), 1):
        progress(number, settings.trials)
        with (
            (number == 1 and child) or Child(library_of(engine)) as process,
            tempfile.TemporaryDirectory(prefix="urdftool-") as folder,
        ):
            bodies = prepare(robot, trial)
            load_engine(engine).write_model(robot, bodies, trial, Path(folder))
            left = max(0.1, ends - perf_counter()) if number > 1 else settings.time_limit
            known: Known = {}

            def see(start: Start, bodies: Bodies = bodies, known: Known = known) -> None:
                look(robot, Moment(bodies, *start, known, bounds))

            with _placed(robot), meanwhile(robot, see) as hear:
                recording = process.call(
                    *(_DRIVER, "run", engine, bodies, trial, Path(folder), bounds),
                    time_limit=left,
                    hear=hear,
                )
            swept = []
            if settings.sweep and number == 1:
                swept = _sweep(bodies, trial, engine, Path(folder))
        runs.append(Run(trial, bodies, recording, swept, known, bounds))
    return runs


@contextmanager
def _placed(robot: Robot) -> Iterator[None]:
    """Say of what an engine refuses where the robot is written: it knows only the bodies."""
    try:
        yield
    except ModelError as error:
        if error.path is not None or robot.place is None:
            raise
        raise ModelError(error.message, at=robot.place, notes=error.notes) from None


def _sweep(bodies: Bodies, settings: Settings, engine: str, folder: Path) -> list[Swept]:
    """Joints moved through their limits, in a process of its own."""
    with Child(library_of(engine)) as child:
        found: list[Swept] = child.call(
            *(_DRIVER, "sweep", engine, bodies, settings, folder),
            time_limit=settings.time_limit,
        )
    return found


def trials(settings: Settings) -> list[Settings]:
    """The settings of each trial: the first upright, the others tilted and turned by the seed."""
    chance = random.Random(settings.seed)
    found = [settings]
    for _ in range(settings.trials - 1):
        toward = chance.uniform(-math.pi, math.pi)
        tilt = settings.tilt * math.sqrt(chance.random())
        yaw = chance.uniform(-math.pi, math.pi)
        rpy = (tilt * math.cos(toward), tilt * math.sin(toward), yaw)
        found.append(replace(settings, start_rpy=rpy))
    return found
