"""Damaged robots: lint names what was damaged, and is sober about robots that are sound.

The full run takes minutes and is slow; its table is printed by ``python -m measure.damage``.
"""

import tempfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from measure.damage.kinds import KINDS
from measure.damage.robots import SHORT, samples
from measure.damage.run import findings, table

SAMPLES = samples()
FEW = [sample for sample in SAMPLES if sample.path.stem in SHORT]

IN_PRINCIPLE = {
    "axis_flipped": "of two joints alone in their kind, with symmetric limits, either may be right"
}

needs_robots = pytest.mark.skipif(
    not SAMPLES, reason="needs pybullet_data or example-robot-data, which are on PyPI"
)


def test_there_are_kinds_enough():
    assert len(KINDS) >= 25


@needs_robots
def test_most_damages_to_few_robots_are_named():
    rows = table(FEW, kinds=list(KINDS)[::3])
    tried, found = (sum(row[i] for row in rows.values()) for i in (0, 1))
    assert tried >= 10
    assert found >= 0.9 * tried, {kind: row[2] for kind, row in rows.items() if row[2]}


@pytest.mark.slow
@pytest.mark.skipif(len(SAMPLES) < 20, reason="needs pybullet_data and example-robot-data")
def test_nearly_all_damages_are_named():
    rows = table(SAMPLES, seeds=2)
    tried, found = (sum(row[i] for row in rows.values()) for i in (0, 1))
    missed = {kind: row[2] for kind, row in rows.items() if row[2]}
    assert found >= 0.95 * tried, missed
    for kind, (tried, found, _) in rows.items():
        assert found >= 0.75 * tried, (kind, missed[kind], IN_PRINCIPLE.get(kind))


CONFIRMED_BY = {
    "inertia-triangle-inequality": "mujoco",
    "inertia-not-positive-definite": "mujoco",
    "zero-mass": "mujoco",
    "transmission-on-immovable-joint": "ros_control finds no joint that moves",
    "mimic-dof-mismatch": "ros2_control and MoveIt refuse a fixed joint that mimics",
    "misplaced-extension": "sdformat drops it",
    "lumped-joint-loses-content": "sdformat drops it",
    "duplicate-sensor-name": "sdformat refuses siblings of one name",
    "link-joint-name-clash": "sdformat refuses siblings of one name",
}
"""The errors there are in robots of these collections, and the consumer that confirms each."""


@needs_robots
@pytest.mark.parametrize(
    "sample",
    [s if s in FEW else pytest.param(s, marks=pytest.mark.slow) for s in SAMPLES],
    ids=lambda sample: sample.name,
)
def test_undamaged_robot_has_no_error_that_no_consumer_confirms(sample):
    with tempfile.TemporaryDirectory() as folder:
        found = findings(sample.text, sample, Path(folder))
    errors = [finding for finding in found if finding.severity.label == "error"]
    assert {finding.code for finding in errors} <= set(CONFIRMED_BY)
    root = ElementTree.fromstring(sample.text)
    inertials = {link.get("name"): link.find("inertial") for link in root.iter("link")}
    for finding in errors:
        if CONFIRMED_BY[finding.code] == "mujoco":
            assert mujoco_refuses(inertials[finding.name]), str(finding)


def mujoco_refuses(inertial):
    """Whether MuJoCo refuses a moving link with this inertial."""
    mujoco = pytest.importorskip("mujoco")
    robot = ElementTree.fromstring(ONE_MOVING_LINK)
    robot.find("link[@name='tip']").append(inertial)
    try:
        mujoco.MjModel.from_xml_string(ElementTree.tostring(robot, encoding="unicode"))
    except ValueError:
        return True
    return False


ONE_MOVING_LINK = """
<robot name="judged">
  <link name="base"/>
  <link name="tip"/>
  <joint name="turn" type="continuous">
    <parent link="base"/>
    <child link="tip"/>
    <axis xyz="0 0 1"/>
  </joint>
</robot>
"""
