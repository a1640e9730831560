"""The functions that do what commands do: the same results, nothing written unasked."""

import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import urdftool as api
from tests.conftest import FIXTURES
from urdftool.collision.settings import Settings as CollisionSettings
from urdftool.errors import ConfigError, MeshError, ModelError, OutputError
from urdftool.simulation.settings import Settings

ARM = FIXTURES / "robots/demo_arm/urdf/arm_sound.urdf.xacro"
MIRA = FIXTURES / "robots/mira_description/urdf/mira.urdf"
BAD = (
    '<robot name="r"><link name="a"/><link name="b"/>'
    '<joint name="j" type="revolute">{}</joint></robot>'
)
AXIS = '<parent link="a"/><child link="b"/><axis xyz="0 0 2"/><limit effort="1" velocity="1"/>'


@pytest.fixture
def bad(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text(BAD.format(AXIS))
    return path


def test_fix_writes_only_when_asked(bad):
    before = bad.read_text()
    result = api.fix(bad, select=["axis-not-unit"], unsafe=True)
    assert result.applied == {"axis-not-unit": 1}
    assert result.report.findings == []
    assert bad.read_text() == before
    api.fix(bad, select=["axis-not-unit"], unsafe=True, write=True)
    assert bad.read_text() == result.after[str(bad)].decode() == before.replace("0 0 2", "0 0 1")


def test_fix_gives_what_the_command_writes(tmp_path, urdftool):
    shutil.copytree(FIXTURES / "robots/demo_arm", tmp_path / "demo_arm")
    path = tmp_path / "demo_arm/urdf/arm.urdf.xacro"
    ours = api.fix(path, unsafe=True)
    assert ours.applied
    urdftool("lint", path, "--fix", "--unsafe-fixes")
    assert ours.after == {name: Path(name).read_bytes() for name in ours.after}


def test_fix_of_a_file_that_is_not_there(tmp_path):
    with pytest.raises(api.UrdftoolError, match=r"no such file|does not exist"):
        api.fix(tmp_path / "absent.urdf")


def test_export_sdf_writes_where_it_is_told(tmp_path, monkeypatch, urdftool):
    monkeypatch.chdir(tmp_path)
    robot = api.load(ARM)
    written = api.export_sdf(robot, verify=True)
    assert list(tmp_path.iterdir()) == []
    assert all(f'<link name="{link.name}"' in written.text for link in robot.links[1:])
    assert {check.verdict for check in written.checks} == {"equal", "none"}
    api.export_sdf(robot, "ours.sdf")
    assert urdftool("export", "sdf", ARM, "-o", "theirs.sdf").code == 0
    assert Path("ours.sdf").read_bytes() == Path("theirs.sdf").read_bytes()


def test_export_sdf_refuses():
    with pytest.raises(ConfigError, match=r"'gz' does not read SDF 1\.7; it reads 1\.9"):
        api.export_sdf(api.load(ARM), version="1.7")
    two = api.load(FIXTURES / "rules/multiple-roots/bad.urdf")
    with pytest.raises(ModelError):
        api.export_sdf(two)


def test_an_export_takes_no_place_of_its_robot(bad):
    before = bad.read_text()
    path = bad.rename(bad.with_suffix(".xml"))
    with pytest.raises(OutputError, match="is an input of the export"):
        api.export_mjcf(api.load(path), path, force=True, overwrite=True)
    assert path.read_text() == before


def test_export_mjcf_is_what_the_command_writes(tmp_path, monkeypatch, urdftool):
    monkeypatch.chdir(tmp_path)
    written = api.export_mjcf(api.load(ARM), "ours.xml", base="free", scene=True)
    assert urdftool("export", "mjcf", ARM, "-o", "x.xml", "--base", "free", "--scene").code == 0
    assert written.text == Path("ours.xml").read_text() == Path("x.xml").read_text()
    assert Path("ours_scene.xml").is_file()


@pytest.mark.skipif(not find_spec("mujoco"), reason="MuJoCo compiles it")
def test_export_mjcf_compares():
    checks = api.export_mjcf(api.load(ARM), verify=True).checks
    other = {
        check.name: check.verdict for check in checks if check.verdict not in ("equal", "none")
    }
    assert set(other.values()) == {"announced"}  # what the export adds to the source
    assert "joint physics" in other


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
def test_simulate_judges(engine):
    if not find_spec(engine):
        pytest.skip(engine)
    robot = api.load(MIRA)
    verdicts = api.simulate(robot, Settings(duration=2, trials=2), engine=engine)
    assert [verdict.stands for verdict in verdicts] == [True, True]
    assert "base_link" in verdicts[0].rest.supports


def test_simulate_knows_its_engines():
    with pytest.raises(ConfigError, match="'ode'; there are pybullet and mujoco"):
        api.simulate(api.load(ARM), engine="ode")


def test_collisions_are_what_the_command_writes(tmp_path, monkeypatch, urdftool):
    monkeypatch.chdir(tmp_path)
    text = '<robot name="r"><link name="a"><visual><geometry><mesh filename="{}"/></geometry>'
    text += "</visual></link></robot>"
    Path("r.urdf").write_text(text.format("cube.stl"))
    Path("cube.stl").write_bytes((FIXTURES / "meshes/cube.stl").read_bytes())
    robot = api.load("r.urdf")
    found = api.simplify_collisions(robot, "ours.urdf", cache=False, jobs=1)
    (result,) = found["a"]
    assert (result.method, len(result.pieces)) == ("primitive", 1)
    assert result.error < 1e-6
    assert urdftool("collision", "r.urdf", "-o", "theirs.urdf", "--no-cache").code == 0
    assert Path("ours.urdf").read_text() == Path("theirs.urdf").read_text()
    hull = api.simplify_collisions(
        robot, "hull.urdf", settings=CollisionSettings(method="hull"), mesh_format="obj", jobs=1
    )
    assert [one.method for one in hull["a"]] == ["hull"]
    assert Path("hull_collision/cube.obj").is_file()


def test_collisions_of_a_robot_without_its_mesh(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("r.urdf").write_text(
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="absent.stl"/>'
        "</geometry></visual></link></robot>"
    )
    with pytest.raises(MeshError, match=r"absent\.stl"):
        api.simplify_collisions(api.load("r.urdf"), "out.urdf")
    with pytest.raises(ConfigError, match="no link 'b'"):
        api.simplify_collisions(api.load("r.urdf"), "out.urdf", links=["b"])
    assert not Path("out.urdf").exists()


@pytest.mark.parametrize(
    ("choices", "message"),
    [
        ({"source": "visuals"}, "source is 'visuals', which is not one of visual, collision; did"),
        ({"uri": "model"}, "uri is 'model', which is not one of auto, package, relative, file"),
        ({"mesh_format": "dae"}, "mesh_format is 'dae', which is not one of stl, obj"),
    ],
)
def test_collisions_of_other_words(tmp_path, choices, message):
    with pytest.raises(ConfigError, match=re.escape(message)):
        api.simplify_collisions(api.load(ARM), tmp_path / "out.urdf", **choices)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("method", "hulls", "method is 'hulls', which is not one of auto, primitive, hull"),
        ("quality", "best", "quality is 'best', which is not one of fast, balanced, tight"),
        ("max_error", -1, "max_error is -1, which is not a finite number above zero"),
        ("max_error", float("nan"), "max_error is nan"),
        ("max_hulls", 0, "max_hulls is 0"),
        ("time_limit", "1", "time_limit is '1'"),
    ],
)
def test_settings_of_collisions_refuse(name, value, message):
    with pytest.raises(ConfigError, match=re.escape(message)):
        CollisionSettings(**{name: value})


def test_importing_the_package_loads_no_library():
    code = "import urdftool, sys; urdftool.load; urdftool.check; urdftool.fix; urdftool.expand\n"
    code += "print(sorted({'numpy', 'lxml', 'click', 'xacro'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


SDF = FIXTURES / "formats/sdf/gripper_arm.gz.sdf"


def test_export_urdf_gives_what_the_command_writes(tmp_path, urdftool):
    written = api.export_urdf(api.load(SDF), tmp_path / "api", verify=True)
    verdicts = {check.verdict for check in written.checks}
    assert verdicts <= {"equal", "announced", "not compared", "none"}
    urdftool("export", "urdf", SDF, "-o", tmp_path / "command")
    name = "gripper_arm.urdf"
    assert (tmp_path / "api" / name).read_bytes() == (tmp_path / "command" / name).read_bytes()
    api.export_urdf(api.load(SDF), tmp_path / "file.urdf", frames=False)
    assert len(api.load(tmp_path / "file.urdf").links) < len(
        api.load(tmp_path / "api" / name).links
    )
    with pytest.raises(OutputError):
        (tmp_path / "file.urdf").write_text("<robot/>")
        api.export_urdf(api.load(SDF), tmp_path / "file.urdf")


def test_verify_gives_what_the_command_prints(tmp_path, urdftool):
    text = MIRA.read_text()
    changed = tmp_path / "changed.urdf"
    changed.write_text(text.replace('<mass value="', '<mass value="1', 1))
    packages = {"mira_description": MIRA.parents[1]}
    agreement = api.verify(MIRA, changed, only=["mass"], packages=packages)
    assert [row.name for row in agreement.rows] == ["mass"]
    (difference,) = agreement.list_disagreements()
    assert (agreement.is_equal, difference.what, difference.kind) == (False, "mass", "link")
    option = f"mira_description={MIRA.parents[1]}"
    result = urdftool("verify", MIRA, changed, "--only", "mass", "-p", option)
    assert (result.code, f"link '{difference.name}'" in result.out) == (1, True)
    assert api.verify(api.load(MIRA), MIRA, packages=packages).is_equal
    with pytest.raises(ConfigError, match="at least two robots"):
        api.verify(MIRA)
    with pytest.raises(ConfigError, match="did you mean 'colors'"):
        api.verify(MIRA, MIRA, only=["colour"])
