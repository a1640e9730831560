"""The frame of a sensor: the one that its plugin names comes before its link."""

import pytest

from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ROBOT = """<robot name="r">
  <link name="mast"><inertial><mass value="1"/>\
<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <link name="optical"/>
  <joint name="optical_joint" type="fixed"><parent link="mast"/><child link="optical"/>\
<origin rpy="-1.5708 0 -1.5708"/></joint>
  <gazebo reference="mast">
    <sensor name="front" type="camera">
      <plugin name="front" filename="libgazebo_ros_camera.so">
        {frame}
        <topic>front</topic>
      </plugin>
    </sensor>
  </gazebo>
</robot>
"""
FRAMES = ("missing-gz-frame-id", "ros-plugin-inside-sensor")


def _check(tmp_path, frame):
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.format(frame=frame), "utf-8")
    options = Options(Settings(select=FRAMES, targets=frozenset(("gz",))), fixes=True)
    return path, check_file(path, options), options


@pytest.mark.parametrize(
    ("frame", "written"),
    [("<frame_name>optical</frame_name>", "optical"), ("<min_depth>1</min_depth>", "mast")],
)
def test_the_frame_of_the_plugin_is_written(tmp_path, frame, written):
    path, report, options = _check(tmp_path, frame)
    done = fix_description(report, options)
    text = done.after[str(path)].decode()
    assert f"<gz_frame_id>{written}</gz_frame_id>" in text
    assert "libgazebo_ros_camera" in text  # a safe fix removes no plugin


def test_the_frame_is_written_before_the_plugin_is_removed(tmp_path):
    path, report, options = _check(tmp_path, "<frame_name>optical</frame_name>")
    text = fix_description(report, options, unsafe=True).after[str(path)].decode()
    assert text.count("<gz_frame_id>") == 1
    assert "<gz_frame_id>optical<" in text
    assert "plugin" not in text
    assert "<topic>front</topic>" in text


def test_a_frame_that_is_not_a_link_is_reported_and_not_written(tmp_path):
    _, report, options = _check(tmp_path, "<frame_name>elsewhere</frame_name>")
    found = [f for f in report.findings if f.code == "missing-gz-frame-id"]
    assert [f.data["unknown_frame"] for f in found] == ["elsewhere"]
    assert not fix_description(report, options).after
