"""Meshes in another format, and presets."""

import io
import json

import numpy as np
import pytest

from tests.bundle import files
from urdftool.bundle.presets import PRESETS
from urdftool.commands.bundle import PRESET_NAMES
from urdftool.geometry.load import load_mesh

TEXTURED = b"""mtllib a.mtl
o one
v 0 0 0
v 1 0 0
v 0 2 0
v 0 0 3
vt 0 0
vt 1 0
vt 0.25 0.75
usemtl paint
f 1/1 3/3 2/2
f 1/1 2/2 4/3
o two
f 1/1 4/2 3/3
f 2/1 3/2 4/3
"""


@pytest.fixture
def png():
    """A real image."""
    from PIL import Image

    stream = io.BytesIO()
    Image.new("RGB", (2, 2), (200, 100, 50)).save(stream, "PNG")
    return stream.getvalue()


def bundle_one(urdftool, write, mesh, *options):
    path = write("r.urdf", files.robot((mesh, mesh)))
    result = urdftool("bundle", path, "-o", "out", "--check", *options)
    assert (result.code, result.out) == (0, "")
    return result


@pytest.mark.parametrize("target", ["stl", "obj", "dae", "glb"])
def test_units_and_colors_of_collada(urdftool, write, tmp_path, target):
    result = bundle_one(urdftool, write, write("a.dae", files.COLORED_DAE), "--meshes", target)
    mesh = load_mesh(tmp_path / "out" / "meshes" / f"a.{target}")
    assert np.allclose(mesh.vertices.min(axis=0), 0, atol=1e-6)
    assert np.allclose(mesh.vertices.max(axis=0), (1, 2, 3), atol=1e-6)
    assert len(mesh.faces) == 4
    if target == "stl":
        assert "[lossy-mesh]" in result.err
    else:
        assert "lossy-mesh" not in result.err
        assert mesh.parts[0].rgba == pytest.approx((0.2, 0.4, 0.6, 1), abs=1e-5)


@pytest.mark.library("PIL")
@pytest.mark.parametrize("target", ["obj", "dae", "glb"])
def test_textures_are_kept(urdftool, write, tmp_path, png, target):
    write("a.mtl", files.mtl("skin.png"))
    write("skin.png", png)
    before = load_mesh(write("a.obj", TEXTURED))
    bundle_one(urdftool, write, "a.obj", "--meshes", "glb")
    first = tmp_path / "out" / "meshes" / "a.glb"
    if target != "glb":
        write("b.glb", first.read_bytes())
        bundle_one(urdftool, write, "b.glb", "--meshes", target, "--overwrite")
        first = tmp_path / "out" / "meshes" / f"b.{target}"
        assert (tmp_path / "out" / "meshes" / "b.png").read_bytes() == png
    after = load_mesh(first)
    assert np.allclose(after.vertices[after.faces], before.vertices[before.faces], atol=1e-6)
    for one, other in zip(before.parts, after.parts, strict=True):
        assert np.allclose(one.uv, other.uv, atol=1e-5)
        assert (other.image or other.texture.read_bytes()) == png


@pytest.mark.parametrize("target", ["obj", "dae", "glb"])
def test_meshes_without_colors_get_none(urdftool, write, tmp_path, target):
    bundle_one(urdftool, write, write("a.stl", files.stl()), "--meshes", target)
    mesh = load_mesh(tmp_path / "out" / "meshes" / f"a.{target}")
    assert [part.rgba for part in mesh.parts] == [None]
    assert {path.suffix for path in (tmp_path / "out" / "meshes").iterdir()} == {f".{target}"}


def test_presets_convert_only_what_their_reader_cannot_read(urdftool, write, tmp_path):
    write("a.dae", files.COLORED_DAE)
    write("b.stl", files.stl())
    path = write("r.urdf", files.robot(("a.dae", "b.stl")))
    assert urdftool("bundle", path, "-o", "out", "--for", "mujoco").code == 0
    names = {item.name for item in (tmp_path / "out" / "meshes").iterdir()}
    assert names == {"a.obj", "a.mtl", "b.stl"}
    options = json.loads((tmp_path / "out" / "bundle.json").read_text())["options"]
    assert options == {"uri": "relative", "for": "mujoco"}


def test_mujoco_gets_binary_stl_and_one_object(urdftool, write, tmp_path):
    write("a.mtl", files.mtl("gone.png"))
    write("a.obj", TEXTURED)
    ascii_stl = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0"
    write("b.stl", ascii_stl + "\nendloop\nendfacet\nendsolid x\n")
    path = write("r.urdf", files.robot(("a.obj", "b.stl")))
    assert urdftool("bundle", path, "-o", "out", "--for", "mujoco").code == 0
    text = (tmp_path / "out" / "meshes" / "a.obj").read_text()
    assert not [line for line in text.splitlines() if line[:2] in ("o ", "g ")]
    assert len(load_mesh(tmp_path / "out" / "meshes" / "b.obj").faces) == 1


def test_a_preset_sets_the_form_of_uris(urdftool, write, tmp_path):
    write("a.stl", files.stl())
    path = write("r.urdf", files.robot(("a.stl", "a.stl")))
    assert urdftool("bundle", path, "-o", "out", "--for", "foxglove", "--check").code == 0
    assert "package://arm_description/" in (tmp_path / "out" / "urdf" / "arm.urdf").read_text()
    assert urdftool("bundle", path, "-o", "o", "--for", "foxglove", "--uri", "relative").code == 0
    assert (tmp_path / "o" / "arm.urdf").exists()


def test_the_command_names_every_preset():
    assert set(PRESET_NAMES) == set(PRESETS)


def test_a_mesh_that_cannot_be_read_is_kept(urdftool, write, tmp_path):
    mesh = write("a.dae", "<COLLADA><triangles/></COLLADA>")
    result = urdftool(
        "bundle", write("r.urdf", files.robot((mesh, mesh))), "-o", "o", "--meshes", "obj"
    )
    assert result.code == 0
    assert "[unconverted-mesh]" in result.err
    assert (tmp_path / "o" / "meshes" / "a.dae").exists()


def test_colors_of_gltf_are_linear(urdftool, write, tmp_path):
    write("a.dae", files.COLORED_DAE)
    bundle_one(urdftool, write, "a.dae", "--meshes", "glb")
    content = (tmp_path / "out" / "meshes" / "a.glb").read_bytes()
    length = int.from_bytes(content[12:16], "little")
    surface = json.loads(content[20 : 20 + length])["materials"][0]["pbrMetallicRoughness"]
    given = load_mesh(tmp_path / "a.dae").parts[0].rgba
    expected = [
        ((part + 0.055) / 1.055) ** 2.4 if part > 0.04045 else part / 12.92 for part in given
    ]
    assert surface["baseColorFactor"][:3] == pytest.approx(expected[:3])
    found = load_mesh(tmp_path / "out" / "meshes" / "a.glb").parts[0].rgba
    assert found == pytest.approx(given, abs=1e-6)
