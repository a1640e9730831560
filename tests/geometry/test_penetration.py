"""How deep convex shapes overlap: closed forms, and the field's collision library as a judge."""

import math
import random

import pytest

from urdftool.geometry.penetration import compute_overlap, make_convex
from urdftool.model.elements import Box, Capsule, Cylinder, Sphere
from urdftool.model.pose import IDENTITY, Pose, rotation_from_rpy


def at(x=0.0, y=0.0, z=0.0, rpy=(0.0, 0.0, 0.0)):
    return Pose(rotation_from_rpy(rpy), (x, y, z))


def box(*size):
    return Box(None, size)


def test_boxes_overlap_by_the_least_of_three_lengths():
    one = make_convex(box(2, 2, 2), IDENTITY)
    other = make_convex(box(2, 2, 2), at(1.9, 0.5, 0))
    assert compute_overlap(one, other) == pytest.approx(0.1)


def test_spheres_overlap_along_the_line_of_their_centres():
    one = make_convex(Sphere(None, 1.0), IDENTITY)
    other = make_convex(Sphere(None, 0.5), at(0.6, 0.6, 0.6))
    assert compute_overlap(one, other) == pytest.approx(1.5 - 0.6 * math.sqrt(3))


def test_crossed_cylinders_overlap_by_their_radii():
    one = make_convex(Cylinder(None, 0.1, 2.0), IDENTITY)
    other = make_convex(Cylinder(None, 0.1, 2.0), at(0, 0.15, 0, (0, math.pi / 2, 0)))
    assert compute_overlap(one, other) == pytest.approx(0.05, rel=1e-3)


def test_capsule_is_longer_than_its_cylinder():
    floor = make_convex(box(2, 2, 2), at(0, 0, -1))
    assert compute_overlap(
        make_convex(Capsule(None, 0.2, 1.0), at(0, 0, 0.6)), floor
    ) == pytest.approx(0.1)


def test_an_edge_before_an_edge_is_apart():
    turned = (0, math.pi / 4, 0)
    one = make_convex(box(1, 4, 1), at(rpy=turned))
    other = make_convex(box(4, 1, 1), at(z=1.45, rpy=(math.pi / 4, 0, 0)))
    assert compute_overlap(one, other) == 0.0 or compute_overlap(one, other) < 0
    nearer = make_convex(box(4, 1, 1), at(z=1.38, rpy=(math.pi / 4, 0, 0)))
    assert compute_overlap(one, nearer) == pytest.approx(math.sqrt(2) - 1.38, abs=0.01)


def test_no_more_is_told_than_was_asked():
    one, other = make_convex(box(1, 1, 1), IDENTITY), make_convex(box(1, 1, 1), at(0.95))
    assert compute_overlap(one, other, 0.1) <= 0.1
    assert compute_overlap(one, other, 0.01) == pytest.approx(0.05)


@pytest.mark.parametrize("shape", [box(0, 0, 0), Sphere(None, 0.0), None])
def test_what_has_no_size_is_nothing(shape):
    assert make_convex(shape, IDENTITY) is None


def test_coal_says_the_same_of_what_overlaps():
    """Of a thousand random pairs, each that overlaps and nearly each that is apart is told so."""
    coal = pytest.importorskip("coal")
    import numpy as np

    rng = random.Random(1)

    def shape():
        a, b, c = (rng.uniform(0.05, 0.5) for _ in range(3))
        kind = rng.choice(["box", "cylinder", "sphere"])
        if kind == "box":
            return box(a, b, c), coal.Box(a, b, c)
        if kind == "cylinder":
            return Cylinder(None, a, b), coal.Cylinder(a, b)
        return Sphere(None, a), coal.Sphere(a)

    apart = said = 0
    for _ in range(1000):
        placed = []
        for _ in range(2):
            ours, theirs = shape()
            pose = at(
                *(rng.uniform(-0.3, 0.3) for _ in range(3)),
                tuple(rng.uniform(-3, 3) for _ in range(3)),
            )
            there = coal.Transform3s(np.array(pose.rotation), np.array(pose.translation))
            placed.append((make_convex(ours, pose), theirs, there))
        (one, coal_one, there), (other, coal_other, here) = placed
        result = coal.DistanceResult()
        distance = coal.distance(coal_one, there, coal_other, here, coal.DistanceRequest(), result)
        depth = compute_overlap(one, other)
        assert distance > -2e-3 or depth > 0, "what overlaps is never said to be apart"
        apart += distance > 2e-3
        said += distance > 2e-3 and depth <= 0
    assert apart > 200
    assert said >= 0.98 * apart
