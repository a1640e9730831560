"""Which repair ``--fix-inertia`` chooses."""

import pytest

import urdftool
from urdftool.formats.common.inertia_repair import repair_tensor
from urdftool.geometry.link_extent import compute_box_size
from urdftool.mechanics.spatial_inertia import SpatialInertia
from urdftool.model.pose import IDENTITY, Pose

TENSOR = (1.0, 0.0, 0.0, 1.0, 0.0, 4.0)
"""Of no rigid body: izz exceeds ixx + iyy."""

BODY = SpatialInertia(12.0, (0.0, 0.0, 0.0), TENSOR)
LIFTED = (9.0, 0.0, 0.0, 9.0, 0.0, 9.0)


@pytest.mark.parametrize(
    ("fix", "edges", "made"),
    [
        ("none", (1, 2, 3), LIFTED),
        ("lift", (1, 2, 3), LIFTED),
        ("balance", (1, 2, 3), (2.0, 0.0, 0.0, 2.0, 0.0, 2.0)),
        ("box", (1, 2, 3), (13.0, 0.0, 0.0, 10.0, 0.0, 5.0)),
        ("box", None, LIFTED),
    ],
)
def test_the_choice(fix, edges, made):
    tensor, _ = repair_tensor(fix, BODY, lambda: edges, lift=lambda tensor: LIFTED)
    assert tensor == pytest.approx(made)


def test_the_box_is_that_of_collisions_before_visuals(write):
    shape = "<{0}><geometry><box size='{1}'/></geometry></{0}>"
    a = shape.format("collision", "1 2 3") + shape.format("visual", "9 9 9")
    b = shape.format("visual", "1 1 1")
    robot = urdftool.load(
        write(
            "r.urdf", f'<robot name="r"><link name="a">{a}</link><link name="b">{b}</link></robot>'
        )
    )
    one, other = robot.links
    shifted = Pose(translation=(2.0, 0.0, 0.0))
    assert compute_box_size(robot, [(one, IDENTITY), (other, shifted)]) == (1, 2, 3)
    assert compute_box_size(robot, [(one, IDENTITY), (one, shifted)]) == (3, 2, 3)
    assert compute_box_size(robot, [(other, IDENTITY)]) == (1, 1, 1)
    assert compute_box_size(robot, []) is None
