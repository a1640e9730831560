"""Pairs of links between which no joint moves."""

import pytest

pytest.importorskip("trimesh")

BOX = '<collision><geometry><box size="{0} {0} {0}"/></geometry></collision>'
ROBOT = (
    '<robot name="r"><link name="w"/><link name="a">'
    + BOX.format(1)
    + '</link><link name="b">'
    + BOX.format(1)
    + '</link><link name="c"/>'
    '<joint name="j" type="fixed"><parent link="w"/><child link="a"/></joint>'
    '<joint name="k" type="fixed"><parent link="w"/><child link="b"/><origin xyz="{} 0 0"/></joint>'
    '<joint name="m" type="revolute"><parent link="b"/><child link="c"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
)
SRDF = (
    '<robot name="r"><group name="g"><joint name="m"/></group>'
    '<disable_collisions link1="a" link2="b" reason="Never"/></robot>'
)


@pytest.mark.parametrize("distance", [0.5, 1.0, 1.0000001, 3])
def test_a_pair_that_nothing_moves_ends_without_a_failure(urdftool, tmp_path, distance):
    (tmp_path / "r.urdf").write_text(ROBOT.format(distance))
    (tmp_path / "r.srdf").write_text(SRDF)
    result = urdftool(
        "lint", tmp_path / "r.urdf", "--select", "disabled-pair-can-touch", "--format", "concise"
    )
    assert result.code in (0, 1)
    assert "bug in urdftool" not in result.err
