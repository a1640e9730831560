"""``urdftool schema``, and the JSON of fixes by the schema that it prints."""

import json
import shutil

import jsonschema
import pytest

from tests.conftest import FIXTURES
from urdftool import cli
from urdftool.report.schemas import find_schemas, read_title

RULES = FIXTURES / "rules"


def schema_of(urdftool, *words):
    done = urdftool("schema", *words)
    assert done.code == 0, done.err
    return json.loads(done.out)


def test_all_schemas_are_listed_with_commands_that_exist(urdftool):
    listed = urdftool("schema").out.splitlines()
    assert [line.split()[0] for line in listed] == list(find_schemas())
    assert len(listed) > 15
    for line in listed:
        assert line.split()[1] == "urdftool"
        assert line.split()[2] in cli.COMMANDS


@pytest.mark.parametrize("name", find_schemas())
def test_each_is_a_schema(urdftool, name):
    schema = schema_of(urdftool, name)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["properties"]["version"] == {"const": 1} or name == "inertia"


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["inertia", "robot"], "inertia-robot"),
        (["inertia", "robot", "--write"], "inertia-write"),
        (["simulate", "--fleet"], "simulate-fleet"),
        (["expand"], "source-map"),
        (["lint", "--explain"], "rules"),
    ],
)
def test_a_command_line_names_its_schema(urdftool, words, name):
    assert schema_of(urdftool, *words)["title"] == read_title(find_schemas()[name])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["lnt"], "there is no schema 'lnt'; did you mean 'lint'?"),
        (["server"], "there is no schema 'server'; 'urdftool schema' lists the schemas"),
    ],
)
def test_an_unknown_schema_is_an_error(urdftool, words, message):
    done = urdftool("schema", *words)
    assert (done.code, done.out) == (2, "")
    assert message in done.err


# Fixes ----------------------------------------------------------------------------------------


def fix(urdftool, path, *words):
    done = urdftool("lint", path, "--format", "json", *words)
    table = json.loads(done.out)
    jsonschema.validate(table, schema_of(urdftool, "lint"))
    return table, done.code


@pytest.fixture
def robot(tmp_path):
    return shutil.copy(RULES / "axis-not-unit" / "bad.urdf", tmp_path / "arm.urdf")


def test_a_fix_that_needs_an_option_is_refused_with_it(urdftool, robot):
    before = robot.read_bytes()
    table, code = fix(urdftool, robot, "--fix")
    assert code == 1
    assert robot.read_bytes() == before
    assert table["fixes"]["applied"] == []
    (refused,) = table["fixes"]["refused"]
    (finding,) = table["findings"]
    assert refused["reason"] == "needs-option"
    assert refused["options"] == ["--unsafe-fixes"]
    assert refused["fingerprint"] == finding["fingerprint"]


def test_what_was_applied_has_its_edits(urdftool, robot):
    lines = robot.read_text().splitlines()
    table, code = fix(urdftool, robot, "--fix", "--unsafe-fixes")
    assert code == 0
    assert table["findings"] == []
    assert table["fixes"]["written"] is True
    (applied,) = table["fixes"]["applied"]
    for edit in applied["fix"]["edits"]:
        row = edit["start"]["line"] - 1
        assert edit["end"]["line"] - 1 == row
        start, end = edit["start"]["column"] - 1, edit["end"]["column"] - 1
        lines[row] = lines[row][:start] + edit["replacement"] + lines[row][end:]
    assert robot.read_text().splitlines() == lines


def test_with_diff_nothing_is_written(urdftool, robot):
    before = robot.read_bytes()
    table, code = fix(urdftool, robot, "--diff", "--unsafe-fixes")
    assert code == 1
    assert robot.read_bytes() == before
    assert table["fixes"]["written"] is False
    assert [one["rule"] for one in table["fixes"]["applied"]] == ["axis-not-unit"]


def test_a_fix_in_a_macro_that_another_robot_needs_is_refused(urdftool, tmp_path):
    robot = tmp_path / "two.urdf.xacro"
    robot.write_text("""<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="part" params="name axis">
    <link name="${name}">
      <inertial>
        <mass value="1"/>
        <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
      </inertial>
    </link>
    <joint name="${name}_joint" type="continuous">
      <parent link="base"/>
      <child link="${name}"/>
      <axis xyz="${axis} 0 0"/>
    </joint>
  </xacro:macro>
  <link name="base"/>
  <xacro:part name="one" axis="2"/>
  <xacro:part name="two" axis="1"/>
</robot>
""")
    table, _ = fix(urdftool, robot, "--fix", "--unsafe-fixes", "--select", "axis-not-unit")
    done = table["fixes"]["applied"], table["fixes"]["refused"]
    assert [len(one) for one in done] in ([1, 0], [0, 1])
    if done[1]:
        assert done[1][0]["reason"] == "not-in-source"


def test_fixes_that_write_meshes_follow_the_schema(urdftool, tmp_path):
    folder = tmp_path / "robot"
    shutil.copytree(RULES / "ascii-stl", folder)
    only = ("--select", "ascii-stl")
    table, _ = fix(urdftool, folder / "bad.urdf", "--diff", "--fix-meshes", "--unsafe-fixes", *only)
    assert any("files" in one["fix"] for one in table["fixes"]["applied"])
