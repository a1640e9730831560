"""Which files of meshes MuJoCo opens, as its settings in a URDF say, compared with MuJoCo."""

import contextlib
from pathlib import Path

import pytest

from urdftool.api.lint import check
from urdftool.model.load import load
from urdftool.rules.mujoco import find_lost_in_mujoco

BOX = Path(__file__).parents[2] / "fixtures" / "effects" / "robots" / "box.stl"
ROBOT = """<robot name="r">{compiler}
<link name="base"/>
<link name="arm">
<inertial><mass value="1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
<{tag}><geometry><mesh filename="{uri}"/></geometry></{tag}></link>
<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>
<axis xyz="0 0 1"/></joint>
</robot>
"""


def _write(folder, uri, compiler="", tag="collision"):
    for place in ("robot/urdf", "robot/meshes"):
        (folder / place).mkdir(parents=True, exist_ok=True)
    for place in ("robot/urdf/beside.stl", "robot/meshes/there.stl"):
        (folder / place).write_bytes(BOX.read_bytes())
    (folder / "robot/package.xml").write_text("<package><name>robot</name></package>")
    file = folder / "robot/urdf/robot.urdf"
    if compiler:
        compiler = f"<mujoco><compiler {compiler}/></mujoco>"
    file.write_text(ROBOT.format(uri=uri, compiler=compiler, tag=tag))
    return file


@pytest.mark.parametrize(
    "compiler",
    [
        "",
        'meshdir="../meshes"',
        'meshdir="../meshes" strippath="true"',
        'assetdir="../meshes" strippath="true"',
        'meshdir="../meshes" discardvisual="false"',
        'strippath="true"',
    ],
)
@pytest.mark.parametrize("tag", ["collision", "visual"])
def test_files_that_mujoco_does_not_find(tmp_path, compiler, tag):
    mujoco = pytest.importorskip("mujoco")
    for uri in ("beside.stl", "./beside.stl", "../meshes/there.stl", "there.stl", "gone.stl"):
        file = _write(tmp_path, uri, compiler, tag)
        robot = load(file)
        lost = bool(find_lost_in_mujoco(robot, robot.source))
        if lost:
            with pytest.raises(ValueError, match="Error opening file"):
                mujoco.MjModel.from_xml_path(str(file))
        else:
            mujoco.MjModel.from_xml_path(str(file))


@pytest.mark.parametrize(
    ("uri", "compiler", "severity", "said", "rejects"),
    [
        ("beside.stl", 'meshdir="../meshes"', "warning", "does not find", True),
        ("there.stl", 'meshdir="../meshes"', "warning", "only MuJoCo finds", False),
        ("gone.stl", 'meshdir="../meshes"', "error", "does not exist", True),
    ],
)
def test_who_finds_a_mesh(tmp_path, uri, compiler, severity, said, rejects):
    (finding,) = check(_write(tmp_path, uri, compiler), select=["mesh-not-found"])
    assert (finding.severity.label, said in finding.message) == (severity, True)
    assert any(key.startswith("mujoco") for key in finding.effects) == rejects


@pytest.mark.parametrize(
    ("uri", "compiler", "tag", "loads"),
    [
        ("beside.stl", "", "collision", True),
        ("beside.stl", 'meshdir="../meshes"', "collision", False),
        ("package://robot/meshes/there.stl", "", "collision", False),
        ("package://robot/meshes/there.stl", "", "visual", True),
        ("package://robot/meshes/there.stl", 'discardvisual="false"', "visual", False),
        ("package://robot/urdf/beside.stl", 'strippath="true"', "collision", True),
        ("file://beside.stl", "", "collision", False),
    ],
)
def test_effects_of_a_robot_whose_meshes_mujoco_does_not_find(tmp_path, uri, compiler, tag, loads):
    mujoco = pytest.importorskip("mujoco")
    file = _write(tmp_path, uri, compiler, tag)
    (finding,) = (f for f in check(file) if f.code == "placeholder-inertia")
    assert any("mujoco" in key for key in finding.effects) == loads
    with contextlib.nullcontext() if loads else pytest.raises(ValueError, match="opening file"):
        mujoco.MjModel.from_xml_path(str(file))
