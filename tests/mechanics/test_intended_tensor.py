"""Each slip is undone; what has no single explanation gets no proposal."""

import numpy as np
import pytest

from tests.mechanics.bodies import move
from urdftool.inertia.solids import box, cylinder
from urdftool.mechanics.tensor import (
    from_matrix,
    get_diagonal,
    make_diagonal_tensor,
    measure_consistency,
    rotate_tensor,
)
from urdftool.mechanics.typo_detection import infer_intended_tensor
from urdftool.model.bounds import Bounds
from urdftool.model.pose import rotation_from_rpy

SIZE = (0.1, 0.2, 0.4)
BODY = box(SIZE, mass=2.0)
AROUND = Bounds((-0.05, -0.1, -0.2), (0.05, 0.1, 0.2))
TURNED = move(BODY, xyz=(0.02, 0.03, 0.05), rpy=(0.3, 0.2, 0.4))


def asked(tensor, body=BODY, **options):
    return infer_intended_tensor(body.mass, body.com, tensor, solid=body.tensor, **options)


def scaled(tensor, factor):
    return tuple(factor * value for value in tensor)


def changed(tensor, entry, factor):
    return tuple(factor * value if i == entry else value for i, value in enumerate(tensor))


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("power", [-3, -1, 1, 2])
def test_decimal_slip(axis, power):
    found = asked(changed(BODY.tensor, (0, 3, 5)[axis], 10.0**power), box=AROUND)
    assert found is not None
    assert found.kind == "decimal"
    np.testing.assert_allclose(found.tensor, BODY.tensor, rtol=1e-12)
    assert ["ixx", "iyy", "izz"][axis] in found.sentence


@pytest.mark.parametrize("power", [-6, -3, 3, 6, 9])
def test_common_power_of_ten(power):
    found = asked(scaled(BODY.tensor, 10.0**power))
    assert found is not None
    assert found.kind == "unit"
    np.testing.assert_allclose(found.tensor, BODY.tensor, rtol=1e-12)


def test_square_millimetres_are_named():
    assert "kg·mm²" in asked(scaled(BODY.tensor, 1e6)).sentence


def test_sign():
    found = asked(changed(BODY.tensor, 3, -1.0))
    assert found.kind == "sign"
    np.testing.assert_allclose(found.tensor, BODY.tensor)


def test_order_of_the_six_numbers():
    xx, xy, xz, yy, yz, zz = TURNED.tensor
    for wrong in ((xx, yy, zz, xy, xz, yz), (xx, xy, yy, xz, yz, zz)):
        found = asked(wrong, TURNED)
        assert found is not None
        assert found.kind == "order"
        np.testing.assert_allclose(found.tensor, TURNED.tensor, rtol=1e-12)


def test_axes_exchanged():
    found = asked(make_diagonal_tensor(*np.roll(np.diag(BODY.inertia), 1).tolist()))
    assert found is not None
    assert found.kind == "axes"
    np.testing.assert_allclose(found.tensor, BODY.tensor)


def test_about_the_origin():
    away = move(BODY, xyz=(0.3, 0.2, 0.1))
    found = asked(away.about_origin, away)
    assert found is not None
    assert found.kind == "origin"
    np.testing.assert_allclose(found.tensor, away.tensor, atol=1e-12)


def test_frame_of_the_inertial():
    rotation = rotation_from_rpy((0.4, 1.0, 0.7))
    found = asked(rotate_tensor(TURNED.tensor, rotation), TURNED, rotation=rotation)
    assert found is not None
    assert found.kind == "frame"
    np.testing.assert_allclose(found.tensor, TURNED.tensor, atol=1e-12)


def test_one_value_copied_to_all_axes():
    body = box((1, 1, 0.5), mass=1024)
    found = asked(make_diagonal_tensor(170.667, 170.667, 170.667), body)
    assert found is not None
    assert found.kind == "copied"
    assert get_diagonal(found.tensor) == pytest.approx((106.667, 106.667, 170.667), abs=5e-4)
    assert "106.667, 106.667, 170.667" in found.sentence


def test_box_alone_is_enough_where_only_one_repair_is_possible():
    # the triangle inequality leaves izz no other power of ten
    found = infer_intended_tensor(
        2.0, (0.0, 0.0, 0.0), make_diagonal_tensor(0.0333, 0.0283, 833.0), box=AROUND
    )
    assert found is not None
    assert found.tensor[5] == pytest.approx(0.00833)
    # a round part in a round box: all axes exchanged are the same, but one power fits as the next
    assert infer_intended_tensor(2.0, (0.0, 0.0, 0.0), scaled(BODY.tensor, 1e6), box=AROUND) is None


@pytest.mark.parametrize(
    "tensor",
    [BODY.tensor, scaled(BODY.tensor, 1.2), cylinder(0.09, 0.4, mass=2.0).tensor],
    ids=["right", "heavier outside", "another shape"],
)
def test_what_fits_is_left_alone(tensor):
    assert asked(tensor, box=AROUND) is None


@pytest.mark.parametrize(
    "tensor",
    [make_diagonal_tensor(1.0, 2.0, 40.0), (np.nan,) * 6, (0.0,) * 6],
    ids=["nonsense", "nan", "zero"],
)
def test_no_explanation_no_proposal(tensor):
    assert asked(tensor) is None


def test_without_geometry_nothing_is_proposed():
    assert infer_intended_tensor(1.0, (0.0, 0.0, 0.0), make_diagonal_tensor(1.0, 1.0, 30.0)) is None


def test_a_proposal_is_always_possible():
    random = np.random.default_rng(1)
    for _ in range(300):
        wrong = random.normal(size=(3, 3)) * 10.0 ** random.integers(-4, 1)
        found = asked(from_matrix(wrong + wrong.T), box=AROUND)
        if found is not None:
            judged = measure_consistency(found.tensor)
            assert judged.excess <= 0.01
            assert judged.negativity <= 1e-6
