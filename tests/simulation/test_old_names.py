"""Old names of verdict kinds and thresholds."""

import json
import re
from dataclasses import fields
from pathlib import Path

import pytest

from urdftool.diagnostic import Severity
from urdftool.errors import ConfigError
from urdftool.simulation.checks.thresholds import Thresholds, read_thresholds
from urdftool.simulation.fault import Fault
from urdftool.simulation.old_names import OLD_KINDS, RENAMED_THRESHOLDS, find_old_thresholds

PACKAGE = Path(__file__).parents[2] / "urdftool" / "simulation"

BOX = """<robot name="box"><link name="base">
  <inertial><mass value="1"/><inertia ixx="0.002" iyy="0.002" izz="0.002" ixy="0" ixz="0" iyz="0"/>
  </inertial>
  <visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
</link></robot>"""


def test_every_renamed_kind_is_reported_by_its_present_name_only():
    text = "".join(
        path.read_text("utf-8") for path in PACKAGE.rglob("*.py") if path.name != "old_names.py"
    )
    words = set(re.findall(r'"([a-z-]+)"', text))
    assert set(OLD_KINDS) <= words
    assert not set(OLD_KINDS.values()) & words


def test_every_renamed_threshold_exists():
    keys = {field.name.replace("_", "-") for field in fields(Thresholds)}
    assert set(RENAMED_THRESHOLDS.values()) <= keys
    assert not set(RENAMED_THRESHOLDS) & keys


def test_kind_is_the_old_name_of_the_code():
    fault = Fault("diverged", Severity.ERROR, "simulation diverged")
    with pytest.warns(DeprecationWarning, match="'kind' is now 'code'"):
        assert fault.kind == "blew-up"
    with pytest.warns(DeprecationWarning, match="is now"):
        assert Fault("slid", Severity.ERROR, "the robot slid").kind == "slid"


def test_an_old_threshold_is_read_and_reported():
    table = {"sag-turn": 0.5, "arm-joints": 3}
    assert read_thresholds(table).joint_drift_turn == 0.5
    (message,) = find_old_thresholds(table)
    assert message.startswith("threshold 'simulate.sag-turn' is now 'simulate.joint-drift-turn';")
    with pytest.raises(ConfigError, match="sag-turn must be a number"):
        read_thresholds({"sag-turn": "wide"})


@pytest.mark.parametrize("words", [("box.urdf",), ("--fleet", ".")])
def test_the_command_warns_once_and_prints_both_kinds(urdftool, write, words):
    write("urdftool.toml", "[simulate]\nsag-turn = 0.5\n")
    write("box.urdf", BOX)
    done = urdftool("simulate", "--duration", "0.5", "--format", "json", *words)
    assert done.code == 1
    assert done.err.count("is now 'simulate.joint-drift-turn'") == 1
    found = json.loads(done.out)
    faults = (found["robots"] if "robots" in found else found["trials"])[0]["faults"]
    assert ("no-collision-geometry", "nothing-touches") in {
        (fault["kind"], fault["old_kind"]) for fault in faults
    }
    assert all(fault["old_kind"] == OLD_KINDS.get(fault["kind"]) for fault in faults)
