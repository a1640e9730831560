"""Robots in SDF, MJCF and USD as bundles."""

import json
from pathlib import Path

import pytest

import urdftool as api

ARM = Path(__file__).parents[2] / "fixtures" / "robots" / "my_robot" / "urdf" / "arm.urdf.xacro"


def list_bodies(robot):
    return [(link.name, link.inertial.mass) for link in robot.links if link.inertial is not None]


@pytest.mark.parametrize(
    "name",
    [
        "sdf",
        pytest.param("mjcf", marks=[pytest.mark.library("mujoco"), pytest.mark.slow]),
        pytest.param("usd", marks=[pytest.mark.library("pxr"), pytest.mark.slow]),
    ],
)
def test_a_bundle_of_another_format(urdftool, tmp_path, name):
    assert urdftool("-q", "export", name, ARM, "-o", tmp_path / "in put").code == 0
    suffixes = (".sdf", ".xml", ".usda")
    source = next(path for path in (tmp_path / "in put").iterdir() if path.suffix in suffixes)
    out = tmp_path / "out"
    result = urdftool("bundle", source, "-o", out, "--check")
    assert (result.code, result.out) == (0, "")
    bundle = api.load(out / "my_robot_arm.urdf")
    assert list_bodies(bundle) == list_bodies(api.load(source))
    assert len(list((out / "meshes").iterdir())) == 5
    document = json.loads((out / "bundle.json").read_text())
    assert document["source"] == source.name
    sources = [name for file in document["files"] for name in file.get("sources", ())]
    assert not [name for name in sources if name.startswith(("/", "../"))]
    before = (out / "bundle.json").read_bytes()
    assert urdftool("bundle", source, "-o", out).code == 0
    assert (out / "bundle.json").read_bytes() == before


def test_losses_are_reported(urdftool, write):
    write(
        "a.sdf",
        '<sdf version="1.9"><model name="m"><link name="a"><visual name="v"><geometry>'
        "<ellipsoid><radii>1 2 3</radii></ellipsoid></geometry></visual></link>"
        "</model></sdf>",
    )
    result = urdftool("bundle", "a.sdf", "-o", "out")
    assert result.code == 0
    assert "[lossy-shape]" in result.err


def test_a_missing_mesh_is_refused(urdftool, write, tmp_path):
    write(
        "a.sdf",
        '<sdf version="1.9"><model name="m"><link name="a"><visual name="v"><geometry>'
        "<mesh><uri>gone.stl</uri></mesh></geometry></visual></link></model></sdf>",
    )
    result = urdftool("bundle", "a.sdf", "-o", "out")
    assert result.code == 2
    assert "[mesh-not-found]" in result.err
    assert not (tmp_path / "out").exists()


TENDON = """<mujoco model="m"><worldbody><body name="a"><joint name="j"/><geom size=".1"/>
</body></worldbody><tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><motor name="pull" tendon="t"/></actuator></mujoco>"""


@pytest.mark.library("mujoco")
def test_its_own_format_is_made_of_the_original(urdftool, write, tmp_path):
    write("a.xml", TENDON)
    assert urdftool("bundle", "a.xml", "-o", "out", "--format", "mjcf", "--check").code == 0
    (made,) = (tmp_path / "out").glob("*.xml")
    differing = api.verify(tmp_path / "a.xml", made).list_disagreements()
    assert [(one.row, one.name) for one in differing] == [("configurations", "home")]  # added
    assert 'tendon="t"' in made.read_text()
    assert (tmp_path / "out" / "m.urdf").is_file()
