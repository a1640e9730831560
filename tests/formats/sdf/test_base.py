"""The base of a model: as described, decided as MJCF decides, fixed by a joint, or free."""

import pytest

import urdftool
from urdftool.model.load import load

from .robots import joint, link

ARM = f'<robot name="r">{link("a")}{link("b")}{joint("j", "a", "b")}</robot>'
WELDED = (
    f'<robot name="r"><link name="world"/>{link("a")}{link("b")}{joint("j", "a", "b")}'
    f"{joint('w', 'world', 'a', 'fixed')}</robot>"
)
DRONE = ARM.replace("</robot>", "").replace('name="r"', 'name="uav"', 1)
DRONE = (
    DRONE.replace(
        '<link name="a">',
        '<link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision>',
    )
    + "</robot>"
)
STATIC = ARM.replace("</robot>", "<gazebo><static>true</static></gazebo></robot>")


def is_fixed(written):
    return b"<parent>world</parent>" in written.files["model.sdf"]


@pytest.mark.parametrize(
    ("text", "base", "fixed"),
    [
        (ARM, "", False),
        (ARM, "auto", True),
        (ARM, "fixed", True),
        (ARM, "free", False),
        (DRONE, "auto", False),
        (DRONE, "fixed", True),
        (WELDED, "", True),
        (WELDED, "free", True),
        (STATIC, "free", False),
    ],
)
def test_the_base_is_the_chosen_one(write, tmp_path, text, base, fixed):
    robot = load(write("r.urdf", text))
    written = urdftool.export_sdf(robot, tmp_path / "out", base=base, verify=True)
    assert is_fixed(written) == fixed
    assert not [check for check in written.checks if check.verdict == "differs"]


def test_auto_decides_as_the_export_to_mjcf(write):
    robot = load(write("r.urdf", DRONE))
    summaries = (
        urdftool.export_mjcf(robot).summary,
        urdftool.export_mjcf(robot, base="fixed").summary,
    )
    assert [summary[0].split()[0] for summary in summaries] == ["free", "fixed"]


@pytest.mark.parametrize("base", ["", "fixed", "free"])
@pytest.mark.parametrize(
    "pose", ['<origin xyz="0 0 1" rpy="0 0 2"/>', "<gazebo><pose>0 0 1 0 0 2</pose></gazebo>"]
)
def test_the_pose_of_a_robot_counts_once(write, base, pose):
    text = ARM.replace('<link name="a">', f'{pose}<link name="a">', 1)
    written = urdftool.export_sdf(load(write("r.urdf", text)), base=base, verify=True)
    assert written.files["model.sdf"].count(b">0 0 1 0 0 2</pose>") == 1
    assert not [check for check in written.checks if check.verdict == "differs"]
    assert "lossy-other-element" not in [loss.code for loss in written.losses]
