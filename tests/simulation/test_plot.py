"""Curves of runs."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import FIXTURES
from urdftool.drawing.chart import COLORS, Line, Panel, chart, ticks
from urdftool.model.load import load
from urdftool.simulation.plot import plot
from urdftool.simulation.run import simulate
from urdftool.simulation.settings import Settings

pytest.importorskip("mujoco")


@given(
    st.floats(-1e9, 1e9),
    st.floats(1e-9, 1e9),
    st.integers(2, 12),
)
def test_ticks_are_round_and_few(low, span, count):
    high = low + span
    if high - low < 1e-9 * abs(low):
        return
    found = ticks(low, high, count)
    assert len(found) <= count + 1
    if len(found) > 2:
        step = found[1] - found[0]
        digits = step / 10.0 ** math.floor(math.log10(step) + 1e-6)
        assert min(abs(digits - good) for good in (1, 2, 5, 10)) < 0.02 or step < 1e-6 * abs(low)


def _columns(image, color):
    """Where a colour is in a picture: rows by column."""
    near = np.abs(image.astype(int) - color).sum(axis=2) < 40
    return {int(x): np.flatnonzero(near[:, x]) for x in np.flatnonzero(near.any(axis=0))}


def test_a_curve_is_where_its_numbers_are():
    x = np.linspace(0, 1, 50)
    image = chart("t", [Panel("p", (Line("", x, x, COLORS[0]),))], size=(700, 300))
    rows = _columns(image, COLORS[0])
    middle = [float(found.mean()) for found in rows.values()]
    assert len(middle) > 300
    slope = np.diff(middle)
    assert slope.max() <= 1.0
    assert middle[0] - middle[-1] == pytest.approx(-sum(slope))
    straight = np.linspace(middle[0], middle[-1], len(middle))
    assert np.abs(straight - middle).max() < 2


def test_what_is_no_number_is_a_gap():
    x = np.linspace(0, 1, 101)
    y = np.where((x > 0.4) & (x < 0.6), np.nan, 1.0)
    image = chart("t", [Panel("p", (Line("", x, y, COLORS[3]),))], size=(700, 300))
    seen = sorted(_columns(image, COLORS[3]))
    assert max(b - a for a, b in itertools.pairwise(seen)) > 50


@pytest.mark.parametrize("values", [np.full(5, np.nan), np.zeros(5), np.full(5, 1e30)])
def test_curves_without_extent_are_drawn_all_the_same(values):
    line = Line("x" * 500, np.arange(5.0), values, COLORS[0])
    assert chart("", [Panel("", (line,))]).shape == (1000, 1200, 3)
    assert chart("", []).shape == (1000, 1200, 3)


def test_a_run_is_plotted_the_same_each_time():
    robot = load(FIXTURES / "robots" / "mira_description" / "urdf" / "mira.urdf")
    (run,) = simulate(robot, Settings(duration=0.3), engine="mujoco")
    image = plot("mira", [run])
    assert image.shape == (120 + 190 * 5, 1200, 3)
    assert (image == plot("mira", [run])).all()
    assert plot("mira", [run, run]).shape == image.shape
