"""Declared errors beside those of other code, on heavy meshes of the corpus and of robots."""

import pytest

from measure.benchmarks.heavy import CORPUS
from measure.benchmarks.robots import example_folder
from tests.collision.independent import reach_and_excess
from tests.collision.test_measure import TOO_LOW
from urdftool.collision.choose import choose
from urdftool.collision.settings import Settings
from urdftool.collision.surface import read_surface

pytestmark = pytest.mark.slow

SUFFIXES = (".stl", ".obj", ".dae")
ROBOTS = 20
LEAST, MOST = 100_000, 4_000_000  # bytes
FLOOR = 0.002  # spacing of the points of the other code, relative to the size


def meshes():
    """The nine of the corpus, and one mesh of each of twenty robots."""
    found = sorted(CORPUS.iterdir()) if CORPUS.is_dir() else []
    found = [path for path in found if path.suffix.lower() in SUFFIXES]
    folder = example_folder()
    robots = sorted((folder / "robots").iterdir()) if folder else []
    picked = []
    for robot in robots:
        files = [f for f in robot.rglob("*") if f.suffix.lower() in SUFFIXES]
        files = [f for f in files if LEAST < f.stat().st_size < MOST]
        if files:
            picked.append(max(files, key=lambda f: (f.stat().st_size, f.name)))
    return [*found, *picked[:ROBOTS]]


@pytest.mark.parametrize("path", meshes(), ids=lambda path: f"{path.parent.name}-{path.name}")
def test_an_error_is_not_declared_too_low(path):
    surface = read_surface(path)
    choice = choose(surface, Settings())
    theirs = max(reach_and_excess(surface.corners, choice.pieces, surface.size, points=120_000))
    assert theirs <= TOO_LOW * choice.measures.error + FLOOR
