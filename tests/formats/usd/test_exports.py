"""Exports from a stage, and to a stage from every format: equal to their source."""

import pytest

from tests.formats.usd.test_verify import ARM

pytestmark = pytest.mark.library("pxr")


@pytest.mark.slow
def test_a_stage_is_exported_to_urdf_and_sdf_and_back(urdftool, write, tmp_path):
    urdf, stage = write("arm.urdf", ARM), tmp_path / "arm.usda"
    assert urdftool("export", "usd", urdf, "-o", str(stage)).code == 0
    for name in ("urdf", "sdf"):
        out = tmp_path / f"{name}.{name}"
        assert urdftool("export", name, str(stage), "-o", str(out)).code == 0
        assert urdftool("verify", str(stage), str(out)).code == 0
        back = tmp_path / f"{name}.usdc"
        assert urdftool("export", "usd", str(out), "-o", str(back)).code == 0
        assert urdftool("verify", urdf, str(back)).code == 0


@pytest.mark.library("mujoco")
def test_a_stage_is_exported_to_mjcf(urdftool, write, tmp_path):
    urdf, stage = write("arm.urdf", ARM), tmp_path / "arm.usda"
    assert urdftool("export", "usd", urdf, "-o", str(stage)).code == 0
    out = tmp_path / "arm.xml"
    assert urdftool("export", "mjcf", str(stage), "-o", str(out), "--verify").code == 0


def test_other_commands_name_the_format(urdftool, write, tmp_path):
    urdf, stage = write("arm.urdf", ARM), tmp_path / "arm.usdc"
    assert urdftool("export", "usd", urdf, "-o", str(stage)).code == 0
    for words in (("expand",), ("inertia", "robot", "--write")):
        result = urdftool(*words, str(stage))
        assert result.code == 2
        assert "USD" in result.err


ONE = (
    '<body name="{0}" pos="{1} 0 0.1"><freejoint/><geom type="box" size=".1 .1 .1" mass="1"/>{2}'
    "</body>"
)
PART = '<body name="{0}_arm"><joint name="{0}_j"/><geom size=".1" mass="1"/></body>'
FLOOR = '<geom type="plane" size="5 4 .1"/>'


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("moves", [True, False])
def test_several_robots_are_a_warning_and_objects_are_not(urdftool, write, tmp_path, moves):
    parts = [ONE.format(n, x, PART.format(n) if moves else "") for x, n in enumerate("abc")]
    world = "".join([FLOOR, *parts])
    path = write("m.xml", f"<mujoco><worldbody>{world}</worldbody></mujoco>")
    done = urdftool("export", "usd", path, "-o", tmp_path / "m.usda", "--verify")
    said = "joints below 'a' and 2 more belong to no articulation"
    assert (said in done.err) == moves
    assert "visuals: differs" not in done.out


@pytest.mark.parametrize(("size", "read"), [("5 4 .1", (10.0, 8.0)), ("0 0 .1", None)])
def test_a_plane_is_read_where_it_is_drawn(urdftool, write, tmp_path, size, read):
    pytest.importorskip("mujoco")
    from urdftool.api.load import load
    from urdftool.model.elements import Plane

    plane = FLOOR.replace("5 4 .1", size)
    body = f"<body>{PART.format('a')}{plane}</body>"
    path = write("m.xml", f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    stage = tmp_path / "m.usda"
    assert urdftool("export", "usd", path, "-o", stage, "--force").code == 0
    shapes = [shape.geometry for one in load(stage).links for shape in one.visuals]
    assert [shape.size for shape in shapes if isinstance(shape, Plane)] == [read]
