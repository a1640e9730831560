"""A run as curves over time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..drawing.chart import COLORS, Color, Line, Panel, chart
from ..drawing.png_file import Image
from ..drawing.raster import Indices
from ..model.pose import rotation_of_quaternion
from .recording import Array, Recording
from .run import Run

MOST_NAMED = 8
"""Joints that have a colour and a name; those that move or work most."""

_OTHERS: Color = (190, 194, 200)


def plot(title: str, runs: Sequence[Run]) -> Image:
    """Height, tilt, kinetic energy, positions and efforts of joints, in one figure.

    Args:
        title: Above it.
        runs: One, or the same trial in two engines; the second is dashed.
    """
    panels = [
        Panel("height of the root [m]", _curves(runs, _height), 1e-3),
        Panel("tilt of the root [°]", _curves(runs, _tilt), 0.1),
        Panel("kinetic energy [J]", _curves(runs, lambda run: run.recording.kinetic), 1e-6),
    ]
    if runs[0].recording.joints:
        moved = "joints, from where they start [rad, m]"
        panels.append(Panel(moved, _joints(runs, _moved), 1e-3))
        panels.append(Panel("efforts of joints [N·m, N]", _joints(runs, _efforts), 1e-3))
    still = runs[0].recording.still_since
    mark = None if still is None else (still, "at rest")
    size = (1200, 120 + 190 * len(panels))
    return chart(title, panels, label="time [s]", mark=mark, size=size)


def _height(run: Run) -> Array:
    return run.recording.poses[:, 0, 2]


def _tilt(run: Run) -> Array:
    """How far the root's upright axis is turned from where it was [°]."""
    poses = run.recording.poses[:, 0, 3:]
    ups = []
    for x, y, z, w in poses.tolist():
        whole = all(map(math.isfinite, (x, y, z, w)))
        turn = rotation_of_quaternion((w, x, y, z)) if whole else ((math.nan,) * 3,) * 3
        ups.append(turn[2][2])
    tilts: Array = np.degrees(np.arccos(np.clip(ups, -1.0, 1.0)))
    return tilts


def _moved(recording: Recording) -> Array:
    moved: Array = recording.positions - recording.positions[0]
    return moved


def _efforts(recording: Recording) -> Array:
    return recording.efforts


def _curves(runs: Sequence[Run], of: object) -> tuple[Line, ...]:
    assert callable(of)
    return tuple(
        Line(
            run.recording.engine if len(runs) > 1 else "",
            run.recording.times,
            np.asarray(of(run), dtype=float),
            COLORS[number],
            dashed=number > 0,
        )
        for number, run in enumerate(runs)
    )


def _joints(runs: Sequence[Run], of: object) -> tuple[Line, ...]:
    """The curve of each joint; of many, those that reach farthest have colours and names."""
    assert callable(of)
    names = runs[0].recording.joints
    order = _by_weight(runs[0].recording)
    named = sorted(order[:MOST_NAMED].tolist())
    colors = {column: COLORS[rank] for rank, column in enumerate(named)}
    lines = []
    for column in [*reversed(order[MOST_NAMED:].tolist()), *named]:
        for number, run in enumerate(runs):
            label = names[column] if column in colors and not number else ""
            values = np.asarray(of(run.recording))[:, column]
            lines.append(
                Line(
                    label,
                    run.recording.times,
                    values,
                    colors.get(column, _OTHERS),
                    dashed=number > 0,
                )
            )
    more = len(names) - MOST_NAMED
    if more > 0:
        lines.append(Line(f"{more} more", np.zeros(0), np.zeros(0), _OTHERS))
    return tuple(lines)


def _by_weight(recording: Recording) -> Indices:
    """The joints, first those that move or work most, of what any does."""
    weight = np.zeros(len(recording.joints))
    for values in (_moved(recording), _efforts(recording)):
        most = np.abs(np.nan_to_num(values)).max(axis=0)
        weight += most / max(float(most.max()), 1e-12)
    order: Indices = np.argsort(-weight, kind="stable")
    return order
