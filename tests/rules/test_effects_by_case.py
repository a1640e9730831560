"""A finding names only the effects that hold in its case."""

import pytest

from urdftool.lint.outcome import Options
from urdftool.lint.run import lint_file
from urdftool.lint.settings import Settings

INERTIAL = """<inertial><mass value="{mass}"/>
  <inertia ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/></inertial>"""
HEAVY = INERTIAL.format(mass=1, moment=0.01)
NOTHING = INERTIAL.format(mass=0, moment=0)
BOX = '<geometry><box size="0.1 0.1 0.1"/></geometry>'
VISUAL, COLLISION = f"<visual>{BOX}</visual>", f"<collision>{BOX}</collision>"
MATERIAL = '<visual>{box}<material name="m"><color rgba="{rgba}"/></material></visual>'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def _robot(arm="", *, base=HEAVY, mid=HEAVY, kind="revolute", limit=LIMIT, first=""):
    """Make a robot of three links: base, mid on a revolute joint, arm on a joint of ``kind``."""
    return f"""<?xml version="1.0"?>
<robot name="r">{first}
  <link name="base">{base}</link>
  <link name="mid">{mid}</link>
  <link name="arm">{arm}</link>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="mid"/><axis xyz="0 0 1"/>{LIMIT}
  </joint>
  <joint name="swing" type="{kind}">
    <parent link="mid"/><child link="arm"/><axis xyz="0 0 1"/>{limit}
  </joint>
</robot>
"""


def effects_of(tmp_path, rule, text):
    """Give the effects of the only finding of a rule."""
    path = tmp_path / "r.urdf"
    path.write_text(text)
    (finding,) = lint_file(path, Options(Settings(select=(rule,)))).findings
    return finding.effects


@pytest.mark.parametrize(
    ("robot", "gazebo", "mujoco"),
    [
        (_robot(VISUAL + COLLISION), "leave out", "mass of water"),
        (_robot(VISUAL), "leave out", "rejects"),
        (_robot(VISUAL, kind="fixed"), "merge", ""),
        (_robot(VISUAL + COLLISION, kind="fixed"), "merge", "mass of water"),
        (_robot(HEAVY, base=VISUAL + COLLISION), "load nothing", ""),
    ],
    ids=["moves", "moves without collision", "fixed", "fixed with collision", "root"],
)
def test_missing_inertial(tmp_path, robot, gazebo, mujoco):
    effects = effects_of(tmp_path, "missing-inertial", robot)
    assert gazebo in effects["gz, gazebo-classic"]
    assert mujoco in effects.get("mujoco", "")
    assert ("mujoco" in effects) == bool(mujoco)
    assert "1 kg" in effects["pybullet"]


@pytest.mark.parametrize(
    ("robot", "keys"),
    [
        (_robot(NOTHING + COLLISION), {"gz, gazebo-classic", "mujoco"}),
        (_robot(HEAVY, base=NOTHING), {"gz, gazebo-classic", "pybullet"}),
        (
            _robot(INERTIAL.format(mass=0, moment=0.1), kind="fixed"),
            {"gz, gazebo-classic, pinocchio", "mujoco", "drake"},
        ),
    ],
    ids=["moves", "root", "fixed"],
)
def test_zero_mass(tmp_path, robot, keys):
    assert effects_of(tmp_path, "zero-mass", robot).keys() == keys


@pytest.mark.parametrize(
    ("inertial", "pybullet", "gazebo"),
    [
        (HEAVY.replace('ixy="0"', ""), {"pybullet, drake"}, "load the link without"),
        ('<inertial><mass value="1"/></inertial>', {"pybullet"}, "load the link without"),
        ("<inertial/>", {"pybullet"}, "take 0 kg"),
    ],
    ids=["a number", "the inertia", "both"],
)
def test_incomplete_inertial(tmp_path, inertial, pybullet, gazebo):
    effects = effects_of(tmp_path, "incomplete-inertial", _robot(inertial + COLLISION))
    assert {key for key in effects if "pybullet" in key} == pybullet
    assert effects["gz, gazebo-classic"].startswith(gazebo)


@pytest.mark.parametrize(("kind", "accepted"), [("revolute", False), ("fixed", True)])
def test_rounded_moments_of_a_part(tmp_path, kind, accepted):
    tensor = '<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.00201"/>'
    robot = _robot(f'<inertial><mass value="1"/>{tensor}</inertial>', kind=kind)
    effects = effects_of(tmp_path, "inertia-triangle-inequality-rounding", robot)
    assert effects["gz, gazebo-classic"].startswith("accept it" if accepted else "reject")
    assert effects["mujoco"] == "rejects the file"
