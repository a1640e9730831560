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
