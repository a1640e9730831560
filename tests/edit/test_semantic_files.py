"""The SRDF of a robot in another package of its workspace, also in xacro, and files next to it."""

import shutil

import pytest

import urdftool
from tests.conftest import ROOT

ARM = ROOT / "fixtures" / "edit" / "arm_description"
PACKAGE = '<package format="3"><name>{}</name></package>'
POSITIONS = "initial_positions:\n  elbow: 0.25\n"
LIMITS = "joint_limits:\n  elbow:\n    max_velocity: 1.0\n"
CONTROL = """<robot xmlns:xacro="http://wiki.ros.org/xacro"><xacro:macro name="c" params="name">
<ros2_control name="${name}" type="system"><joint name="elbow"/></ros2_control></xacro:macro>
</robot>
"""


@pytest.fixture
def workspace(tmp_path):
    """Return a workspace whose SRDF is in a package of MoveIt, and the SRDF."""
    source = tmp_path / "ws" / "src"
    shutil.copytree(ARM, source / "arm_description")
    srdf = source / "arm_description" / "urdf" / "arm.srdf"
    text = srdf.read_text()
    srdf.unlink()
    config = source / "arm_moveit_config" / "config"
    config.mkdir(parents=True)
    (config.parent / "package.xml").write_text(PACKAGE.format("arm_moveit_config"))
    (config / "arm.srdf").write_text(text)
    (config / "initial_positions.yaml").write_text(POSITIONS)
    (config / "joint_limits.yaml").write_text(LIMITS)
    (config / "arm.ros2_control.xacro").write_text(CONTROL)
    return source


def load(workspace):
    return urdftool.load(workspace / "arm_description" / "urdf" / "arm.urdf")


def list_codes(edited, code):
    return [note for note in edited.notes if note.code == code]


def test_the_srdf_of_another_package_is_edited(workspace):
    edited = load(workspace).prefix("l_")
    assert edited.is_proved
    files = {name: data.decode() for name, data in edited.files.items()}
    assert '<chain base_link="l_base" tip_link="l_tool0"/>' in files["arm.srdf"]
    assert "  l_elbow: 0.25" in files["initial_positions.yaml"]
    assert "  l_elbow:\n    max_velocity" in files["joint_limits.yaml"]
    assert not list_codes(edited, "edit-semantics")
    (note,) = list_codes(edited, "edit-xacro")
    assert note.message == "arm.ros2_control.xacro names joint 'elbow'; xacro is not edited"
    assert note.location.line == 2
    shifted = load(workspace).change_zero({"elbow": 0.25})
    assert "  elbow: 0\n" in shifted.files["initial_positions.yaml"].decode()


def test_an_srdf_in_xacro_is_expanded(workspace):
    config = workspace / "arm_moveit_config" / "config"
    text = (config / "arm.srdf").read_text()
    (config / "arm.srdf").unlink()
    text = text.replace('tip_link="tool0"', 'tip_link="${tip}"').replace(
        '<robot name="arm">',
        '<robot name="$(arg name)" xmlns:xacro="http://wiki.ros.org/xacro">\n'
        '<xacro:arg name="name" default="arm"/><xacro:property name="tip" value="tool0"/>',
    )
    (config / "arm.srdf.xacro").write_text(text)
    edited = load(workspace).prefix("l_")
    srdf = edited.files["arm.srdf"].decode()
    assert '<chain base_link="l_base" tip_link="l_tool0"/>' in srdf
    assert "xacro:" not in srdf
    (config / "arm.srdf.xacro").write_text(text.replace("${tip}", "${nothing}"))
    (note,) = list_codes(load(workspace).prefix("l_"), "edit-semantics")[:1]
    assert "arm.srdf.xacro cannot be expanded, and is not edited" in note.message
    assert note.location.line == 2


def test_of_two_packages_none_is_chosen(workspace):
    other = workspace / "arm_demo_moveit_config"
    shutil.copytree(workspace / "arm_moveit_config", other)
    (other / "package.xml").write_text(PACKAGE.format("arm_demo_moveit_config"))
    edited = load(workspace).prefix("l_")
    (note,) = list_codes(edited, "edit-semantics")
    assert "several packages have one" in note.message
    assert "arm.srdf" not in edited.files
    given = load(workspace).prefix("l_", files=[other / "config" / "arm.srdf"])
    assert "arm.srdf" in given.files
    assert not list_codes(given, "edit-semantics")


def test_a_package_outside_of_the_workspace_is_not_searched(workspace):
    shutil.move(workspace / "arm_moveit_config", workspace.parents[1] / "arm_moveit_config")
    (workspace / ".git").mkdir()
    (note,) = list_codes(load(workspace).prefix("l_"), "edit-semantics")
    assert "nor in another package of its workspace" in note.message
