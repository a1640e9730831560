"""One slip, one proposal; tests/inertia/test_proposal.py undoes each kind against geometry."""

import math

import pytest

from urdftool.mechanics.tensor import rotate_tensor
from urdftool.mechanics.typo_detection import (
    COMPONENTS,
    infer_intended_moment,
    infer_intended_tensor,
    is_consistent,
)
from urdftool.model.bounds import Bounds
from urdftool.model.pose import rotation_from_rpy

BOX = Bounds((-0.05, -0.1, -0.2), (0.05, 0.1, 0.2))
SOLID = (1 / 30, 0.0, 0.0, 17 / 600, 0.0, 1 / 120)
"""2 kg of 0.1 × 0.2 × 0.4 m."""
ORIGIN = (0.0, 0.0, 0.0)


def changed(tensor, **numbers):
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    return tuple(numbers.get(name, value) for name, value in zip(names, tensor, strict=True))


@pytest.mark.parametrize(
    ("wrong", "kind", "name"),
    [
        (changed(SOLID, ixx=1 / 3), "decimal", "ixx"),
        (changed(SOLID, izz=-1 / 120), "sign", "izz"),
        ((1 / 30, 17 / 600, 1 / 120, 0.0, 0.0, 0.0), "order", ""),
        (tuple(1e6 * value for value in SOLID), "unit", ""),
        ((1 / 30, 0.0, 0.0, 1 / 30, 0.0, 1 / 30), "copied", ""),
    ],
)
def test_each_kind_is_told(wrong, kind, name):
    found = infer_intended_tensor(2.0, ORIGIN, wrong, solid=SOLID, box=BOX)
    assert found is not None
    assert (found.kind, found.name) == (kind, name)
    assert found.tensor == pytest.approx(SOLID, rel=1e-12)


@pytest.mark.parametrize(
    ("wrong", "meant"),
    [
        (changed(SOLID, izz=-1 / 120), SOLID),
        ((1 / 30, 17 / 600, 1 / 120, 0.0, 0.0, 0.0), SOLID),
    ],
    ids=["sign", "order"],
)
def test_without_geometry_physics_may_leave_one_way(wrong, meant):
    found = infer_intended_tensor(2.0, ORIGIN, wrong)
    assert found is not None
    assert found.tensor == pytest.approx(meant, rel=1e-12)
    assert "geometry" not in found.sentence


def test_without_geometry_no_decimal_point_can_be_told():
    wrong = changed(SOLID, izz=833.0)
    assert infer_intended_tensor(2.0, ORIGIN, wrong) is None
    found = infer_intended_tensor(2.0, ORIGIN, wrong, box=BOX)
    assert found is not None
    assert found.tensor == pytest.approx(changed(SOLID, izz=0.00833))


def test_without_geometry_what_is_possible_is_left_alone():
    assert infer_intended_tensor(2.0, ORIGIN, tuple(1e6 * value for value in SOLID)) is None


def test_two_ways_are_none():
    assert infer_intended_tensor(2.0, ORIGIN, (1.0, 0.0, 0.0, 1.0, 0.0, 30.0)) is None


def test_a_product_the_shape_does_not_have_gets_no_decimal_point():
    # each of 0.005, 0.0005, … is as good as the next
    wrong = (0.0134, 0.05, 0.0, 0.0134, 0.0, 0.0002)
    assert (
        infer_intended_tensor(1.0, ORIGIN, wrong, solid=(0.0134, 0.0, 0.0, 0.0134, 0.0, 0.0002))
        is None
    )


def test_a_small_moment_is_not_taken_for_near_because_it_is_small():
    wrong = (0.0134, 0.0, 0.0, 0.0134, 0.0, 0.08)
    assert (
        infer_intended_tensor(1.0, ORIGIN, wrong, solid=(0.0134, 0.0, 0.0, 0.0134, 0.0, 0.0002))
        is None
    )


def test_turned_twice():
    rotation = rotation_from_rpy((0.4, 1.0, 0.7))
    wrong = rotate_tensor(SOLID, rotation)
    found = infer_intended_tensor(2.0, ORIGIN, wrong, solid=SOLID, rotation=rotation)
    assert found is not None
    assert found.kind == "frame"
    assert found.tensor == pytest.approx(SOLID, abs=1e-15)


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e-110, 1e110, 1e300, math.inf, math.nan])
def test_numbers_of_no_robot(size):
    wrong = (size, size / 2, size / 3, size, size / 5, -size)
    assert infer_intended_tensor(1.0, ORIGIN, wrong, solid=SOLID, box=BOX) is None
    assert infer_intended_tensor(1.0, ORIGIN, wrong) is None


def test_what_is_possible():
    assert is_consistent(SOLID)
    assert is_consistent((1.0, 0.0, 0.0, 1.0, 0.0, 2.005))  # a plate, rounded
    assert not is_consistent((1.0, 0.0, 0.0, 1.0, 0.0, 2.1))
    assert not is_consistent((1.0, 1.5, 0.0, 1.0, 0.0, 1.0))
    assert not is_consistent((0.0,) * 6)


ROD = (0.1, 0.1, 0.4)
"""Sides [m] of a box whose moments, of 1 kg, are 0.01417, 0.01417 and 0.001667."""


@pytest.mark.parametrize("power", [-6, -3, -2, 2, 3, 6])
@pytest.mark.parametrize("entry", [0, 3])
def test_the_other_moments_tell_a_decimal_point(entry, power):
    right = (0.01417, 0.0, 0.0, 0.0152, 0.0, 0.001667)  # not quite uniform
    wrong = tuple(v * 10.0**power if i == entry else v for i, v in enumerate(right))
    found = infer_intended_moment(1.0, wrong, ROD)
    assert found is not None
    assert found.tensor == pytest.approx(right)
    assert found.name == COMPONENTS[entry]


@pytest.mark.parametrize(
    "tensor",
    [
        (14.17, 0.0, 0.0, 14.17, 0.0, 0.001667e-3),  # two are wrong
        (0.01417, 0.05, 0.0, 0.01417, 0.0, 0.001667),  # a product is too large
        (1.0, 0.0, 0.0, 0.1, 0.0, 0.1),  # a placeholder, far from the size of the body
    ],
)
def test_what_more_than_one_number_explains_has_no_decimal_point(tensor):
    assert infer_intended_moment(1.0, tensor, ROD) is None
