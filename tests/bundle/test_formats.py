"""SDF, MJCF and SRDF in a bundle."""

import json

import pytest

from tests.bundle import files
from tests.conftest import FIXTURES

ARM = FIXTURES / "robots" / "my_robot" / "urdf" / "arm.urdf.xacro"


@pytest.mark.parametrize("uri", ["relative", "package"])
def test_all_formats_share_a_bundle(urdftool, tmp_path, uri):
    out = tmp_path / "arm"
    options = ["--format", "sdf", "--format", "mjcf", "--uri", uri]
    assert urdftool("bundle", ARM, "-o", out, *options).code == 0
    assert {"my_robot_arm.sdf", "my_robot_arm.xml", "bundle.json"} <= {
        p.name for p in out.iterdir()
    }
    assert len(list((out / "meshes").iterdir())) == 5  # SDF uses those of the URDF
    assert json.loads((out / "bundle.json").read_text())["options"]["format"] == [
        *("urdf", "sdf", "mjcf")
    ]
    result = urdftool("bundle", out, "--check")
    assert (result.code, result.out) == (0, "")
    moved = out.rename(tmp_path / "moved")
    for name in ("my_robot_arm.sdf", "my_robot_arm.xml"):
        assert urdftool("info", moved / name).code == 0
    (moved / "assets").rename(moved / "other")
    assert "missing-reference" in urdftool("bundle", moved, "--check").out


def test_losses_name_the_place_in_the_bundle(urdftool, tmp_path):
    result = urdftool("bundle", ARM, "-o", tmp_path / "arm", "--format", "sdf")
    assert result.code == 0
    lines = [line for line in result.err.splitlines() if "[lossy-" in line]
    assert lines
    assert all(line.startswith("my_robot_arm.urdf:") for line in lines)


def test_an_srdf_comes_along(urdftool, write, tmp_path):
    write("a.stl", files.stl())
    path = write("r.urdf", files.robot(("a.stl", "a.stl")))
    text = (
        '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:property name="l" value="l0"/><group name="g"><link name="${l}"/></group></robot>'
    )
    srdf = write("arm.srdf.xacro", text)
    assert urdftool("bundle", path, "-o", "out", "--srdf", srdf, "--check").code == 0
    assert '<link name="l0"/>' in (tmp_path / "out" / "arm.srdf").read_text()
    assert urdftool("bundle", path, "-o", "o", "--srdf", write("x.srdf", "<a/>")).code == 2
    assert not (tmp_path / "o").exists()
