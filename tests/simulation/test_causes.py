"""Causes are those of the engine that ran; what is missing comes before what follows from it."""

from importlib.util import find_spec

import pytest

from tests.conftest import FIXTURES
from tests.simulation.robots import body, inertial, kinds
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

ENGINES = [
    pytest.param(*pair, marks=pytest.mark.skipif(not find_spec(pair[1]), reason=pair[1]))
    for pair in (("pybullet", "pybullet", "PyBullet"), ("mujoco", "mujoco", "MuJoCo"))
]
BOX = '<collision><geometry><box size="0.3 0.3 0.1"/></geometry></collision>'
# nothing balances the arm but the mass that its root does not have
MASSLESS = (
    f'<robot name="r"><link name="base">{BOX}</link><link name="arm">'
    f'{inertial(3, 0.01, 0.02, 0.03, "0.5 0 0")}<collision><origin xyz="0.5 0 0"/>'
    '<geometry><sphere radius="0.05"/></geometry></collision></link>'
    '<joint name="j" type="revolute"><origin xyz="0 0 0.3"/><parent link="base"/>'
    '<child link="arm"/><axis xyz="0 1 0"/>'
    '<limit lower="-1" upper="1" effort="99" velocity="1"/></joint></robot>'
)


def _judged(path, engine, **settings):
    robot = load(path)
    (run,) = simulate(robot, Settings(**settings), engine=engine)
    return judge(robot, run)


@pytest.mark.parametrize(("engine", "library", "name"), ENGINES)
def test_a_cause_names_the_engine_that_ran(write, engine, library, name):
    text = body('<box size="0.4 0.3 0.2"/>', 2, (0.01, 0.01, 0.04))
    (fault,) = [f for f in _judged(write("r.urdf", text), engine).faults if f.is_warning]
    assert fault.code == "impossible-inertia"
    others = {"PyBullet", "MuJoCo"} - {name}
    assert name in fault.cause
    assert not any(other in fault.cause for other in others)
    assert "simulated principal moments of" in fault.cause


@pytest.mark.parametrize(("engine", "library", "name"), ENGINES)
def test_a_massless_root_comes_before_what_follows_from_it(write, engine, library, name):
    verdict = _judged(write("r.urdf", MASSLESS), engine)
    first, *others = [fault for fault in verdict.faults if fault.fails]
    assert (first.code, first.name) == ("no-mass", "base")
    assert name in first.cause
    for fault in others:
        assert "root link 'base' has no mass" in fault.cause
    if engine == "mujoco":
        assert "ground-penetration" in kinds(verdict)


def test_one_mass_several_times_too_large_is_seen():
    verdict = _judged(FIXTURES / "rules" / "mass-outlier" / "bad.urdf", "pybullet")
    (fault,) = [fault for fault in verdict.faults if fault.code == "mass-outlier"]
    assert fault.is_warning
    assert fault.rule == "mass-outlier"
    assert fault.name in fault.message
