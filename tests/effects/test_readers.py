"""What the readers that are installed do now is what the table expects of them.

A reader of another version than the recorded one is not run: the sentences are about that one.
"""

import pytest

from . import table
from .readers import READERS, Robot, installed, read

# The programs of the machine are to be seen; where there is no g++, readers in Python are run.
PROGRAMS = ("g++", "sh")
pytestmark = [pytest.mark.slow, pytest.mark.program(*PROGRAMS)]

RECORDED = table.versions()
THERE = {
    name
    for name, version in installed().items()
    if f"{READERS[name].title} {version}" == RECORDED.get(name)
}
RUNS = [run for row in table.rows() for run in row.runs if run.reader in THERE]


@pytest.mark.parametrize("reader", READERS)
def test_a_reader_is_run(reader):
    if reader not in THERE:
        pytest.skip(f"{RECORDED[reader]} is not installed")
    facts = read(reader, table.robot_of("", "pendulum"))
    assert facts["outcome"] == "loads"


@pytest.mark.parametrize("run", RUNS, ids=lambda run: f"{run.rule}-{run.reader}-{run.robot[:40]}")
def test_a_reader_does_what_the_table_says(run):
    record = {run.robot: {run.reader: read(run.reader, table.robot_of(run.rule, run.robot))}}
    if run.same_as:
        beside = read(run.reader, table.robot_of(run.rule, run.same_as))
        record.setdefault(run.same_as, {})[run.reader] = beside
    assert run.wrong(record) == []


def test_an_edit_that_is_not_in_the_robot_is_an_error(tmp_path):
    robot = Robot(table.TABLE / "robots" / "pendulum.urdf", (("no such text", ""),))
    with pytest.raises(ValueError, match="0 times 'no such text'"):
        robot.written_to(tmp_path / "robot")
