"""What MuJoCo does with the inertia of the root, and of what is fixed to it."""

import pytest

from urdftool import check

ROBOT = """<robot name="r">
  <link name="{root}">{inertial}</link>
  <link name="part">{inertial}</link>
  <link name="arm">{inertial}</link>
  <joint name="weld" type="fixed"><parent link="{root}"/><child link="part"/></joint>
  <joint name="turn" type="revolute"><parent link="part"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
"""
INERTIAL = """<inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"""


def effects(path):
    return {f.name: dict(f.effects) for f in check(path, select=["placeholder-inertia"])}


def test_mujoco_does_not_use_the_inertia_of_the_root(write):
    found = effects(write("r.urdf", ROBOT.format(root="base", inertial=INERTIAL)))
    weld = "does not use it: it fixes the root link to the world"
    assert [found[name]["mujoco"] for name in ("base", "part")] == [weld, weld]
    assert "mujoco" not in next(iter(found["base"]))
    assert "mujoco" in next(iter(found["arm"]))


def test_it_is_so_in_mujoco(write):
    mujoco = pytest.importorskip("mujoco")
    path = write("r.urdf", ROBOT.format(root="base", inertial=INERTIAL))
    model = mujoco.MjModel.from_xml_path(str(path))
    assert list(model.body_mass) == [0, 1]


def test_what_is_fixed_to_a_world_that_is_not_declared_is_used_by_nobody(write):
    text = ROBOT.format(root="world", inertial=INERTIAL).replace(
        f'<link name="world">{INERTIAL}</link>', ""
    )
    assert "part" not in {
        name for name, said in effects(write("r.urdf", text)).items() if "every reader" not in said
    }
