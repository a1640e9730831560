"""Reach, excess and volume, beside those of code that shares nothing with them."""

import numpy as np
import pytest

from tests.collision.independent import reach_and_excess
from tests.collision.shapes import l_profile, turned
from urdftool.collision.convex import compute_hull
from urdftool.collision.exterior import COARSE, FINE, flood
from urdftool.collision.measure import ReferenceSurface, measure
from urdftool.collision.piece import make_mesh_piece, make_primitive
from urdftool.collision.surface import prepare

TOO_LOW = 1.1
"""Largest ratio of an error by other code to the declared one."""

SIZES = ((1, 1, 1), (1, 0.1, 0.1), (1, 0.05, 0.2), (0.4, 0.3, 0.02))


def boxes(*placed):
    """A surface of boxes, each given by size and center."""
    made = [make_primitive("box", size, np.eye(3), center) for size, center in placed]
    corners = np.concatenate([box.corners for box in made]).reshape(-1, 3)
    return prepare(corners, np.arange(len(corners)).reshape(-1, 3))


@pytest.mark.parametrize("cell", [COARSE, pytest.param(FINE, marks=pytest.mark.slow)])
@pytest.mark.parametrize("size", SIZES)
def test_the_volume_of_the_closing_of_a_box(size, cell):
    rotation = turned(np.random.default_rng(1))
    for axes in (np.eye(3), rotation):
        corners = make_primitive("box", size, axes, (0, 0, 0)).corners
        diagonal = float(np.linalg.norm(np.ptp(corners.reshape(-1, 3), axis=0)))
        exterior = flood(corners, diagonal, cell)
        assert exterior.volume == pytest.approx(np.prod(size), rel=10 * cell)
        assert exterior.is_touchable(corners.reshape(-1, 3)).all()


def test_the_three_numbers_of_a_hull_over_a_slot():
    # 0.2 x 0.1 x 0.1 with a slot, 0.02 wide and 0.08 deep, which the hull fills
    surface = boxes(
        ((0.2, 0.1, 0.02), (0, 0, 0.01)),
        ((0.09, 0.1, 0.08), (-0.055, 0, 0.06)),
        ((0.09, 0.1, 0.08), (0.055, 0, 0.06)),
    )
    found = measure(ReferenceSurface(surface), [make_mesh_piece(*compute_hull(surface.vertices))])
    assert found.buried == pytest.approx(0.05, rel=0.05)  # to the open sides of the slot
    assert found.uncovered == pytest.approx(0, abs=1e-9)
    assert found.collision_to_visual == pytest.approx(0.01, rel=0.1)
    assert found.volume_ratio == pytest.approx(0.002 / (0.002 - 0.02 * 0.08 * 0.1), rel=0.02)
    table = found.as_dict()
    assert table["error"] == max(table["reach"], table["excess"])
    assert table["reach"] == pytest.approx(0.05 / surface.size, rel=0.05)


def test_a_gap_between_pieces_is_not_a_surface_to_touch():
    # two halves of a cube with a crack that the ball cannot enter: its middle is 0.1 deep
    surface = boxes(((0.2, 0.2, 0.2), (0, 0, 0)), ((0.01, 0.01, 0.2), (0, 0.105, 0)))
    halves = [
        make_primitive("box", (0.0995, 0.22, 0.2), np.eye(3), (side * 0.05025, 0.01, 0))
        for side in (-1, 1)
    ]
    found = measure(ReferenceSurface(surface), halves)
    assert found.buried == pytest.approx(0.02, rel=0.1)


def test_a_collision_that_is_too_small_is_uncovered():
    surface = boxes(((0.2, 0.1, 0.1), (0, 0, 0)))
    inner = make_primitive("box", (0.18, 0.1, 0.1), np.eye(3), (0, 0, 0))
    found = measure(ReferenceSurface(surface), [inner])
    assert (found.buried, found.collision_to_visual) == pytest.approx((0, 0), abs=1e-3)
    assert found.uncovered == pytest.approx(0.01, rel=1e-3)


@pytest.mark.slow
def test_other_code_finds_the_same():
    surface = prepare(*l_profile())
    low = make_mesh_piece(*compute_hull(surface.vertices))
    legs = [
        make_primitive("box", (0.2, 0.06, 0.1), np.eye(3), (0.1, 0.03, 0.05)),
        make_primitive("box", (0.05, 0.16, 0.1), np.eye(3), (0.025, 0.12, 0.05)),
    ]
    for pieces in ([low], legs):
        found = measure(ReferenceSurface(surface), pieces)
        theirs = max(reach_and_excess(surface.corners, pieces, surface.size, points=40_000))
        assert found.error == pytest.approx(theirs, rel=0.1)
        assert theirs <= TOO_LOW * found.error
