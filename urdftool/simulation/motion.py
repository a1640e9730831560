"""Motion of a run, as the definition of a robot that stands needs it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..mechanics.standing import (
    DRIFT,
    THE_BASE,
    TILT,
    WINDOW,
    BaseMotion,
    Bounds,
    JointMotion,
    Motion,
    estimate_end,
)
from ..model.pose import rotation_from_quaternion
from .checks.final_state import measure_tilt
from .run import Run
from .shapes import compute_lowest_height


def measure_run_motion(run: Run) -> Motion:
    """Measure how the base and the joints moved from the start of a run to its end.

    A run that was at rest does not go on. Joints that follow another one, that have a controller,
    and wheels that roll are omitted.
    """
    recording, bounds, size = run.recording, run.thresholds, max(run.bodies.size, 1e-3)
    if recording.ended == "lost" or not np.isfinite(recording.poses[-1]).all():
        return Motion(is_finite=False)
    last = len(recording.times) - 1
    window = [last - round(part * _count_samples(run)) for part in (1.0, 0.5)]
    samples = [max(0, sample) for sample in window] + [last]
    if recording.still_since is not None:
        samples = [last] * 3
    return Motion(
        [] if run.bodies.fixed_base else [_measure_base(run, samples)],
        list(_measure_joints(run)),
        bounds=Bounds(
            slide=bounds.slide_failure * size,
            lean=math.degrees(bounds.lean_tilt),
            turn=bounds.joint_drift_turn,
            length=bounds.joint_drift_slide * size,
        ),
    )


def _count_samples(run: Run) -> float:
    """Return the number of samples in the window at the end."""
    times = run.recording.times
    return WINDOW / float(times[1] - times[0]) if len(times) > 1 else 0.0


def _measure_base(run: Run, samples: list[int]) -> BaseMotion:
    poses = run.recording.poses[:, 0]
    moves = poses[samples, :3] - poses[0, :3]
    tilts = [math.degrees(measure_tilt(poses[sample], run)) for sample in samples]
    numbers = range(len(run.bodies.bodies))
    first, last = (run.compute_center_of_mass(numbers, sample) for sample in (0, -1))
    drop = shrinking = 0.0
    lows = _measure_low_points(run, 0)
    lowest = min(lows.values(), default=0.0)
    is_upright = not any(run.settings.start_rpy)  # a tilted start has other heights
    if lows and is_upright and first is not None and last is not None:
        height = max(first[2] - lowest, DRIFT)
        drop = (first[2] - last[2]) / height
        shrinking = drop - (lowest - min(_measure_low_points(run, -1).values())) / height
    return BaseMotion(
        THE_BASE,
        drift=float(np.linalg.norm(moves[-1])),
        slide=abs(estimate_end(np.linalg.norm(moves[:, :2], axis=1).tolist())),
        tilt=tilts[-1],
        lean=abs(estimate_end(tilts)),
        sink=-float(moves[-1, 2]),
        drop=drop,
        shrinking=shrinking,
        resting=tuple(_list_resting_links(run, lows, lowest)) if is_upright else (),
    )


def _measure_low_points(run: Run, sample: int) -> dict[int, float]:
    """Measure the height of the lowest point of each body with shapes in a sample [m]."""
    found = {}
    for number, (body, pose) in enumerate(
        zip(run.bodies.bodies, run.recording.poses[sample], strict=True)
    ):
        if body.shapes:
            x, y, z, w = pose[3:].tolist()
            turn = np.array(rotation_from_quaternion((w, x, y, z)))
            found[number] = compute_lowest_height(body.shapes, turn, pose[:3])
    return found


def _list_resting_links(run: Run, lows: dict[int, float], lowest: float) -> Iterator[str]:
    """List the links on the ground that a base that stays does not bring there."""
    places = run.recording.poses[0]
    for name in dict.fromkeys(contact.one for contact in run.recording.carrying):
        number = run.start.get_body(name)
        reach = math.dist(places[number, :2], places[0, :2]) + run.bodies.size / 10
        if lows.get(number, 0.0) - lowest > DRIFT + math.sin(math.radians(TILT)) * reach:
            yield name


def _measure_joints(run: Run) -> Iterator[JointMotion]:
    from .checks.joints import rolls
    from .control import is_driven

    recording = run.recording
    for column, joint in enumerate(run.bodies.joints):
        if joint.leader is not None or is_driven(run.settings.controls, joint.name):
            continue
        is_held = joint.name in recording.targets
        if (recording.still_since is not None or not is_held) and rolls(run, column):
            continue
        values = recording.positions[:, column]
        start = recording.targets.get(joint.name, float(values[0]))
        yield JointMotion(
            joint.name,
            abs(float(values[-1]) - start),
            is_held=is_held,
            is_slide=joint.kind == "prismatic",
            is_carried=not run.bodies.fixed_base,
        )
