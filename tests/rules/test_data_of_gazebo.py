"""Findings on Gazebo and control carry their values as data."""

import pytest

from tests.conftest import FIXTURES
from urdftool import check

LISTS = """<robot name="r">
  <link name="base"/><link name="l"/><link name="r"/>
  <joint name="left" type="continuous"><parent link="base"/><child link="l"/></joint>
  <joint name="right" type="continuous"><parent link="base"/><child link="r"/></joint>
  <gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
    <left_joint>left, right</left_joint></plugin></gazebo>
</robot>
"""
BLOCKS = """<robot name="r">
  <link name="base"/><link name="l"/>
  <joint name="left" type="continuous"><parent link="base"/><child link="l"/></joint>
  <ros2_control name="a" type="system"><joint name="left">
    <command_interface name="velocity"/>{}</joint></ros2_control>
  {}
</robot>
"""
OTHER_BLOCK = """<ros2_control name="b" type="system"><joint name="left">
    <command_interface name="velocity"/></joint></ros2_control>"""


@pytest.mark.parametrize(
    ("fixture", "targets", "data"),
    [
        ("dangling-reference/bad", (), {"name": "chasis", "suggestion": "chassis"}),
        ("bad-extension-number/bad", (), {}),
        ("bad-extension-number/bad_suffix", (), {"write": "1.0"}),
        (
            "missing-gz-frame-id/bad_own_pose",
            ("gz", "ros2"),
            {"sensors": ["front"], "link": "mast"},
        ),
        (
            "missing-gz-frame-id/bad_pose_of_link",
            ("gz",),
            {"sensors": ["front"], "link": "mast", "frame": "lens"},
        ),
        (
            "camera-sensor-not-optical/bad",
            ("gz",),
            {"frame": "camera_link", "optical_frame": "camera_optical_frame"},
        ),
        (
            "plugin-unknown-entity/bad_near",
            (),
            {"kind": "joint", "missing": ["whel_joint"], "suggestion": "wheel_joint"},
        ),
        ("transmission-unknown-joint/bad", (), {"joint": "swign", "suggestion": "swing"}),
        (
            "ros2-control-wrong-sim-plugin/bad",
            ("gz",),
            {"write": "gz_ros2_control/GazeboSimSystem"},
        ),
        ("mass-ratio/bad", ("gazebo-classic",), {"carried": 1, "carrying": 0.005, "ratio": 200}),
    ],
)
def test_data_of_a_finding(fixture, targets, data):
    path = FIXTURES / "rules" / f"{fixture}.urdf"
    (found,) = check(path, select=[path.parent.name], targets=targets)
    assert found.data == pytest.approx(data) if "ratio" in data else found.data == data


def test_names_of_a_list_are_written_one_by_one(write):
    (found,) = check(write("r.urdf", LISTS), select=["plugin-unknown-entity"], fixes=True)
    assert found.data == {"kind": "joint", "names": ["left", "right"]}
    assert found.fix.message == "write 2 <left_joint>"


@pytest.mark.parametrize(
    ("block", "data", "is_fixed"),
    [
        ("a", {"interface": "velocity"}, True),
        ("b", {"interface": "velocity", "block": "a"}, False),
    ],
)
def test_a_second_interface_is_removed_only_within_a_block(write, block, data, is_fixed):
    more = '<command_interface name="velocity"/>' if block == "a" else ""
    text = BLOCKS.format(more, "" if block == "a" else OTHER_BLOCK)
    rule = "ros2-control-duplicate-interface"
    (found,) = check(write("r.urdf", text), select=[rule], fixes=True)
    assert found.data == data
    assert (found.fix is not None) == is_fixed
