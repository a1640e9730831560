"""Two engines on one robot: they agree, or differ in a table with the possible causes."""

import json
import math
from dataclasses import replace
from importlib.util import find_spec

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.report.simulate import format_comparison_text
from urdftool.simulation.engine_comparison import (
    MOST_CAUSES,
    Difference,
    EngineComparison,
    compare,
    compare_engines,
)
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


def test_a_root_without_mass_is_the_first_cause(write):
    """PyBullet holds it; MuJoCo gives it hardly any mass, and lets it tip."""
    robot = load(write("robot.urdf", WEIGHTLESS))
    _, first, second = _both(robot)
    comparison = compare_engines(first, second)
    assert comparison.differences
    assert "link 'base' has no mass" in comparison.causes[0]
    assert 1 < len(comparison.causes) <= MOST_CAUSES
    for fault in comparison.report_faults(robot):
        assert (fault.code, fault.fails) == ("engines-differ", True)
        assert fault.cause == "; ".join(comparison.causes)


def test_engines_that_agree_have_no_difference_and_no_cause(write):
    robot = load(write("robot.urdf", HANGING.format(effort=50, more="")))
    _, first, second = _both(robot)
    comparison = compare_engines(first, second)
    assert comparison.differences == comparison.causes == ()
    assert format_comparison_text(comparison) == "\nthe engines agree\n"


@pytest.fixture(scope="module")
def hanging(tmp_path_factory):
    """A verdict on a block that hangs on a damped slide, and one on it a bit lower."""
    path = tmp_path_factory.mktemp("hanging") / "robot.urdf"
    path.write_text(HANGING.format(effort=10, more=""))
    robot = load(path)
    (run,) = simulate(robot, Settings(duration=2.0))
    lower = run.recording.positions - 0.1
    moved = replace(run, recording=replace(run.recording, positions=lower))
    return judge(robot, run), judge(robot, moved)


def test_a_sliding_joint_may_differ_by_a_length(hanging):
    (part,) = compare(*hanging)
    assert (part.kind, part.name, part.unit) == ("joint", "slide", "m")
    assert part.one - part.other == pytest.approx(0.1)
    assert part.bound == pytest.approx(0.001)
    assert part.excess == pytest.approx(100)


def test_the_causes_are_those_of_the_joint_that_differs(hanging):
    causes = compare_engines(*([verdict] for verdict in hanging)).causes
    assert [cause.partition(" ")[0] for cause in causes] == ["effort:", "friction", "time"]
    assert "joint 'slide'" in causes[0]


def test_only_one_that_rests_is_the_only_difference(hanging):
    moving = replace(hanging[1], rest=replace(hanging[1].rest, settled=None))
    (part,) = compare(hanging[0], moving)
    assert (part.unit, part.excess) == ("s", math.inf)
    assert part.write_value(part.one).startswith("after ")
    assert part.write_value(part.other) == "not within the duration"


def test_the_table_has_a_row_for_each_value():
    parts = (
        Difference("tilt of link 'a'", "link", "a", 1.0, 5.25, 1.0, "°", 2),
        Difference("it comes to rest", "link", "[b]", 1.5, math.nan, 1.0, "s", 3),
    )
    said = format_comparison_text(EngineComparison(("A 1", "B 2"), parts, ("mass: \x1b[2J",)))
    rows = [line.split() for line in said.splitlines()]
    assert ["trial", "value", "A", "1", "B", "2", "allowed"] in rows
    assert ["2", "tilt", "of", "link", "'a'", "1", "°", "5.25", "°", "1", "°"] in rows
    assert "not within the duration" in said
    assert said.splitlines()[1] == "error: the engines differ in 2 values"
    assert "possible cause: mass: " in said
    assert "\x1b" not in said


def test_the_command_writes_differences_as_json(urdftool, write):
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
