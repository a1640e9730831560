"""Every format gives the same cube; every damaged file one clear sentence."""

import struct
from pathlib import Path

import numpy as np
import pytest

from urdftool.errors import MeshError
from urdftool.geometry.load import load_mesh
from urdftool.geometry.surface import measure_surface

FIXTURES = Path(__file__).parents[2] / "fixtures" / "meshes"


def bounds(mesh):
    corners = mesh.vertices[mesh.faces].reshape(-1, 3)
    return corners.min(axis=0), corners.max(axis=0)


@pytest.mark.parametrize(
    "name",
    [
        "cube.stl",
        "cube_ascii.stl",
        "cube_solid_header.stl",
        "cube.ply",
        "cube_binary.ply",
        "cube.dae",
    ],
)
def test_cube(name):
    mesh = load_mesh(FIXTURES / name)
    facts = measure_surface(mesh.vertices, mesh.faces)
    assert len(mesh.faces) == 12
    assert not facts.open_edges
    assert facts.consistent
    assert facts.volume == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(bounds(mesh), [[-0.5] * 3, [0.5] * 3])
    assert mesh.notes == ()
    assert sum(part.count for part in mesh.parts) == 12


def test_what_is_beyond_all_sizes_is_damaged(tmp_path):
    path = tmp_path / "far.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1e200 0\nf 1 2 3\n")
    with pytest.raises(MeshError, match=r"reaches 1e\+200 m from its origin"):
        load_mesh(path)
    assert load_mesh(path, (1, 1e-200, 1)).vertices.max() == pytest.approx(1)


@pytest.mark.parametrize(
    ("library", "note"),
    [
        ("gone.mtl", ("gone.mtl is not in the folder of the OBJ file, so the mesh has no", False)),
        ("../out.mtl", ("../out.mtl may not be read; its colors are lost", True)),
    ],
)
def test_colors_are_lost_only_where_they_exist(tmp_path, library, note):
    (tmp_path / "out.mtl").write_text("newmtl red\nKd 1 0 0\n")
    path = tmp_path / "package" / "a.obj"
    path.parent.mkdir()
    path.write_text(f"mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (found,) = load_mesh(path).notes
    assert (found.message.startswith(note[0]), found.lossy) == (True, note[1])


def test_suffix_in_capitals(tmp_path):
    file = tmp_path / "CUBE.STL"
    file.write_bytes((FIXTURES / "cube.stl").read_bytes())
    assert load_mesh(file).format == "stl"


def test_obj_has_objects_colours_polygons_and_relative_indices():
    mesh = load_mesh(FIXTURES / "cube.obj")
    left, right = mesh.parts
    assert (left.name, left.rgba, left.texture) == ("left", (1.0, 0.0, 0.0, 0.5), None)
    assert right.rgba == (0.5, 0.25, 0.125, 1.0)
    assert right.texture == FIXTURES / "textures" / "wood.png"
    assert mesh.vertices[mesh.get_part_faces(right)][..., 0].min() == pytest.approx(2.5)
    assert measure_surface(mesh.vertices, mesh.faces).volume == pytest.approx(2.0)


@pytest.mark.parametrize("name", ["textured.obj", "textured.dae", "textured.glb"])
@pytest.mark.parametrize("mirror", [1, -1])
def test_texture_coordinates_lie_on_their_corners(name, mirror):
    mesh = load_mesh(FIXTURES / name, (mirror, 1, 1))
    front, sides = mesh.parts
    corners = mesh.vertices[mesh.get_part_faces(front)]
    np.testing.assert_allclose(front.uv[..., 0], corners[..., 0] * mirror, atol=1e-9)
    np.testing.assert_allclose(front.uv[..., 1], corners[..., 2], atol=1e-9)
    assert sides.uv is None
    assert sides.texture is None
    if name.endswith("glb"):
        assert front.image == (FIXTURES / "quadrants.png").read_bytes()
    else:
        assert front.texture == FIXTURES / "quadrants.png"


def test_obj_with_a_corner_without_texture_has_none(tmp_path):
    file = tmp_path / "a.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nf 1/1 2/2 3\nf 1/1 2/2 3/9\n")
    assert load_mesh(file).parts[0].uv is None
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1\nf 1/1/1 2/2/1 3/-1/1\n")
    assert load_mesh(file).parts[0].uv.tolist() == [[[0, 0], [1, 0], [1, 0]]]


def test_collada_with_a_broken_material_keeps_its_triangles():
    mesh = load_mesh(FIXTURES / "broken_material.dae")
    assert [part.count for part in mesh.parts] == [2, 4]
    assert mesh.parts[0].rgba is None
    assert mesh.parts[1].rgba == (0.5, 0.0, 0.5, 1.0)
    assert [note.code for note in mesh.notes if note.lossy] == ["collada-broken-material"]


def test_collada_unit_is_applied_and_up_axis_is_not():
    mesh = load_mesh(FIXTURES / "inch_y_up.dae")
    size = np.ptp(bounds(mesh), axis=0).reshape(-1)
    np.testing.assert_allclose(size, np.array([1, 2, 4]) * 0.0254, rtol=1e-6)
    assert len(mesh.notes) == 2
    assert mesh.parts[0].rgba == pytest.approx((0.2, 0.4, 0.6, 1.0))


def test_collada_instances_are_placed_and_mirrored_ones_keep_their_volume():
    mesh = load_mesh(FIXTURES / "instances.dae")
    low, high = bounds(mesh)
    np.testing.assert_allclose(low, [-0.5, -0.5, 1.5], atol=1e-6)
    np.testing.assert_allclose(high, [3.5, 0.5, 2.5], atol=1e-6)
    assert measure_surface(mesh.vertices, mesh.faces).volume == pytest.approx(2.0, rel=1e-6)


def test_gltf_is_turned_so_that_y_becomes_z():
    mesh = load_mesh(FIXTURES / "cube.glb")
    np.testing.assert_allclose(bounds(mesh)[1], [0.5, 2.0, 1.0], atol=1e-6)
    assert measure_surface(mesh.vertices, mesh.faces).volume == pytest.approx(8.0, rel=1e-6)
    lying = load_mesh(FIXTURES / "cube.glb", gltf_up="z")
    np.testing.assert_allclose(bounds(lying)[1], [0.5, 1.0, 2.0], atol=1e-6)


def test_mirrored_scale_keeps_the_sign_of_the_volume():
    mesh = load_mesh(FIXTURES / "cube.stl", (-2, 1, 3))
    facts = measure_surface(mesh.vertices, mesh.faces)
    assert facts.volume == pytest.approx(6.0)
    assert not facts.inside_out


def test_bytes_after_the_last_triangle_are_said():
    mesh = load_mesh(FIXTURES / "trailing_bytes.stl")
    assert len(mesh.faces) == 10
    assert mesh.notes[0].code == "stl-trailing-bytes"
    assert "100 bytes" in mesh.notes[0].message


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("no_such.stl", "no such mesh"),
        ("empty.stl", "empty"),
        ("lfs_pointer.stl", "git lfs pull"),
        ("truncated.stl", "684 bytes, it has 400"),
        ("truncated_ascii.stl", "endsolid"),
        ("huge_claim.stl", "85899345 triangles need 4294967334 bytes"),
        ("nan.stl", "NaN"),
        ("broken.dae", "cannot be read"),
        ("entities.dae", "entities"),
        ("index_out_of_range.obj", "vertex 4 of 3"),
        ("cube.mtl", "not a mesh format"),
        (".", "folder"),
    ],
)
def test_bad_file(name, words):
    with pytest.raises(MeshError) as error:
        load_mesh(FIXTURES / name)
    assert words in str(error.value)
    assert error.value.path == str(FIXTURES / name)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("scale", [(1, 1), (0, 1, 1), (1, float("nan"), 1), (1, 1, float("inf"))])
def test_bad_scale(scale):
    with pytest.raises(MeshError, match="three finite factors"):
        load_mesh(FIXTURES / "cube.stl", scale)


@pytest.mark.parametrize("suffix", ["stl", "obj", "dae", "ply", "gltf", "glb"])
@pytest.mark.parametrize(
    "data",
    [
        b"\x00",
        b"\xff" * 300,
        b"solid",
        b"ply\nformat binary_little_endian 1.0\nelement vertex 99999999\nend_header\n",
        b"v 1 2\nf 1 1 1\n",
        b"f a b c\n",
        b"<COLLADA/>",
        b"{}",
        b'{"asset": {"version": "2.0"}, "meshes": 3}',
        b"glTF" + struct.pack("<II", 2, 4_000_000_000) + b"JSON",
    ],
    ids=range(10),
)
def test_rubbish_is_one_error(tmp_path, suffix, data):
    file = tmp_path / f"rubbish.{suffix}"
    file.write_bytes(data)
    with pytest.raises(MeshError):
        load_mesh(file)


@pytest.mark.parametrize("name", ["cube.stl", "cube.dae", "cube_binary.ply", "cube.glb"])
def test_cut_off_anywhere(tmp_path, name):
    data = (FIXTURES / name).read_bytes()
    file = tmp_path / name
    for share in (0.05, 0.3, 0.6, 0.95):
        file.write_bytes(data[: int(share * len(data))])
        with pytest.raises(MeshError):
            load_mesh(file)


def test_a_textured_face_that_names_no_vertex_is_damaged(tmp_path):
    data = bytearray((FIXTURES / "textured.glb").read_bytes())
    data[1174] = 252  # the last index of a face
    damaged = tmp_path / "textured.glb"
    damaged.write_bytes(data)
    with pytest.raises(MeshError, match="a face names vertex 252"):
        load_mesh(damaged)
