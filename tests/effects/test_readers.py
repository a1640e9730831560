"""What the readers that are installed do now is what the table expects of them.

A reader of another version than the recorded one is skipped: the sentences are about that one.
"""

import pytest

from . import table
from .readers import READERS, Robot, installed, read

pytestmark = pytest.mark.slow

THERE = {
    name: version
    for name, version in installed().items()
    if f"{READERS[name].title} {version}" == table.versions().get(name)
}
RUNS = [run for row in table.rows() for run in row.runs if run.reader in READERS]


@pytest.mark.parametrize("run", RUNS, ids=lambda run: f"{run.rule}-{run.reader}-{run.robot[:40]}")
def test_a_reader_does_what_the_table_says(run):
    if run.reader not in THERE:
        pytest.skip(f"{table.versions()[run.reader]} is not installed")
    record = {run.robot: {run.reader: read(run.reader, table.robot_of(run.rule, run.robot))}}
    if run.same_as:
        beside = read(run.reader, table.robot_of(run.rule, run.same_as))
        record.setdefault(run.same_as, {})[run.reader] = beside
    assert run.wrong(record) == []


def test_an_edit_that_is_not_in_the_robot_is_an_error(tmp_path):
    robot = Robot(table.TABLE / "robots" / "pendulum.urdf", (("no such text", ""),))
    with pytest.raises(ValueError, match="0 times 'no such text'"):
        robot.written_to(tmp_path / "robot")
