"""Curves of runs."""

import io
import itertools
import re
import subprocess
import sys
from importlib.util import find_spec

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation.plot import Curve, Panel, draw_panels, plot
from urdftool.simulation.settings import Settings

pytest.importorskip("mujoco")

pytestmark = pytest.mark.library("matplotlib", "PIL")

RED = (214, 39, 40)


def pixels(data):
    from PIL import Image

    return np.array(Image.open(io.BytesIO(data)).convert("RGB"))


def _columns(image, color):
    """Where a color is in a picture: rows by column."""
    near = np.abs(image.astype(int) - color).sum(axis=2) < 40
    return {int(x): np.flatnonzero(near[:, x]) for x in np.flatnonzero(near.any(axis=0))}


def panel(x, y, label=""):
    return Panel("p", (Curve(label, x, y, "#d62728"),), 1e-6)


def test_a_curve_is_where_its_numbers_are():
    x = np.linspace(0, 1, 50)
    rows = _columns(pixels(draw_panels("t", [panel(x, x)])), RED)
    middle = [float(found.mean()) for found in rows.values()]
    assert len(middle) > 300
    straight = np.linspace(middle[0], middle[-1], len(middle))
    assert np.abs(straight - middle).max() < 2
    assert middle[0] - middle[-1] > 60


def test_what_is_not_a_number_is_a_gap():
    x = np.linspace(0, 1, 101)
    y = np.where((x > 0.4) & (x < 0.6), np.nan, 1.0)
    seen = sorted(_columns(pixels(draw_panels("t", [panel(x, y)])), RED))
    assert max(b - a for a, b in itertools.pairwise(seen)) > 50


@pytest.mark.parametrize("values", [np.full(5, np.nan), np.zeros(5), np.full(5, 1e30)])
def test_curves_without_extent_are_drawn_all_the_same(values):
    image = pixels(draw_panels("", [panel(np.arange(5.0), values, "x" * 500)]))
    assert image.shape == (310, 1200, 3)


SLOW_NAMES = ["$x", "_hidden", "a$b$", "\x1b[2J", "機械", "$" * 40]


@pytest.mark.parametrize(
    "name",
    [r"\frac{", *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW_NAMES)],
)
def test_names_are_drawn_as_they_are_written(name, recwarn):
    x = np.linspace(0, 1, 50)
    named, plain = (pixels(draw_panels(name, [panel(x, x, label)])) for label in (name, ""))
    assert not recwarn
    columns = [max(_columns(image, RED)) for image in (named, plain)]
    assert columns[0] > 600
    assert (named != plain).any()


@pytest.mark.slow
def test_a_run_is_plotted_the_same_each_time():
    robot = load(FIXTURES / "robots" / "mira_description" / "urdf" / "mira.urdf")
    (run,) = simulate(robot, Settings(duration=0.3), engine="mujoco")
    image = plot("mira", [run])
    assert pixels(image).shape == (120 + 190 * 5, 1200, 3)
    assert image == plot("mira", [run])
    assert pixels(plot("mira", [run, run])).shape == pixels(image).shape


def test_the_settings_of_the_user_and_of_the_folder_do_not_matter(monkeypatch, tmp_path, capfd):
    x = np.linspace(0, 1, 50)
    before = draw_panels("t", [panel(x, x)])
    for folder in (tmp_path, tmp_path / "config"):
        folder.mkdir(exist_ok=True)
        (folder / "matplotlibrc").write_text("secret text\nlines.linewidth: 9\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLCONFIGDIR", str(tmp_path / "config"))
    assert draw_panels("t", [panel(x, x)]) == before
    assert "secret" not in "".join(capfd.readouterr())


@pytest.mark.slow
@pytest.mark.skipif(not find_spec("pybullet"), reason="requires both engines")
def test_nothing_else_is_printed_when_python_ends(tmp_path):
    """Hulls that a cycle of Matplotlib kept alive would be listed by manifold3d's binding."""
    robot = FIXTURES / "robots" / "ros2_arm" / "urdf" / "robot2_sound.urdf.xacro"
    target = tmp_path / "plot.png"
    words = ("simulate", robot, "--limp", "--engine", "both", "--plot", target)
    done = subprocess.run(
        [sys.executable, "-m", "urdftool", *map(str, words)], capture_output=True, text=True
    )
    lines = [line for line in done.stderr.splitlines() if not re.fullmatch(r"\d+ s", line)]
    assert lines == [f"wrote {target}"], "besides the time, which a slow machine prints"
