"""How much room convex parts share, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from urdftool.model.pose import Pose, rotation_from_rpy
from urdftool.simulation.solids import Solids, compute_hulls

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)


def cube(x=0.0, y=0.0, z=0.0):
    """Corners of a cube of one metre, moved."""
    return CUBE + np.array([x, y, z])


def ball(radius, count=4000):
    """Points of a sphere, spread evenly."""
    steps = np.arange(count) + 0.5
    z = 1 - 2 * steps / count
    angle = steps * np.pi * (1 + 5**0.5)
    ring = np.sqrt(1 - z * z)
    return radius * np.stack([ring * np.cos(angle), ring * np.sin(angle), z], axis=1)


def test_boxes_share_a_box():
    one, other = compute_hulls([CUBE]), compute_hulls([cube(0.75, 0.5, -0.25)])
    assert one.compute_shared_volume(other) == pytest.approx(0.25 * 0.5 * 0.75)
    assert one.compute_shared_volume(compute_hulls([cube(2, 2, 2)])) == 0


def test_a_union_counts_what_parts_share_once():
    both = compute_hulls([CUBE, cube(0.5, 0, 0)])
    assert both.volume == pytest.approx(1.5)
    assert (both | compute_hulls([cube(1, 0, 0)])).volume == pytest.approx(2.0)
    assert both.compute_shared_volume(compute_hulls([cube(0.25, 0, 0)])) == pytest.approx(1.0)


def test_what_is_moved_is_where_the_pose_puts_it():
    pose = Pose(rotation_from_rpy((0, 0, math.pi / 4)), (0.5, 0.5, 0.0))
    turned = compute_hulls([cube(-0.5, -0.5)]).transform(pose)
    # a square and the same turned by 45 degrees share an octagon
    assert turned.compute_shared_volume(compute_hulls([CUBE])) == pytest.approx(
        2 * (math.sqrt(2) - 1)
    )


def test_round_parts_keep_nearly_all_of_their_volume():
    found = compute_hulls([ball(0.1)])
    assert found.volume == pytest.approx(4 / 3 * math.pi * 0.1**3, rel=0.08)
    assert found.compute_shared_volume(compute_hulls([ball(0.2)])) == pytest.approx(found.volume)


def test_flat_parts_and_none_share_nothing():
    flat = compute_hulls([CUBE * [1, 1, 0]])
    assert not flat
    assert flat.volume == 0
    assert flat.compute_shared_volume(compute_hulls([CUBE])) == 0
    assert Solids([]).compute_shared_volume(Solids([])) == 0
