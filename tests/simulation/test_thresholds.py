"""Thresholds of verdicts: each has a unit and a source, and a configuration file changes them."""

import ast
import inspect
import json
import math
import re
from dataclasses import fields

import numpy as np
import pytest

from tests.conftest import ROOT
from tests.simulation.robots import body
from urdftool.api.simulate import run_trials as simulate
from urdftool.errors import ConfigError
from urdftool.model.load import load
from urdftool.simulation.checks import thresholds as module
from urdftool.simulation.checks.thresholds import Thresholds, read_thresholds
from urdftool.simulation.engines.driver import Stillness
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

SUNK = body('<box size="0.4 0.3 0.2"/>', 2, (1, 1, 1))  # a tensor far larger than the box's
UNITS = ("s", "1", "m", "m/s", "rad", "rad/s", "size", "size/s", "kg/m³")
SLIDER = """<robot name="r"><link name="world"/>
 <joint name="{kind}" type="{kind}"><parent link="world"/><child link="a"/><origin xyz="0 0 9"/>
  <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="9" velocity="9"/></joint>
 <link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0"
  izz="1"/></inertial><collision><geometry><sphere radius="9"/></geometry></collision></link>
</robot>"""


def _docs():
    """The text below each field, by its name."""
    (node,) = (
        part for part in ast.parse(inspect.getsource(module)).body if isinstance(part, ast.ClassDef)
    )
    found = {}
    for field, text in zip(node.body[1::2], node.body[2::2], strict=True):
        found[field.target.id] = text.value.value
    return found


def test_each_has_a_unit_and_a_source():
    docs = _docs()
    assert list(docs) == [field.name for field in fields(Thresholds)]
    for name, text in docs.items():
        unit = re.search(r"\[([^]]+)\]\.\s+Source:\s+\S", text)
        assert unit, name
        assert unit[1] in UNITS, name


def test_the_page_of_configuration_lists_them():
    page = (ROOT / "docs" / "configuration.md").read_text("utf-8")
    rows = dict(re.findall(r"^\| `([a-z-]+)` \| ([^|]+) \|", page, flags=re.M))
    for field in fields(Thresholds):
        shown = rows[field.name.replace("_", "-")]
        assert float(shown.replace(",", "")) == pytest.approx(field.default, rel=1e-3), field.name


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (
            {"joint-drift-turns": 1},
            "simulate has no threshold 'joint-drift-turns'; did you mean 'joint-drift-turn'?",
        ),
        ({"xyzzy": 1}, "simulate has no threshold 'xyzzy'; docs/configuration.md lists them"),
        ({"joint-drift-turn": "1"}, "simulate.joint-drift-turn must be a number"),
        ({"joint-drift-turn": True}, "simulate.joint-drift-turn must be a number"),
        ({"joint-drift-turn": -1}, "simulate.joint-drift-turn must be above zero and finite"),
        (
            {"joint-drift-turn": float("nan")},
            "simulate.joint-drift-turn must be above zero and finite",
        ),
        ({"arm-joints": 2.5}, "simulate.arm-joints must be a whole number"),
    ],
)
def test_what_is_no_threshold_is_one_message(table, said):
    with pytest.raises(ConfigError) as raised:
        read_thresholds(table, "urdftool.toml")
    assert raised.value.message == said
    assert raised.value.path == "urdftool.toml"


def test_a_configuration_file_changes_a_verdict(urdftool, write, tmp_path):
    path = write("r.urdf", SUNK)
    (tmp_path / "urdftool.toml").write_text("[simulate]\n")
    words = ("simulate", path, "--duration", "0.1", "--format", "json")
    config = ("--config", tmp_path / "other.toml")

    def kinds(*more):
        said = json.loads(urdftool(*more, *words).out)
        return {fault["kind"] for trial in said["trials"] for fault in trial["faults"]}

    assert "inertia-too-large" in kinds()
    (tmp_path / "other.toml").write_text("[simulate]\ngyration-reach = 100\naxis-spread = 100\n"
                                         "placeholder-ratio = 1e6\n")  # fmt: skip
    assert "inertia-too-large" not in kinds(*config)
    (tmp_path / "other.toml").write_text("[simulate]\ngyration-reech = 100\n")
    refused = urdftool(*config, *words)
    assert refused.code == 2
    assert "did you mean 'gyration-reach'?" in refused.err
    assert urdftool(*config, *words, "--fleet").code == 2


def test_the_engine_waits_as_long_as_configured(write):
    pytest.importorskip("pybullet")
    robot = load(write("r.urdf", body('<box size="0.4 0.3 0.2"/>', 2, (0.02, 0.03, 0.04))))
    (run,) = simulate(robot, Settings(), thresholds=Thresholds(settle_min_time=2.5))
    assert 2.5 < run.recording.times[-1] < 2.6
    assert judge(robot, run).stands


@pytest.mark.parametrize(
    ("kind", "bounds", "rests"),
    [
        ("prismatic", {"settle_slide": 0.002}, False),
        ("prismatic", {"settle_turn": 0.002}, True),
        ("revolute", {"settle_turn": 0.002}, False),
        ("revolute", {"settle_slide": 0.002}, True),
    ],
)
def test_sliding_and_turning_joints_have_a_bound_each(write, kind, bounds, rests):
    bodies = prepare(load(write("r.urdf", SLIDER.format(kind=kind))), Settings())
    watch = Stillness(bodies, 0.1, Thresholds(settle_window=0.2, **bounds))
    still = np.zeros((2, 7))
    still[:, 6] = 1.0
    found = [watch.add(0.1 * n, still, np.array([0.004 * (n % 2)])) for n in range(5)]
    assert (found[-1] is not None) is rests


def test_the_size_of_a_robot_without_collisions_is_that_of_its_origins(write):
    text = SLIDER.format(kind="revolute")
    start, end = text.index("<collision>"), text.rindex("</collision>") + len("</collision>")
    bare = text[:start] + text[end:]
    assert "<collision>" not in bare
    bodies = prepare(load(write("r.urdf", bare)), Settings(fixed_base=True))
    assert bodies.size == pytest.approx(9.0)


@pytest.mark.parametrize(
    ("move", "rests"),
    [
        (lambda t: 0.014 * t, False),  # a hinge that gravity turns against a large damping
        (lambda t: 0.001 * math.exp(3 * t), False),  # the first second of a fall
        (lambda t: 0.05 * math.exp(-6 * t), True),  # a joint that comes to rest
        (lambda t: 0.002 * math.sin(40 * t), True),  # a joint that trembles
        (lambda t: 0.0002 * t, True),  # a contact that creeps
    ],
)
def test_a_motion_that_goes_on_is_no_rest(write, move, rests):
    bodies = prepare(load(write("r.urdf", SLIDER.format(kind="revolute"))), Settings())
    watch = Stillness(bodies, 1 / 30, Thresholds())
    still = np.zeros((2, 7))
    still[:, 6] = 1.0
    times = [n / 30 for n in range(46)]
    found = [watch.add(time, still, np.array([move(time)])) for time in times]
    assert any(one is not None for one in found) is rests
