"""Pictures and animations of a run."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from ..drawing.camera import Camera, View
from ..drawing.gif_file import encode_gif
from ..drawing.picture import SIZE, draw
from ..drawing.png_file import Image
from ..drawing.raster import Indices
from ..drawing.shapes import Shapes
from ..model.pose import Pose, rotation_from_quaternion
from .recording import Array, Recording
from .run import Run

FILM = (480, 360)
"""Width and height of an animation [pixels]. Chosen, no source."""

RATE = 20.0
"""Frame rate of an animation of up to ``MOST`` frames [1/s]. Chosen, no source."""

MOST = 240
"""Maximum number of frames; a longer run has a lower frame rate."""

_STILL = 2e-4
"""Of the robot's size, or rad: a smaller change repeats the frame. Chosen, no source."""

_HOLD = 1.0
"""S, duration of the last frame. Chosen, no source."""

_AWAY = 3.0  # distance from the start, in robot sizes, beyond which the camera does not follow

Progress = Callable[[int, int], None]


def link_poses(run: Run, poses: Array) -> dict[str, Pose]:
    """Compute the pose of each link in the world.

    Args:
        run: A run.
        poses: Poses of its bodies, shape (b, 7), as in ``Recording``.
    """
    found = {}
    for body, row in zip(run.bodies.bodies, poses, strict=True):
        x, y, z, qx, qy, qz, qw = row.tolist()
        pose = Pose(rotation_from_quaternion((qw, qx, qy, qz)), (x, y, z))
        for link, place in body.places.items():
            found[link] = pose @ place
    return found


def render_final_state(
    run: Run, shapes: Shapes, *, camera: Camera | None = None, size: tuple[int, int] = SIZE
) -> Image:
    """Draw the robot on the plane at the end of a run."""
    last = run.recording.poses[_find_finite(run.recording)[-1]]
    return draw(
        shapes, link_poses(run, last), camera=camera, size=size, ground=_get_floor(run, last)
    )


def render_animation(
    run: Run,
    shapes: Shapes,
    *,
    camera: Camera | None = None,
    size: tuple[int, int] = FILM,
    progress: Progress = lambda *_: None,
) -> bytes:
    """Render a run as a GIF, from a fixed camera."""
    view = _view(run, shapes, camera or Camera(), size)
    frames: list[Image] = []
    seconds: list[float] = []
    drawn: Array | None = None
    samples = list(_list_frames(run.recording))
    for number, (poses, time) in enumerate(samples, 1):
        progress(number, len(samples))
        if drawn is not None and _is_same_pose(run, poses, drawn):
            seconds[-1] += time
            continue
        drawn = poses
        frames.append(
            draw(shapes, link_poses(run, poses), camera=view, ground=_get_floor(run, poses))
        )
        seconds.append(time)
    seconds[-1] += _HOLD
    return encode_gif(frames, seconds)


def _find_finite(recording: Recording) -> Indices:
    """Find the samples whose poses are finite."""
    rows: Indices = np.flatnonzero(np.isfinite(recording.poses).all(axis=(1, 2)))
    return rows


def _get_floor(run: Run, poses: Array) -> float | bool:
    """Return the height of the plane, or False if the robot is below it."""
    reach = max(run.bodies.size, 0.1)
    return False if float(poses[:, 2].max()) < -reach else 0.0


def _list_frames(recording: Recording) -> Iterator[tuple[Array, float]]:
    """List poses of the bodies at equal time steps, with the duration of each frame [s]."""
    rows = _find_finite(recording)
    times = recording.times[rows]
    length = float(times[-1])
    step = max(1 / RATE, math.ceil(100 * length / MOST) / 100)
    for number in range(int(length / step + 1e-6) + 1):
        time = number * step
        after = min(int(np.searchsorted(times, time)), len(rows) - 1)
        before = max(0, after - 1)
        one, two = recording.poses[rows[before]], recording.poses[rows[after]]
        gap = float(times[after] - times[before])
        part = (time - float(times[before])) / gap if gap > 0 else 1.0
        yield _interpolate(one, two, part), step


def _interpolate(one: Array, two: Array, part: float) -> Array:
    """Interpolate linearly between two poses of all bodies, with normalized quaternions."""
    turns = np.where((one[:, 3:] * two[:, 3:]).sum(axis=1, keepdims=True) < 0, -1.0, 1.0)
    poses = one * (1 - part)
    poses[:, :3] += part * two[:, :3]
    poses[:, 3:] += part * turns * two[:, 3:]
    poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
    return poses


def _is_same_pose(run: Run, one: Array, two: Array) -> bool:
    moved = float(np.abs(one[:, :3] - two[:, :3]).max()) / max(run.bodies.size, 1e-3)
    turned = float(np.abs(np.abs((one[:, 3:] * two[:, 3:]).sum(axis=1)) - 1).max())
    return moved < _STILL and turned < _STILL**2


def _view(run: Run, shapes: Shapes, camera: Camera, size: tuple[int, int]) -> View:
    """Place a camera that shows the whole run while the robot is near its start."""
    recording = run.recording
    rows = _find_finite(recording)
    distances = np.linalg.norm(recording.poses[rows, 0, :3] - recording.poses[0, 0, :3], axis=1)
    near = rows[distances < _AWAY * max(run.bodies.size, 0.1)]
    some = near[np.unique(np.linspace(0, len(near) - 1, 9).astype(int))]
    boxes = []
    for row in some:
        corners, _, there = shapes.transform(link_poses(run, recording.poses[row]))
        boxes.append(corners[there].reshape(-1, 3))
    points = np.concatenate(boxes)
    return camera.view(points, size)
