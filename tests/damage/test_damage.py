"""Damaged robots: lint names what was damaged, and is sober about robots that are sound.

The full run takes minutes and is slow; its table is printed by ``python -m tests.damage``.
"""

import tempfile
from pathlib import Path

import pytest

from .kinds import KINDS
from .robots import SHORT, samples
from .run import findings, table

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
    rows = table(FEW)
    tried, found = (sum(row[i] for row in rows.values()) for i in (0, 1))
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


@needs_robots
@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: sample.name)
def test_undamaged_robot_has_no_error(sample):
    if sample.path.stem in CONFIRMED:
        pytest.skip(CONFIRMED[sample.path.stem])
    with tempfile.TemporaryDirectory() as folder:
        found = findings(sample.text, sample, Path(folder))
    assert [str(finding) for finding in found if finding.severity.label == "error"] == []


CONFIRMED: dict[str, str] = {}
"""Robots with an error that a consumer confirms, and which."""
