"""A safe fix changes no part, sensor, plugin or controller of a robot but those that it states."""

import random
import shutil
from pathlib import Path

import pytest

import urdftool
from measure.damage.safe_fixes import KINDS, STATED, list_robots, remove_names, try_robot
from tests.lint.test_fix_safe import BAD, RULES
from urdftool.errors import UrdftoolError
from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings


@pytest.mark.parametrize("bad", BAD, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_safe_fix_changes_what_it_states(bad, tmp_path):
    rule = bad.parent.name
    shutil.copytree(RULES / rule, tmp_path / rule, ignore=shutil.ignore_patterns("fixed*"))
    path = tmp_path / rule / bad.name
    options = Options(Settings(select=(rule,)), fixes=True)
    done = fix_description(check_file(path, options), options, meshes=True)
    try:
        before = urdftool.load(path)
        for changed, data in done.after.items():
            Path(changed).write_bytes(data)
        found = urdftool.verify(before, urdftool.load(path)).list_disagreements()
    except UrdftoolError:
        return  # no reader could read the robot before, so that nothing is comparable
    assert {(one.row, remove_names(one.what)) for one in found} <= STATED.get(rule, set())


@pytest.mark.slow
@pytest.mark.parametrize("name", ["kuka_iiwa/model.urdf", "a1/a1.urdf", "r2d2.urdf"])
def test_safe_fixes_of_real_robots_change_what_they_state(name):
    pytest.importorskip("pybullet_data")
    found = [path for robot, path in list_robots().items() if robot == f"pybullet_data/{name}"]
    compared = list(try_robot(found[0], sorted(KINDS), random.Random(1)))
    assert len(compared) >= 8
    assert [one.unstated for one in compared if one.unstated] == []
