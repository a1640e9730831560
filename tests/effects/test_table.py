"""Every sentence of a rule about a reader has a row, and the rows hold of what was recorded."""

import json
import re

import pytest

from urdftool.lint.effect_kinds import FLAGGED, INTENDED, REJECTS, WRITTEN
from urdftool.report.rule_pages import get_effect_source
from urdftool.rules import get_all_rules

from . import table
from .__main__ import as_text
from .expected import differences, unlike, value_at
from .readers import READERS

ROWS = {(row.rule, row.key): row for row in table.rows()}
RUNS = [run for row in table.rows() for run in row.runs]

SOURCE = r"[\w.-]+/[\w.-]+ ([\w./+-]+\.[a-z]+|(issues|pull)/\d+)"
"""A file of a repository, or an issue or a pull request of it."""

# Which readers a word in the key of an effect stands for; gz and Gazebo Classic read URDF with
# sdformat. A word that is not here names a reader that is not run.
RUN = {
    "urdfdom": {"urdfdom", "urdfdom 4", "urdfdom 6", "check_urdf"},
    "check_urdf": {"check_urdf"},
    "gz": {"sdformat"},
    "gazebo-classic": {"sdformat"},
    "mujoco": {"mujoco", "mujoco 3.3"},
    "pybullet": {"pybullet"},
    "pinocchio": {"pinocchio"},
    "drake": {"drake"},
    "newton": {"newton"},
    "KDL": {"KDL"},
    "xacro": {"xacro", "xacro --inorder"},
}
GAZEBO = ("gz", "gazebo-classic")
NOT_RUN = {
    *("rviz", "moveit", "robot_state_publisher", "tf2", "image_geometry", "ros2_control"),
    *("controller_manager", "gz_ros2_control", "gazebo_ros_control", "gazebo_ros"),
    *("joint_trajectory_controller", "ros2 run … -p robot_description:=…", "colcon"),
    *("isaac", "ros2 launch"),
}


def test_every_effect_of_every_rule_has_a_row_and_no_row_is_left_over():
    effects = {
        (rule.name, key): says for rule in get_all_rules() for key, says in rule.effects.items()
    }
    assert {pair: row.says for pair, row in ROWS.items()} == effects


@pytest.mark.parametrize("row", table.rows(), ids=lambda row: f"{row.rule}: {row.key}")
def test_a_row_runs_each_reader_it_names_or_says_where_it_was_read(row):
    assert row.runs or row.sources
    readers = {run.reader for run in row.runs}
    for word in row.key.partition(" (")[0].split(", "):
        assert word in RUN or word in NOT_RUN, f"'{word}' is not a reader: name each reader"
        if word in NOT_RUN:
            assert row.sources, f"{word} is not run: where was it read?"
        elif not (word in GAZEBO and row.sources):
            assert readers & RUN[word], f"{word} is not run"
    for source in row.sources:
        assert re.fullmatch(SOURCE, source), source


@pytest.mark.parametrize("row", table.rows(), ids=lambda row: f"{row.rule}: {row.key}")
def test_what_was_recorded_is_as_the_row_expects(row):
    record = table.record_of(row.rule)
    wrong = [f"{run.reader}: {run.robot}: {line}" for run in row.runs for line in run.wrong(record)]
    assert wrong == []


def test_a_run_expects_something():
    assert [run for run in RUNS if not run.expected] == []


def test_records_are_those_of_the_table():
    pairs = table.pairs()
    assert {path.stem for path in table.RUNS.glob("*.json")} == set(pairs)
    for rule, robots in pairs.items():
        recorded = {robot: set(readers) for robot, readers in table.record_of(rule).items()}
        assert recorded == robots, rule


def test_records_name_no_machine_and_are_written_as_the_program_writes_them():
    for path in table.RUNS.glob("*.json"):
        text = path.read_text("utf-8")
        found = re.findall(r"/tmp/[^\"]*|/root/[^\"]*|/usr/[^\"]*|/work/[^\"]*|site-packages", text)
        assert found == [], path.name
        assert text == as_text(json.loads(text)), path.name


def test_versions_are_recorded():
    titles = table.versions()
    assert {run.reader for run in RUNS} <= set(titles)
    assert set(titles) <= set(READERS)


def test_lint_knows_the_kinds_of_effects():
    kinds = table.kinds()
    assert json.loads(table.KINDS.read_text("utf-8")) == kinds
    assert kinds["unknown-parent-link"]
    named = {row.kind for row in table.rows()}
    assert named == {"", INTENDED, WRITTEN, FLAGGED}


def test_what_accepts_a_robot_says_so_in_its_kind():
    """The words of an effect and its kind agree."""
    accepts = re.compile(r"(accepts?|reads?|loads?) (it|the same robot)$")
    for row in table.rows():
        if accepts.match(row.says):
            assert row.kind == INTENDED, row
        if re.match(r"(takes? it as written|load the joint without limits)$", row.says):
            assert row.kind == WRITTEN or row.key in kinds_of(row, REJECTS), row


def kinds_of(row, kind):
    return [key for key, found in table.kinds().get(row.rule, {}).items() if kind in found]


def test_rule_pages_quote_the_table():
    packaged = json.loads(table.PACKAGED.read_text("utf-8"))
    assert packaged == table.packaged(), "python -m tests.effects --pages"
    assert get_effect_source("zero-axis", "pybullet").startswith("run: PyBullet ")
    assert get_effect_source("mimic-chain", "moveit").startswith("source: moveit/moveit2 ")
    assert get_effect_source("zero-axis", "no such reader") == ""


FACTS = {
    "outcome": "rejects",
    "messages": ["first", "axis too small"],
    "joints": {"a.b": {"upper": 1.5}},
    "shapes": [{"size": [1, 2]}],
}


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("joints.a.b.upper", 1.5),
        ("shapes.#", 1),
        ("shapes.0.size.1", 2),
        ("shapes.1.size", "absent"),
        ("joints.c", "absent"),
    ],
)
def test_a_path_leads_to_a_value(path, value):
    assert value_at(FACTS, path) == value


@pytest.mark.parametrize(
    "expected",
    [
        {"outcome": "loads"},
        {"messages": "~too large"},
        {"messages": "!~axis"},
        {"joints.a.b.upper": 1.50001},
        {"joints.a.b.upper": "> 2"},
        {"joints.a.b.upper": "absent"},
        {"shapes.0.size": [1, 3]},
        {"shapes.0.size": [1]},
    ],
)
def test_what_is_not_as_expected_is_found(expected):
    assert len(list(differences(FACTS, expected))) == 1


def test_what_is_as_expected_is_not_found():
    expected = {"messages": "~axis too", "joints.a.b.upper": "< 2", "shapes.0.size": [1, 2.0000001]}
    assert list(differences(FACTS, expected)) == []


def test_two_robots_differ_in_their_facts_and_not_in_their_messages():
    other = {**FACTS, "messages": [], "shapes": [{"size": [1, 4]}]}
    assert [line.partition(":")[0] for line in unlike(FACTS, other)] == ["shapes"]
