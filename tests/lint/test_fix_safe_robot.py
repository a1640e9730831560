"""A safe fix changes no part, sensor, plugin or controller of a robot but those that it states."""

import shutil
from pathlib import Path

import pytest

import urdftool
from tests.lint.test_fix_safe import BAD, RULES
from urdftool.errors import UrdftoolError
from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

STATED = {
    # rule: row of ``verify``, and what differs; what readers did not read, or read wrongly, before
    "mesh-case-mismatch": {("visuals", "visual")},
    "missing-gazebo-material": {("looks", "ambient"), ("simulator data", "visual added"),
                                ("simulator data", "visual/material added"),
                                ("simulator data", "visual/material/ambient"),
                                ("simulator data", "visual/material/diffuse")},
    "missing-gz-frame-id": {("sensors", "frame")},
    "ogre-material-script": {("simulator data", "material"), ("looks", "material script"),
                             ("simulator data", "gazebo[chassis] added")},
    "plugin-class-mismatch": {("simulator data", "plugin")},
    "ros2-control-nested": {("simulator data", "existence")},
    "unknown-element": {("colors", "color of visual")},
    "unprefixed-hardware-interface": {("simulator data", "joint[swing]/hardwareInterface")},
    "wrong-arity": {("colors", "color of visual")},
    "wrong-case-keyword": {("tree", "type")},
}  # fmt: skip


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
    assert {(one.row, one.what) for one in found} <= STATED.get(rule, set())
