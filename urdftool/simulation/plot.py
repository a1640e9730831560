"""Plot a run over time with Matplotlib's Agg backend, which requires no screen."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ..drawing.raster import Indices
from ..drawing.text import replace_undrawable
from ..isolated import IsolatedProcess
from ..model.pose import rotation_from_quaternion
from .recording import Array, Recording
from .run import Run

MOST_NAMED = 8
"""Number of joints with a color and a name: those with the largest motion and effort. Chosen, no
source.
"""

_COLORS = (
    *("#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2", "#17becf"),
)
_OTHERS = "#bec2c8"
_DPI = 100
"""Pixels of a plot in an inch. Chosen, no source."""

_LONGEST = 600.0
"""Time in which a plot is drawn, on a busy machine, too [s]. Chosen, no source."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve over time.

    Attributes:
        label: Name in the legend; empty for none.
        times: Shape (n,) [s].
        values: Shape (n,); NaN is a gap.
        color: Color of Matplotlib.
        dashed: Whether the line is dashed.
    """

    label: str
    times: Array
    values: Array
    color: str
    dashed: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves with one axis.

    Attributes:
        title: Quantity with its unit.
        curves: Curves of the panel.
        least: Minimum range of the axis, so that rounding errors do not fill it.
    """

    title: str
    curves: tuple[Curve, ...]
    least: float


def plot(title: str, runs: Sequence[Run]) -> bytes:
    """Plot height, tilt, kinetic energy, and positions and efforts of joints, as a PNG file.

    Args:
        title: Title of the figure.
        runs: One run, or the same trial in two engines; the second is dashed.
    """
    panels = [
        Panel("height of the root [m]", _collect_curves(runs, _compute_height), 1e-3),
        Panel("tilt of the root [°]", _collect_curves(runs, _compute_tilt), 0.1),
        Panel("kinetic energy [J]", _collect_curves(runs, lambda run: run.recording.kinetic), 1e-6),
    ]
    if runs[0].recording.joints:
        moved = "joints, relative to the start [rad, m]"
        panels.append(Panel(moved, _make_joint_curves(runs, _get_displacement), 1e-3))
        panels.append(
            Panel("efforts of joints [N·m, N]", _make_joint_curves(runs, _compute_efforts), 1e-3)
        )
    return draw_panels(title, panels, runs[0].recording.still_since)


def draw_panels(title: str, panels: Sequence[Panel], at_rest: float | None = None) -> bytes:
    """Draw panels one below the other over one time axis, as a PNG file."""
    # Matplotlib reads settings in the working directory when it is imported
    with TemporaryDirectory() as folder, IsolatedProcess("matplotlib", folder=folder) as process:
        arguments = title, tuple(panels), at_rest
        data: bytes = process.call(__name__, render.__name__, *arguments, time_limit=_LONGEST)
    return data


def render(title: str, panels: Sequence[Panel], at_rest: float | None) -> bytes:
    """Draw panels as :func:`draw_panels`, in a process of its own, whose settings it changes."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    matplotlib.rcdefaults()  # type: ignore[no-untyped-call,unused-ignore]
    warnings.simplefilter("ignore")  # characters that the font does not have
    matplotlib.rcParams["text.parse_math"] = False  # a name may contain dollar signs
    figure = Figure(figsize=(12, 1.2 + 1.9 * len(panels)), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(replace_undrawable(title))
    rows: Any = figure.subplots(len(panels), 1, sharex=True, squeeze=False)
    for axes, panel in zip(rows[:, 0], panels, strict=True):
        _draw(axes, panel, at_rest)
    rows[-1, 0].set_xlabel("time [s]")
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()


def _draw(axes: Any, panel: Panel, at_rest: float | None) -> None:
    axes.set_title(panel.title, loc="left", fontsize="medium")
    axes.grid(visible=True, alpha=0.4)
    named = []
    for curve in panel.curves:
        style = "--" if curve.dashed else "-"
        (line,) = axes.plot(curve.times, curve.values, style, color=curve.color)
        if curve.label:
            named.append(
                (line, f" {replace_undrawable(curve.label)}")
            )  # a label that starts with _ is not shown
    axes.set_ylim(*_compute_limits(panel))
    if at_rest is not None:
        axes.axvline(at_rest, color="gray", linestyle=":", linewidth=1)
        spot = axes.get_xaxis_transform()
        axes.text(at_rest, 0.97, " at rest", transform=spot, va="top", fontsize="small")
    if named:
        lines, labels = zip(*named, strict=True)
        place = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.0}
        axes.legend(lines, [_format_short(label) for label in labels], fontsize="small", **place)


def _format_short(label: str, most: int = 28) -> str:
    half = (most - 1) // 2
    return label if len(label) <= most else f"{label[:half]}…{label[-half:]}"


def _compute_limits(panel: Panel) -> tuple[float, float]:
    """Compute the range of an axis, with a margin."""
    values = np.concatenate([np.zeros(0), *(curve.values for curve in panel.curves)])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    least = max(panel.least, 1e-6 * max(abs(low), abs(high)))
    if high - low < least:
        middle = (high + low) / 2
        low, high = middle - least / 2, middle + least / 2
    margin = 0.06 * (high - low)
    return low - margin, high + margin


def _compute_height(run: Run) -> Array:
    return run.recording.poses[:, 0, 2]


def _compute_tilt(run: Run) -> Array:
    """Compute the angle between the z axis of the root and that of the world [°]."""
    poses = run.recording.poses[:, 0, 3:]
    ups = []
    for x, y, z, w in poses.tolist():
        whole = all(map(math.isfinite, (x, y, z, w)))
        turn = rotation_from_quaternion((w, x, y, z)) if whole else ((math.nan,) * 3,) * 3
        ups.append(turn[2][2])
    tilts: Array = np.degrees(np.arccos(np.clip(ups, -1.0, 1.0)))
    return tilts


def _get_displacement(recording: Recording) -> Array:
    moved: Array = recording.positions - recording.positions[0]
    return moved


def _compute_efforts(recording: Recording) -> Array:
    return recording.efforts


def _collect_curves(runs: Sequence[Run], measure: Callable[[Run], Array]) -> tuple[Curve, ...]:
    return tuple(
        Curve(
            run.recording.engine if len(runs) > 1 else "",
            run.recording.times,
            np.asarray(measure(run), dtype=float),
            _COLORS[number],
            dashed=number > 0,
        )
        for number, run in enumerate(runs)
    )


def _make_joint_curves(
    runs: Sequence[Run], measure: Callable[[Recording], Array]
) -> tuple[Curve, ...]:
    """Make a curve for each joint; only those with the largest values have colors and names."""
    names = runs[0].recording.joints
    order = _sort_joints(runs[0].recording)
    named = sorted(order[:MOST_NAMED].tolist())
    colors = {column: _COLORS[rank] for rank, column in enumerate(named)}
    curves = []
    for column in [*reversed(order[MOST_NAMED:].tolist()), *named]:
        for number, run in enumerate(runs):
            label = names[column] if column in colors and not number else ""
            values = np.asarray(measure(run.recording))[:, column]
            color = colors.get(column, _OTHERS)
            curves.append(Curve(label, run.recording.times, values, color, dashed=number > 0))
    more = len(names) - MOST_NAMED
    if more > 0:
        curves.append(Curve(f"{more} more", np.zeros(0), np.zeros(0), _OTHERS))
    return tuple(curves)


def _sort_joints(recording: Recording) -> Indices:
    """Sort the joints by motion and effort, relative to the largest of all joints."""
    weight = np.zeros(len(recording.joints))
    for values in (_get_displacement(recording), _compute_efforts(recording)):
        most = np.abs(np.nan_to_num(values)).max(axis=0)
        weight += most / max(float(most.max()), 1e-12)
    order: Indices = np.argsort(-weight, kind="stable")
    return order
