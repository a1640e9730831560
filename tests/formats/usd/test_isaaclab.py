"""The configuration for Isaac Lab, run against stand-ins of its classes."""

import sys
from types import ModuleType, SimpleNamespace

import pytest

from tests.formats.usd.stages import BOX, joint, link, robot

pytestmark = pytest.mark.library("pxr")

LEG = '<axis xyz="0 1 0"/><limit lower="{}" upper="2" effort="20" velocity="3"/>'
ROBOT = robot(
    link("base", 5, BOX),
    *(joint(f"{side}_hip_joint", "base", f"{side}_leg", "revolute", LEG.format(0.5))
      for side in ("FL", "FR")),
    link("FL_leg"), link("FR_leg"),
    joint("head.1", "base", "head", "revolute",
          '<limit lower="-1" upper="1" effort="2" velocity="1"/>'
          '<mimic joint="FL_hip_joint" multiplier="0.5" offset="0.1"/>'),
    link("head"),
)  # fmt: skip


@pytest.fixture
def load(monkeypatch):
    """Run a configuration; gives its variables."""

    def make(**values):
        return SimpleNamespace(**values)

    def articulation(**values):
        return make(**values)

    articulation.InitialStateCfg = make
    modules = {
        "isaaclab": {},
        "isaaclab.sim": {"UsdFileCfg": make, "ArticulationRootPropertiesCfg": make},
        "isaaclab.actuators": {"ImplicitActuatorCfg": make},
        "isaaclab.assets": {"ArticulationCfg": articulation},
    }
    for name, members in modules.items():
        module = ModuleType(name)
        module.__dict__.update(members)
        monkeypatch.setitem(sys.modules, name, module)
        if "." in name:
            setattr(sys.modules["isaaclab"], name.partition(".")[2], module)

    def run(path):
        values = {"__file__": str(path)}
        exec(compile(path.read_text(), str(path), "exec"), values)
        return values

    return run


@pytest.mark.parametrize("version", ["2", "3"])
def test_a_configuration_names_the_joints_of_the_stage(urdftool, write, load, version, tmp_path):
    from pxr import Usd

    path = write("dog.urdf", ROBOT)
    file = tmp_path / "cfg" / "dog.py"
    file.parent.mkdir()
    result = urdftool("export", "usd", path, "-o", "dog.usdc", "--base", "free",
                      "--isaaclab", file, "--isaaclab-version", version)  # fmt: skip
    assert result.code == 0
    config = load(file)["R_CFG"]
    stage = Usd.Stage.Open(config.spawn.usd_path)
    joints = {prim.GetName() for prim in stage.GetPrimAtPath("/r/joints").GetChildren()}
    named = [n for group in config.actuators.values() for n in group.joint_names_expr]
    assert sorted(named) == ["FL_hip_joint", "FR_hip_joint"]
    assert set(config.init_state.joint_pos) == joints == {*named, "head_1"}
    assert list(config.actuators) == ["hip"]
    effort = "joint_effort_limit" if version == "3" else "effort_limit_sim"
    assert getattr(config.actuators["hip"], effort) == 20
    assert config.init_state.joint_pos["FL_hip_joint"] == 0.5
    assert config.init_state.joint_pos["head_1"] == pytest.approx(0.35)
    assert config.init_state.pos == pytest.approx((0, 0, 0.15))
    assert config.init_state.rot == ((0, 0, 0, 1) if version == "3" else (1, 0, 0, 0))
    assert "zero is outside of the limits of 'FL_hip_joint'" in result.err


def test_a_file_of_the_user_is_kept(urdftool, write):
    path = write("dog.urdf", ROBOT)
    write("dog.py", "mine = 1\n")
    assert urdftool("export", "usd", path, "-o", "dog.usdc", "--isaaclab", "dog.py").code == 2
    assert urdftool("export", "usd", path, "--isaaclab", "dog.py").code == 2


def test_limits_of_an_actuator_file_are_those_of_the_configuration(urdftool, write, load, tmp_path):
    path = write("dog.urdf", ROBOT)
    gains = write(
        "gains.toml", '[joints."*_hip_joint"]\nkp = 80\narmature = 0.02\nforce-range = 15\n'
    )
    file = tmp_path / "dog.py"
    result = urdftool("export", "usd", path, "-o", "dog.usdc", "--base", "free",
                      "--actuator-config", gains, "--isaaclab", file)  # fmt: skip
    assert result.code == 0
    group = load(file)["R_CFG"].actuators["hip"]
    assert (group.joint_effort_limit, group.armature) == (15, 0.02)
    assert "stiffness and damping" not in result.err
