"""Who sees glTF meshes is told that readers turn them or not."""

import shutil

from tests.conftest import FIXTURES
from urdftool.lint.run import check
from urdftool.model.gltf_axes import gltf_note
from urdftool.model.load import load

SHAPE = (
    '<visual><geometry><mesh filename="{}"/></geometry></visual>'
    '<collision><origin xyz="0 0 9"/><geometry><box size="1 1 1"/></geometry></collision>'
)


def robot(tmp_path, *meshes):
    for mesh in meshes:
        shutil.copy(FIXTURES / "meshes" / f"cube.{mesh.rpartition('.')[2]}", tmp_path / mesh)
    file = tmp_path / "robot.urdf"
    shapes = "".join(SHAPE.format(mesh) for mesh in meshes)
    file.write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>')
    return file


def test_the_picture_says_how_it_is_drawn(urdftool, tmp_path):
    file = robot(tmp_path, "one.glb")
    assert gltf_note(load(file)).startswith("'one.glb' is glTF, drawn with Y up")
    done = urdftool("view", file, "--picture", tmp_path / "p.png", "--size", "64x48")
    assert done.code == 0
    assert "note: 'one.glb' is glTF" in done.err
    assert gltf_note(load(robot(tmp_path, "one.glb", "two.glb"))).startswith("2 meshes are glTF")


def test_other_meshes_have_no_two_ways_up(urdftool, tmp_path):
    file = robot(tmp_path, "one.stl")
    assert gltf_note(load(file)) == ""


def test_a_collision_that_is_off_may_be_a_matter_of_axes(tmp_path):
    for mesh, told in (("one.glb", True), ("one.stl", False)):
        (found,) = check(robot(tmp_path, mesh), select=["collision-off-visual"])
        assert ("export it with Y up" in found.message) is told
