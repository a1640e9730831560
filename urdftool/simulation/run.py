"""Run the trials of a robot in an engine in a separate process."""

from __future__ import annotations

import math
import random
import tempfile
from collections.abc import Callable, Hashable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import TypeVar

import numpy as np

from ..errors import ModelError
from ..model.elements import Mesh, Robot
from ..model.pose import rotation_from_quaternion
from .checks.thresholds import Thresholds
from .engine_process import EngineProcess
from .engines.base import ExportMjcf
from .engines.registry import REGISTRY, get_library, load_engine
from .mesh_cache import get_outermost_points
from .prepare import prepare
from .recording import Array, Contact, Recording, Swept
from .rigid_bodies import RigidBodyModel
from .settings import Settings
from .state import StateSnapshot

_DRIVER = "engines.driver"

Progress = Callable[[int, int], None]

Known = dict[Hashable, object]

Precompute = Callable[[Robot, StateSnapshot], None]

Start = tuple[Array, list[Contact]]
"""Poses and contacts before the first step, emitted by the engine's process."""


@dataclass(frozen=True, eq=False)
class Run:
    """One trial."""

    settings: Settings
    bodies: RigidBodyModel
    recording: Recording
    swept: list[Swept] = field(default_factory=list)
    known: Known = field(default_factory=dict)
    thresholds: Thresholds = field(default_factory=Thresholds)

    @cached_property
    def start(self) -> StateSnapshot:
        """Return the state before the first step."""
        recorded = self.recording
        return StateSnapshot(
            self.bodies, recorded.poses[0], recorded.start_contacts, self.known, self.thresholds
        )

    @cached_property
    def end(self) -> StateSnapshot:
        """Return the state of the last sample."""
        recorded = self.recording
        return StateSnapshot(
            self.bodies, recorded.poses[-1], recorded.contacts, thresholds=self.thresholds
        )

    def compute_center_of_mass(
        self, numbers: Iterable[int], sample: int
    ) -> tuple[float, float, float] | None:
        """Compute the center of mass of bodies in the world [m], of the mass with gravity.

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
            turn = np.array(rotation_from_quaternion((w, x, y, z)))
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
    export_mjcf: ExportMjcf,
    engine: str | None = None,
    progress: Progress = lambda *_: None,
    child: EngineProcess | None = None,
    precompute: Precompute = lambda *_: None,
    thresholds: Thresholds | None = None,
) -> list[Run]:
    """Spawn a robot and let it settle, once for each trial.

    ``precompute`` receives each start while the engine runs, to compute results for the checks.

    Raises:
        ModelError: The robot cannot be simulated.
        EngineDied: The engine crashed or exceeded its time limit.
        MissingDependency: The engine is not installed.
    """
    engine, bounds = engine or next(iter(REGISTRY)), thresholds or Thresholds()
    runs = []
    left = settings.time_limit
    for number, trial in enumerate(make_trials(settings), 1):
        progress(number, settings.trials)
        with (
            (number == 1 and child) or EngineProcess(get_library(engine)) as process,
            tempfile.TemporaryDirectory(prefix="urdftool-") as folder,
        ):
            bodies = prepare(robot, trial)
            load_engine(engine).write_model(robot, bodies, trial, Path(folder), export_mjcf)
            known: Known = {}

            def on_start(
                start: Start, bodies: RigidBodyModel = bodies, known: Known = known
            ) -> None:
                precompute(robot, StateSnapshot(bodies, *start, known, bounds))

            with _add_location(robot), prefetch(robot, on_start) as on_emit:
                recording = process.call(
                    *(_DRIVER, "run", engine, bodies, trial, Path(folder), bounds),
                    time_limit=left,
                    on_emit=on_emit,
                )
            swept = []
            if settings.sweep and number == 1:
                swept = _sweep(bodies, trial, engine, Path(folder))
        left = max(0.1, left - recording.seconds)
        runs.append(Run(trial, bodies, recording, swept, known, bounds))
    return runs


@contextmanager
def _add_location(robot: Robot) -> Iterator[None]:
    """Add the location of the robot to errors of an engine, which has only the bodies."""
    try:
        yield
    except ModelError as error:
        if error.path is not None or robot.place is None:
            raise
        raise ModelError(error.message, at=robot.place, notes=error.notes) from None


def _sweep(bodies: RigidBodyModel, settings: Settings, engine: str, folder: Path) -> list[Swept]:
    """Move joints through their limits, in a separate process."""
    with EngineProcess(get_library(engine)) as child:
        found: list[Swept] = child.call(
            *(_DRIVER, "sweep", engine, bodies, settings, folder),
            time_limit=settings.time_limit,
        )
    return found


def make_trials(settings: Settings) -> list[Settings]:
    """Make the settings of each trial: the first upright, the others randomly tilted and turned."""
    chance = random.Random(settings.seed)
    found = [settings]
    for _ in range(settings.trials - 1):
        toward = chance.uniform(-math.pi, math.pi)
        tilt = settings.tilt * math.sqrt(chance.random())
        yaw = chance.uniform(-math.pi, math.pi)
        rpy = (tilt * math.cos(toward), tilt * math.sin(toward), yaw)
        found.append(replace(settings, start_rpy=rpy))
    return found


T = TypeVar("T")


@contextmanager
def prefetch(robot: Robot, precompute: Callable[[T], object]) -> Iterator[Callable[[T], None]]:
    """Read the visual meshes of a robot in a thread, then precompute from the first message.

    Errors are ignored: the check that needs the result computes it again, and reports them.

    Yields:
        Function that passes the message, once. The thread has ended at the end of the ``with``
        statement, unless that raised an error.
    """
    messages: SimpleQueue[tuple[T] | None] = SimpleQueue()

    def work() -> None:
        with suppress(Exception):
            prefetch_visuals(robot)
        first = messages.get()
        if first is not None:
            with suppress(Exception):
                precompute(*first)

    thread = Thread(target=work, daemon=True)
    with suppress(RuntimeError):  # the thread limit of the system is reached
        thread.start()
    try:
        yield lambda first: messages.put((first,))
    finally:
        messages.put(None)
    if thread.ident is not None:
        thread.join()


def prefetch_visuals(robot: Robot) -> None:
    """Read the meshes of the visuals."""
    for link in robot.links:
        for visual in link.visuals:
            if isinstance(visual.geometry, Mesh):
                get_outermost_points(robot, visual.geometry)
