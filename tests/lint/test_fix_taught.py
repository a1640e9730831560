"""What newcomers get wrong, in the robots they build: found at its line, and fixed where it can be.

Each line of ``MISTAKES`` is a robot, the file and line of the mistake, the rule that finds it, and
what stands there once it is fixed; None where only its author knows.
"""

import shutil
from pathlib import Path

import pytest

from tests.conftest import FIXTURES
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

BASE = "my_robot/urdf/robot_base_as_taught.urdf.xacro"
LASER = "laser_bot/urdf/laser_bot_as_taught.urdf.xacro"
ARM = "ros2_arm/urdf/robot2.urdf.xacro"
MIRA = "mira_description/urdf/mira.urdf"
SIMPLE = "mira_description/urdf/mira_simple.urdf"

MISTAKES = [
    (BASE, BASE, 2, "nonstandard-xmlns", 'xmlns:xacro="http://www.ros.org/wiki/xacro"'),
    (BASE, BASE, 4, "include-not-found", "$(find my_robot)/urdf/robot_essentials.xacro"),
    (BASE, BASE, 9, "unexpanded-expression", 'reference="${prefix}_wheel_link"'),
    (BASE, BASE, 65, "unknown-extension", "<alwaysOn>true</alwaysOn>"),
    (ARM, "ros2_arm/urdf/macros2.urdf.xacro", 18, "unexpanded-expression", 'ixx="${ixx}"'),
    (ARM, ARM, 11, "inertia-exceeds-geometry", 'ixx="106.666667"'),
    (ARM, ARM, 7, "root-link-has-inertia", '<link name="base_link_root"/>'),
    (ARM, ARM, 3, "missing-control-plugin", "gz::sim::systems::JointStatePublisher"),
    (LASER, LASER, 11, "unknown-element", None),
    (LASER, LASER, 40, "unknown-element", None),
    (LASER, LASER, 68, "empty-geometry", '<cylinder radius="0.1" length="0.04"/>'),
    (LASER, LASER, 79, "unknown-element", '<dynamics damping="0.01" friction="0.01"/>'),
    (LASER, LASER, 126, "empty-geometry", '<cylinder radius="0.05" length="0.1"/>'),
    (MIRA, MIRA, 265, "unprefixed-hardware-interface", "hardware_interface/EffortJointInterface"),
    (SIMPLE, SIMPLE, 12, "missing-collision", "<collision>"),
    (SIMPLE, SIMPLE, 12, "missing-inertial", "<inertial>"),
]

SELECT = ",".join(sorted({rule for *_, rule, _ in MISTAKES}))


@pytest.fixture
def robots(tmp_path, monkeypatch):
    shutil.copytree(FIXTURES / "robots", tmp_path / "robots")
    monkeypatch.chdir(tmp_path / "robots")


def _findings(robot):
    settings = Settings(extend_select=("nonstandard-xmlns", "pedantic"))  # infos are off by default
    report = check_file(robot, Options(settings))
    return {(f.location.path, f.location.line, f.code): f.name for f in report.findings}


@pytest.mark.parametrize("robot", sorted({robot for robot, *_ in MISTAKES}))
def test_what_is_taught_wrong_is_found_and_fixed(robot, robots, urdftool):
    wanted = [mistake for mistake in MISTAKES if mistake[0] == robot]
    stopped = {rule for *_, rule, _ in wanted} & {"include-not-found"}
    words = ("lint", robot, "--select", SELECT, "--fix", "--unsafe-fixes", "--no-cache")
    before = _findings(robot)
    for _, path, line, rule, _ in wanted:
        if not stopped or rule in (*stopped, "nonstandard-xmlns"):
            assert (path, line, rule) in before
    if stopped:
        urdftool(*words[:2], "--select", "include-not-found", *words[4:])
        between = _findings(robot)
        assert {(p, n, r) for _, p, n, r, _ in wanted if r not in stopped} <= between.keys()
        before |= between
    urdftool(*words)
    after = {(path, rule, name) for (path, _, rule), name in _findings(robot).items()}
    for _, path, line, rule, text in wanted:
        if text is not None:
            assert text in Path(path).read_text("utf-8")
            if rule != "unknown-element":  # of which one robot has others
                assert (path, rule, before[path, line, rule]) not in after
    again = urdftool(*words)
    assert "Nothing to fix." in again.err
