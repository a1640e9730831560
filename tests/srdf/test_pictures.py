"""Pictures and pages of the poses at which links touch."""

import math

import pytest

pytest.importorskip("fcl")

from tests.srdf.test_prove import sphere_arm
from urdftool.drawing.pair_sheet import MOST, draw_pair_sheet
from urdftool.drawing.picture_cache import read_size
from urdftool.drawing.shapes import read_robot_shapes
from urdftool.model.load import load
from urdftool.model.pair_pose import PairPose

SRDF = """<robot name="r">
  <disable_collisions link1="post" link2="tip" reason="{}"/>
</robot>
"""


@pytest.mark.parametrize(
    ("reason", "gap", "drawn"),
    [
        ("Never", -0.01, True),
        ("Adjacent", -0.01, True),
        ("User", -0.01, False),
        ("Never", 1, False),
    ],
)
def test_check_draws_the_disabled_pairs_that_touch(urdftool, write, tmp_path, reason, gap, drawn):
    write("r.urdf", sphere_arm(gap))
    write("r.srdf", SRDF.format(reason))
    result = urdftool("srdf", "r.urdf", "--check", "r.srdf", "-j", "1", "--picture", "p.png")
    assert result.code == int(drawn)
    assert (tmp_path / "p.png").exists() == drawn
    words = "wrote p.png: 1 pair in contact" if drawn else "so p.png is not written"
    assert words in result.err


def test_both_links_are_drawn_where_they_touch(write):
    robot = load(write("r.urdf", sphere_arm(-0.01)))
    shapes = read_robot_shapes(robot, show="collision")
    pairs = [PairPose("post", "tip", {"turn": 0.0}), PairPose("post", "tip", {"turn": math.pi})]
    image = draw_pair_sheet(robot, shapes, pairs, title="t", cell=(200, 160))
    for half in (image[:, : image.shape[1] // 2], image[:, image.shape[1] // 2 :]):
        red, _, blue = (half[..., k].astype(int) for k in range(3))
        assert ((red - blue) > 60).sum() > 50
        assert ((blue - red) > 60).sum() > 50
    assert (image[:, :200] != image[:, 216:416]).any()


def test_a_sheet_has_at_most_some_pictures(write):
    robot = load(write("r.urdf", sphere_arm(-0.01)))
    shapes = read_robot_shapes(robot, show="collision")
    pairs = [PairPose("post", "tip", {"turn": 0.0})] * (MOST + 5)
    few, many = (
        draw_pair_sheet(robot, shapes, some, title="t", cell=(64, 64)).shape
        for some in (pairs[:MOST], pairs)
    )
    assert few == many


def test_srdf_draws_all_pairs_that_touch(urdftool, write, tmp_path):
    write("r.urdf", sphere_arm(-0.01))
    result = urdftool("srdf", "r.urdf", "-o", "r.srdf", "-j", "1", "--picture", "p.png")
    assert result.code == 0
    assert read_size((tmp_path / "p.png").read_bytes())[0] > 100


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("srdf", "r.urdf", "--picture", "p.jpg"), "ends in .png"),
        (("srdf", "r.urdf", "--picture", "p.png", "--moveit", "d"), "exclude each other"),
        (("view", "r.urdf", "--srdf", "r.srdf", "--picture", "p.png"), "--srdf is for the page"),
        (("view", "r.urdf", "--srdf", "no.srdf"), "no.srdf"),
        (("view", "r.urdf", "--srdf", "other.srdf"), "is of another robot"),
    ],
)
def test_what_cannot_be_drawn_is_refused(urdftool, write, words, error):
    write("r.urdf", sphere_arm(-0.01))
    write("r.srdf", SRDF.format("Never"))
    write("other.srdf", SRDF.format("Never").replace("post", "a").replace("tip", "b"))
    result = urdftool(*words)
    assert result.code == 2
    assert error in result.err
