"""From a robot to recordings: prepared, given to an engine in its own process, watched."""

from __future__ import annotations

import math
import random
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter

from ..model.elements import Robot
from ..model.pose import Pose, rotation_of_quaternion
from .bodies import Bodies
from .child import Child
from .engines import LIBRARIES
from .prepare import prepare
from .recording import Recording
from .remembered import reading_looks
from .settings import Settings
from .sweep import Swept
from .urdf import write_folder

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class Run:
    """One trial.

    Attributes:
        settings: Of this trial.
        bodies: The robot as it started.
        recording: What the engine measured.
        swept: Each joint moved through its limits; empty where that was not asked for.
    """

    settings: Settings
    bodies: Bodies
    recording: Recording
    swept: list[Swept] = field(default_factory=list)


def body_pose(run: Run, number: int, frame: int = -1) -> Pose:
    """Where a body is in the world, at the end or at another sample."""
    a, b, c, x, y, z, w = run.recording.poses[frame, number].tolist()
    return Pose(rotation_of_quaternion((w, x, y, z)), (a, b, c))


def simulate(
    robot: Robot,
    settings: Settings,
    *,
    engine: str = "bullet",
    progress: Progress = lambda *_: None,
    alter: Callable[[Bodies], Bodies] | None = None,
    child: Child | None = None,
) -> list[Run]:
    """Spawn a robot and let it settle, as often as the settings say.

    Args:
        robot: Any robot, read from a description, which finds its meshes.
        settings: How it is spawned.
        engine: A key of ``LIBRARIES``.
        progress: Told before each trial: its number, how many.
        alter: Changes the bodies before an engine has them.
        child: A process of this engine that waits for the first trial.

    Raises:
        ModelError: The robot is one that no engine can be given.
        EngineDied: The engine crashed or took too long.
        MissingDependency: It is not installed.
    """
    runs = []
    ends = perf_counter() + settings.time_limit
    for number, trial in enumerate(trials(settings), 1):
        progress(number, settings.trials)
        with (
            (number == 1 and child) or Child(LIBRARIES[engine]) as process,
            tempfile.TemporaryDirectory(prefix="urdftool-") as folder,
        ):
            bodies = prepare(robot, trial)
            if alter is not None:
                bodies = alter(bodies)
            _write(robot, bodies, trial, engine, Path(folder))
            left = max(0.1, ends - perf_counter()) if number > 1 else settings.time_limit
            with reading_looks(robot):
                recording = process.call(
                    engine, "run", bodies, trial, Path(folder), time_limit=left
                )
            swept = []
            if settings.sweep and number == 1:
                swept = _sweep(bodies, trial, engine, Path(folder))
        runs.append(Run(trial, bodies, recording, swept))
    return runs


def _write(robot: Robot, bodies: Bodies, settings: Settings, engine: str, folder: Path) -> None:
    """Write what an engine reads."""
    if engine == "mj":
        from .mj_file import write_model

        write_model(robot, bodies, settings, folder)
    else:
        write_folder(bodies, folder)


def _sweep(bodies: Bodies, settings: Settings, engine: str, folder: Path) -> list[Swept]:
    """Joints moved through their limits, in a process of its own."""
    with Child(LIBRARIES[engine]) as child:
        found: list[Swept] = child.call(
            f"{engine}_sweep", "sweep", bodies, settings, folder, time_limit=settings.time_limit
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
