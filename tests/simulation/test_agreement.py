"""Two engines on one robot: they agree, or the cause that was planted is found."""

import json
import math
from importlib.util import find_spec
from unittest import mock

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT
from urdftool.model.load import load
from urdftool.simulation import agreement
from urdftool.simulation.agreement import compare, differences
from urdftool.simulation.run import simulate
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

ROBOTS = FIXTURES / "robots"

pytestmark = pytest.mark.skipif(
    not (find_spec("pybullet") and find_spec("mujoco")), reason="wants both engines"
)


def _both(robot, **settings):
    chosen = Settings(**settings)
    runs = [simulate(robot, chosen, engine=engine) for engine in ("pybullet", "mujoco")]
    return chosen, *([judge(robot, run) for run in some] for some in runs)


@pytest.mark.parametrize(
    ("path", "settings"),
    [
        ("mira_description/urdf/mira.urdf", {}),
        ("my_robot/urdf/mobile_manipulator.urdf.xacro", {}),
        pytest.param(
            "laser_bot/urdf/laser_bot.urdf.xacro",
            {"trials": 3, "timestep": 0.0005},  # at 0.002 s a wheel of MuJoCo turns by one degree
            marks=pytest.mark.slow,
        ),
        pytest.param("demo_arm/urdf/arm_sound.urdf.xacro", {}, marks=pytest.mark.slow),
        ("ros2_arm/urdf/robot2_sound.urdf.xacro", {"hold": "none"}),
    ],
)
def test_fixture_robots_agree(path, settings):
    _, first, second = _both(load(ROBOTS / path), **settings)
    for one, other in zip(first, second, strict=True):
        assert compare(one, other) == []


HANGING = """<robot name="r"><link name="world"/>
 <joint name="slide" type="prismatic"><parent link="world"/><child link="block"/>
  <origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-0.5" upper="0.5" effort="{effort}"
  velocity="1"/><dynamics damping="5"/></joint>
 <link name="block"><inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01"
  iyz="0" izz="0.01"/></inertial>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>{more}</robot>"""

WEIGHTLESS = """<robot name="r"><link name="base">
  <collision><geometry><box size="0.4 0.4 0.1"/></geometry></collision></link>
 <joint name="post" type="continuous"><parent link="base"/><child link="arm"/>
  <origin xyz="0.1 0 0.1"/><axis xyz="0 0 1"/></joint>
 <link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="2"/><inertia ixx="0.01" ixy="0"
  ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link></robot>"""


@pytest.mark.slow
def test_a_root_without_mass_is_found_to_be_the_cause(write):
    """PyBullet nails it down; MuJoCo, which gives it hardly any, lets it tip."""
    robot = load(write("robot.urdf", WEIGHTLESS))
    chosen, first, second = _both(robot)
    faults = differences(robot, chosen, first, second)
    assert faults
    assert "link 'base' weighs nothing" in faults[0].cause
    assert all(fault.kind == "engines-differ" and fault.fails for fault in faults)


def test_what_holds_in_both_is_no_difference(write):
    robot = load(write("robot.urdf", HANGING.format(effort=50, more="")))
    chosen, first, second = _both(robot)
    assert differences(robot, chosen, first, second) == []


def test_the_command_tells_of_differences_as_json(urdftool, write):
    result = urdftool(
        *("simulate", "--engine", "both", "--format", "json", write("robot.urdf", WEIGHTLESS)),
    )
    assert result.code == 1, result.err
    said = json.loads(result.out)
    schema = json.loads((ROOT / "docs" / "schemas" / "simulate.json").read_text("utf-8"))
    jsonschema.Draft202012Validator(schema).validate(said)
    assert [trial["engine"].split()[0] for trial in said["trials"]] == ["PyBullet", "MuJoCo"]
    assert said["differences"][0]["kind"] == "engines-differ"


@pytest.mark.slow
def test_the_command_compares(urdftool):
    result = urdftool(
        "simulate", "--engine", "both", ROBOTS / "mira_description" / "urdf" / "mira.urdf"
    )
    assert result.code == 0, result.err
    assert "PyBullet" in result.out
    assert "MuJoCo" in result.out
    assert result.out.endswith("the engines agree\n")


@pytest.mark.parametrize(
    ("excess", "said"),
    [
        (40.0, "without that they are 20 times closer"),
        (math.inf, "whether it comes to rest, and are 2 times as far apart as they may be"),
    ],
)
def test_how_much_a_cause_explains_is_a_number(monkeypatch, excess, said):
    apart = [agreement.Difference("when it rests", "link", "a", 0.0, excess, 1.0, "s")]
    monkeypatch.setattr(agreement, "_sunk", lambda *_: "")
    monkeypatch.setattr(agreement, "_tries", lambda *_: [agreement._Try("the timestep")])
    monkeypatch.setattr(agreement, "_again", lambda *_: [2.0])
    verdict = mock.Mock()
    assert agreement.explained(mock.Mock(), verdict, verdict, apart).endswith(said)
