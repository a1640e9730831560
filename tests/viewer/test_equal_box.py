import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.model.elements import Inertia, Inertial, Origin
from urdftool.model.pose import make_pose
from urdftool.source.document import Element
from urdftool.source.location import SourceFile
from urdftool.viewer.robot_scene import compute_inertia_box

NOWHERE = Element("inertial", {}, None, SourceFile("-", b""), 0, ())
EDGE = st.floats(0.01, 5)
ANGLE = st.floats(-3, 3)


def inertial(mass, moments, rpy=(0.0, 0.0, 0.0), xyz=(0.0, 0.0, 0.0), products=(0.0, 0.0, 0.0)):
    (a, b, c), (ab, ac, bc) = moments, products
    return Inertial(NOWHERE, Origin(NOWHERE, xyz, rpy), mass, Inertia(NOWHERE, a, ab, ac, b, bc, c))


def of_box(mass, x, y, z):
    return [mass / 12 * (u * u + v * v) for u, v in ((y, z), (x, z), (x, y))]


@given(st.floats(0.01, 50), EDGE, EDGE, EDGE, ANGLE, ANGLE, ANGLE)
def test_the_box_of_a_box_is_that_box(mass, x, y, z, roll, pitch, yaw):
    body = inertial(mass, of_box(mass, x, y, z), (roll, pitch, yaw), (1.0, 2.0, 3.0))
    box = compute_inertia_box(body)
    assert box is not None
    assert box.possible
    assert sorted(box.size) == pytest.approx(sorted((x, y, z)), rel=1e-6)
    assert box.pose.translation == pytest.approx((1.0, 2.0, 3.0))
    # its corners are those of the box that was meant, as sets of points
    corners = [
        pose.transform(tuple(s * e / 2 for s, e in zip(signs, size, strict=True)))
        for pose, size in ((box.pose, box.size), (make_pose(body.origin), (x, y, z)))
        for signs in [(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
    ]
    for corner in corners[:8]:
        assert min(math.dist(corner, other) for other in corners[8:]) < 1e-4 * max(x, y, z) + 1e-9


def test_a_tensor_that_no_body_has_is_flat_and_said():
    box = compute_inertia_box(inertial(1.0, (0.1, 0.1, 1.0)))
    assert box is not None
    assert not box.possible
    assert min(box.size) == 0.0


@pytest.mark.parametrize(
    "body",
    [
        None,
        Inertial(NOWHERE, None, 1.0, None),
        inertial(None, (1, 1, 1)),
        inertial(0.0, (1, 1, 1)),
        inertial(-1.0, (1, 1, 1)),
        inertial(1.0, (0, 0, 0)),
        inertial(1.0, (math.nan, 1, 1)),
        inertial(1.0, (math.inf, 1, 1)),
    ],
)
def test_there_is_no_box_without_numbers(body):
    assert compute_inertia_box(body) is None
