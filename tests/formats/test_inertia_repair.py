"""Which repair ``--fix-inertia`` chooses."""

import pytest

import urdftool
from urdftool.formats.common.extent import box_size
from urdftool.formats.common.inertia_repair import repair_tensor
from urdftool.model.pose import IDENTITY, Pose


def choose(fix, edges):
    tensor, _ = repair_tensor(
        fix,
        lambda: edges,
        lift=lambda: "lifted",
        balance=lambda: "balanced",
        box=lambda size: f"box {size}",
    )
    return tensor


@pytest.mark.parametrize(
    ("fix", "edges", "made"),
    [
        ("none", (1, 2, 3), "lifted"),
        ("lift", (1, 2, 3), "lifted"),
        ("balance", (1, 2, 3), "balanced"),
        ("box", (1, 2, 3), "box (1, 2, 3)"),
        ("box", None, "lifted"),
    ],
)
def test_the_choice(fix, edges, made):
    assert choose(fix, edges) == made


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
    assert box_size(robot, [(one, IDENTITY), (other, shifted)]) == (1, 2, 3)
    assert box_size(robot, [(one, IDENTITY), (one, shifted)]) == (3, 2, 3)
    assert box_size(robot, [(other, IDENTITY)]) == (1, 1, 1)
    assert box_size(robot, []) is None
