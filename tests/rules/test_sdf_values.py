"""Values of SDF in files and blocks; which are rejected was run in sdformat 12.3."""

import pytest

from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.model.sdf_schema import find_requirement
from urdftool.source.document import parse
from urdftool.source.location import SourceFile

INERTIAL = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)


@pytest.mark.parametrize(
    ("tag", "text", "effect"),
    [
        ("mass", "abc", "reject"),
        ("mass", "5 kg", "beginning"),
        ("mass", "1e3", ""),
        ("mass", "true", ""),  # libsdformat reads 1
        ("mass", "", ""),  # takes the default
        ("mass", "${m}", "reject"),
        ("pose", "0 0 1", "reject"),
        ("pose", "0 0 1 0 0 0", ""),
    ],
)
def test_what_libsdformat_does_with_a_value(tag, text, effect):
    element = parse(
        SourceFile("r.sdf", f"<inertial><{tag}>{text}</{tag}></inertial>".encode())
    ).root.children[0]
    required = find_requirement("inertial", element)
    assert (required.effect if required else "") == effect


def check(tmp_path, blocks, links=""):
    path = tmp_path / "r.urdf"
    base = f'<link name="base">{INERTIAL}</link>'
    path.write_text(f'<robot name="r">{base}{links}{blocks}</robot>')
    return check_file(path, Options(Settings(select=("invalid-sdf-value",)))).findings


SENSOR = '<sensor name="s" type="imu"><always_on>yes</always_on></sensor>'


def test_a_block_of_a_link_that_gazebo_keeps(tmp_path):
    (finding,) = check(tmp_path, f'<gazebo reference="base">{SENSOR}</gazebo>')
    assert "'yes', not true or false, so Gazebo rejects the model" in finding.message


def test_a_block_that_gazebo_ignores_rejects_nothing(tmp_path):
    links = (
        '<link name="tip"/><joint name="j" type="fixed">'
        '<parent link="base"/><child link="tip"/></joint>'
    )
    assert not check(tmp_path, f'<gazebo reference="j">{SENSOR}</gazebo>', links)
    assert not check(tmp_path, f'<gazebo reference="nowhere">{SENSOR}</gazebo>', links)
    assert check(tmp_path, f'<gazebo reference="tip">{SENSOR}</gazebo>', links)


def test_parameters_of_plugins_and_expressions_have_no_type(tmp_path):
    plugin = '<plugin name="p" filename="f"><update_rate>fast</update_rate></plugin>'
    assert not check(tmp_path, f"<gazebo>{plugin}</gazebo>")
    sensor = SENSOR.replace("yes", "${on}")
    assert not check(tmp_path, f'<gazebo reference="base">{sensor}</gazebo>')
