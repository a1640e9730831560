"""Links with many shapes: only shapes at one place are compared with each other."""

import pytest

from urdftool import load
from urdftool.compare import shapes
from urdftool.compare.compare import compare_robots
from urdftool.model import drawn

COUNT = 60
SHAPE = '<{0}><origin xyz="{1} {2} 0"/><geometry><box size="0.1 0.2 {3}"/></geometry></{0}>'


def terrain(shift=0.0, height=0.3, places=range(COUNT)):
    parts = [
        SHAPE.format(kind, i + (shift if i == 7 else 0), i, height if i == 7 else 0.3)
        for i in places
        for kind in ("visual", "collision")
    ]
    return f'<robot name="r"><link name="a">{"".join(parts)}</link></robot>'


@pytest.fixture
def compare(write):
    def find(**changes):
        paths = write("a.urdf", terrain()), write("b.urdf", terrain(**changes))
        return compare_robots(*map(load, paths)).differences

    return find


@pytest.mark.parametrize(
    ("changes", "rows"),
    [
        ({}, []),
        ({"shift": 5e-6}, []),
        ({"places": reversed(range(COUNT))}, []),
        ({"shift": 0.01}, ["collisions", "visuals"]),
        ({"height": 0.31}, ["collisions", "visuals"]),
    ],
)
def test_a_shape_that_differs_is_found(compare, changes, rows):
    found = [d for d in compare(**changes) if d.amount > 1e-5]
    assert sorted({d.row for d in found}) == rows


def test_the_number_of_comparisons_grows_with_the_number_of_shapes(compare, monkeypatch):
    counts = {"_measure": 0, "_repeats": 0}

    def count(module, name):
        original = getattr(module, name)

        def counted(*arguments):
            counts[name] += 1
            return original(*arguments)

        monkeypatch.setattr(module, name, counted)

    count(shapes, "_measure")
    count(drawn, "_repeats")
    compare()
    assert 2 * COUNT <= counts["_measure"] <= 4 * COUNT
    assert counts["_repeats"] <= 4 * COUNT
