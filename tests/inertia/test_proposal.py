"""Each slip is undone; what has no single explanation gets no proposal."""

import numpy as np
import pytest

from urdftool.inertia.proposal import propose
from urdftool.inertia.solids import box, cylinder
from urdftool.inertia.tensor import (
    is_possible,
    move,
    rotate,
    rotation_from_rpy,
    shift_from_com,
    tensor_from_six,
)

SIZE = (0.1, 0.2, 0.4)
BODY = box(SIZE, mass=2.0)
HALF = np.array(SIZE) / 2
TURNED = move(BODY, xyz=(0.02, 0.03, 0.05), rpy=(0.3, 0.2, 0.4))


def asked(inertia, body=BODY, **options):
    return propose(body.mass, body.com, inertia, implied=body, **options)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("power", [-3, -1, 1, 2])
def test_decimal_slip(axis, power):
    wrong = BODY.inertia.copy()
    wrong[axis, axis] *= 10.0**power
    found = asked(wrong, box=(-HALF, HALF))
    assert found is not None
    assert found.kind == "decimal"
    np.testing.assert_allclose(found.inertia, BODY.inertia, rtol=1e-12)
    assert ["ixx", "iyy", "izz"][axis] in found.sentence


@pytest.mark.parametrize("power", [-6, -3, 3, 6, 9])
def test_common_power_of_ten(power):
    found = asked(BODY.inertia * 10.0**power)
    assert found is not None
    assert found.kind == "unit"
    np.testing.assert_allclose(found.inertia, BODY.inertia, rtol=1e-12)


def test_square_millimetres_are_named():
    assert "kg·mm²" in asked(BODY.inertia * 1e6).sentence


def test_sign():
    wrong = BODY.inertia.copy()
    wrong[1, 1] *= -1
    found = asked(wrong)
    assert found.kind == "sign"
    np.testing.assert_allclose(found.inertia, BODY.inertia)


def test_order_of_the_six_numbers():
    xx, xy, xz, yy, yz, zz = TURNED.inertia[np.triu_indices(3)]
    for wrong in (tensor_from_six(xx, yy, zz, xy, xz, yz), tensor_from_six(xx, xy, yy, xz, yz, zz)):
        found = asked(wrong, TURNED)
        assert found is not None
        assert found.kind == "order"
        np.testing.assert_allclose(found.inertia, TURNED.inertia, rtol=1e-12)


def test_axes_exchanged():
    found = asked(np.diag(np.roll(np.diag(BODY.inertia), 1)))
    assert found is not None
    assert found.kind == "axes"
    np.testing.assert_allclose(found.inertia, BODY.inertia)


def test_about_the_origin():
    away = move(BODY, xyz=(0.3, 0.2, 0.1))
    wrong = shift_from_com(away.inertia, away.mass, away.com)
    found = asked(wrong, away)
    assert found is not None
    assert found.kind == "origin"
    np.testing.assert_allclose(found.inertia, away.inertia, atol=1e-12)


def test_frame_of_the_inertial():
    rotation = rotation_from_rpy((0.4, 1.0, 0.7))
    found = asked(rotate(TURNED.inertia, rotation), TURNED, rotation=rotation)
    assert found is not None
    assert found.kind == "frame"
    np.testing.assert_allclose(found.inertia, TURNED.inertia, atol=1e-12)


def test_one_value_copied_to_all_axes():
    body = box((1, 1, 0.5), mass=1024)
    found = asked(np.eye(3) * 170.667, body)
    assert found is not None
    assert found.kind == "copied"
    assert [round(value, 3) for value in np.diag(found.inertia)] == [106.667, 106.667, 170.667]
    assert "106.667, 106.667, 170.667" in found.sentence
    assert found.as_dict()["inertia"]["ixx"] == pytest.approx(106.6667, rel=1e-5)


def test_box_alone_is_enough_where_only_one_repair_is_possible():
    # the triangle inequality leaves izz no other power of ten
    found = propose(2.0, (0, 0, 0), np.diag([0.0333, 0.0283, 833.0]), box=(-HALF, HALF))
    assert found is not None
    assert found.inertia[2, 2] == pytest.approx(0.00833)
    # a round part in a round box: all axes exchanged are the same, but one power fits as the next
    assert propose(2.0, (0, 0, 0), BODY.inertia * 1e6, box=(-HALF, HALF)) is None


@pytest.mark.parametrize(
    "inertia",
    [BODY.inertia, BODY.inertia * 1.2, cylinder(0.09, 0.4, mass=2.0).inertia],
    ids=["right", "heavier outside", "another shape"],
)
def test_what_fits_is_left_alone(inertia):
    assert asked(inertia, box=(-HALF, HALF)) is None


@pytest.mark.parametrize(
    "inertia",
    [np.diag([1.0, 2.0, 40.0]), np.full((3, 3), np.nan), np.zeros((3, 3))],
    ids=["nonsense", "nan", "zero"],
)
def test_no_explanation_no_proposal(inertia):
    assert asked(inertia) is None


def test_without_geometry_nothing_is_proposed():
    assert propose(1.0, (0, 0, 0), np.diag([1.0, 1.0, 30.0])) is None


def test_a_proposal_is_always_possible():
    random = np.random.default_rng(1)
    for _ in range(300):
        wrong = random.normal(size=(3, 3)) * 10.0 ** random.integers(-4, 1)
        found = asked(wrong + wrong.T, box=(-HALF, HALF))
        if found is not None:
            assert is_possible(found.inertia, positivity_tolerance=1e-6, triangle_tolerance=0.01)
