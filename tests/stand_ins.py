"""A folder with the files that the examples of help and documentation name."""

import re
import shutil
import subprocess
import sys

from tests.conftest import FIXTURES
from urdftool import expand

ROBOTS = FIXTURES / "robots"
ARM = ROBOTS / "demo_arm" / "urdf"
STAGE = """#usda 1.0
(
    defaultPrim = "robot"
    metersPerUnit = 1
    upAxis = "Z"
)
def Xform "robot"
{
    def Xform "base" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {
        float physics:mass = 1
        point3f physics:centerOfMass = (0, 0, 0)
        float3 physics:diagonalInertia = (0.1, 0.1, 0.1)
    }
}
"""
SRDF = (
    '<robot name="demo_arm">\n'
    '  <disable_collisions link1="base_link" link2="shoulder" reason="Adjacent"/>\n'
    '  <group name="all"><joint name="elbow"/></group>\n'
    '  <group_state name="ready" group="all"><joint name="elbow" value="0.5"/></group_state>\n'
    "</robot>\n"
)


def make(folder):
    """The files, in a git repository with the tag v1.2."""
    packages = folder / "packages"
    shutil.copytree(ROBOTS, packages)
    arm = expand(packages / "demo_arm/urdf/arm_sound.urdf.xacro")
    names = ("arm_sim.urdf", "panda.urdf", "hand.urdf", "quadruped.urdf", "jvrc1.urdf")
    for name in (*names, "urdf/arm.urdf", "robots/arm.urdf"):
        _put(folder / name, arm)
    _put(folder / "arm.urdf", re.sub("<inertial>.*?</inertial>", "", arm, count=1, flags=re.DOTALL))
    shutil.copy(ARM / "arm_sound.urdf.xacro", folder / "arm.urdf.xacro")
    shutil.copy(ARM / "arm_sound.urdf.xacro", folder / "quadruped.urdf.xacro")
    shutil.copy(ARM / "link_sound.macro.xacro", folder / "link_sound.macro.xacro")
    shutil.copytree(ROBOTS / "laser_bot", folder / "src" / "laser_bot")
    for name in ("gripper.urdf", "gripper.xacro", "left_arm.urdf"):
        shutil.copy(ROBOTS.parent / "edit" / name, folder / name)
    shutil.copy(ROBOTS / "mira_description/urdf/mira.urdf", folder / "mira.urdf")
    mobile = packages / "my_robot/urdf/mobile_manipulator.urdf.xacro"
    _put(folder / "rover.urdf", expand(mobile))
    _put(folder / "arm.srdf", SRDF)
    shutil.copy(FIXTURES / "formats/sdf/gripper_arm.gz.sdf", folder / "model.sdf")
    for name in ("arm.xml", "robot.xml", "b.xml"):
        shutil.copy(FIXTURES / "formats/mjcf/arm.xml", folder / name)
    _put(folder / "a.urdf", arm)
    _put(folder / "robot.usda", STAGE)
    _put(folder / "arm.srdf.xacro", SRDF)
    words = ("bundle", "panda.urdf", "-o", "arm.zip")
    subprocess.run([sys.executable, "-m", "urdftool", "-q", *words], cwd=folder, check=True)
    _put(folder / "names.txt", "# no names differ\n")
    _put(folder / "actuators.toml", '[joints."*"]\narmature = 0.01\n')
    for name, mesh in {
        "link3.stl": "cube.stl",
        "link3.dae": "inch_y_up.dae",
        "cover.stl": "open_box.stl",
        "gripper.stl": "cavity.stl",
        "wheel.dae": "cube.dae",
    }.items():
        shutil.copy(FIXTURES / "meshes" / mesh, folder / name)
    (folder / "test_results").mkdir()
    lint = ("lint", "src/", "--write-baseline", "lint-baseline.json", "--no-cache")
    subprocess.run([sys.executable, "-m", "urdftool", "-q", *lint], cwd=folder, check=True)
    for words in (("init", "-qb", "main"), ("add", "."), ("commit", "-qm", "one"), ("tag", "v1.2")):
        who = ("-c", "user.name=nobody", "-c", "user.email=nobody@example.org")
        subprocess.run(["git", *who, "-c", "tag.gpgsign=false", *words], cwd=folder, check=True)
    return folder


def _put(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")
