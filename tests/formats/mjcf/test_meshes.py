"""Meshes: copied or converted, named once, thickened where they are flat, refused where broken."""

import shutil

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.diagnostic import Severity
from urdftool.formats.common.cut import Cut
from urdftool.formats.mjcf.convert import convert
from urdftool.formats.mjcf.obj import write_obj_bytes
from urdftool.geometry.load import load_mesh
from urdftool.refusal import Refused

from .robots import INERTIAL, export, link, robot, rules, tree

MESHES = FIXTURES / "meshes"


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.fixture
def mesh(tmp_path, monkeypatch):
    """Put a mesh of the fixtures beside the robot; gives its name."""
    monkeypatch.chdir(tmp_path)

    def put(name, to=""):
        place = tmp_path / (to or name)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(MESHES / name, place)
        return str(place.relative_to(tmp_path))

    return put


def shape(kind, file, scale=""):
    scale = f' scale="{scale}"' if scale else ""
    return f'<{kind}><geometry><mesh filename="{file}"{scale}/></geometry></{kind}>'


def assets(written):
    return [dict(element.attrib) for element in tree(written).find("asset").iter("mesh")]


@pytest.mark.parametrize("name", ["cube.stl", "cube_solid_header.stl"])
def test_what_mujoco_reads_is_copied(write, mesh, name):
    written = export(write("r.urdf", robot(link("a", shape("collision", mesh(name))))))
    content = written.files[f"assets/{name}"]
    assert content.read_bytes() == (MESHES / name).read_bytes()


def test_an_obj_of_one_object_is_copied(write):
    text = "o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    write("a.obj", text)
    written = export(write("r.urdf", robot(link("a", shape("visual", "a.obj")))))
    assert written.files["assets/a.obj"].read_text() == text


@pytest.mark.parametrize("kind", ["visual", "collision"])
def test_a_point_of_no_face_is_not_taken_into_the_hull(write, urdftool, tmp_path, kind):
    faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    write("a.obj", f"o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\n{faces}")
    file = write("r.urdf", robot(link("a", INERTIAL + shape(kind, "a.obj"))))
    assert b"v 5" not in export(file).files["assets/a.obj"]
    pytest.importorskip("mujoco")
    assert urdftool("export", "mjcf", file, "-o", tmp_path / "out", "--verify").code == 0


@pytest.mark.parametrize(
    "name",
    [
        "cube.obj",
        "cube_ascii.stl",
        "cube.ply",
        "cube_binary.ply",
        "cube.dae",
        "cube.glb",
        "trailing_bytes.stl",
    ],
)
@pytest.mark.parametrize("kind", ["visual", "collision"])
def test_the_rest_is_converted_with_its_box(write, mesh, tmp_path, name, kind):
    written = export(write("r.urdf", robot(link("a", shape(kind, mesh(name))))))
    (file,) = [content for path, content in written.files.items() if path.startswith("assets/")]
    assert isinstance(file, bytes)
    (tmp_path / "made.obj").write_bytes(file)
    made, source = load_mesh(tmp_path / "made.obj"), load_mesh(MESHES / name)
    assert np.ptp(made.vertices, axis=0) == pytest.approx(np.ptp(source.vertices, axis=0))
    assert made.vertices.min(axis=0) == pytest.approx(source.vertices.min(axis=0), abs=1e-9)


def test_one_name_for_each_path_and_scale(write, mesh):
    shapes = [
        shape("visual", mesh("cube.stl", "visual/part.stl")),
        shape("visual", mesh("sphere.stl", "other/part.stl")),
        shape("visual", "visual/part.stl", "2 2 2"),
        shape("visual", "visual/part.stl", "2 2 2"),
        shape("collision", mesh("cube_solid_header.stl", "collision/part.stl")),
        shape("collision", "visual/part.stl"),
    ]
    written = export(write("r.urdf", robot(link("a", "".join(shapes)))))
    assert assets(written) == [
        {"file": "part.stl"},
        {"file": "part_other.stl"},
        {"name": "part_1", "file": "part.stl", "scale": "2 2 2"},
        {"file": "part_collision.stl"},
    ]
    used = [geom.get("mesh") for geom in tree(written).iter("geom") if geom.get("mesh")]
    assert used == ["part", "part_other", "part_1", "part_1", "part_collision", "part"]


def test_parts_by_material(write, mesh):
    mesh("cube.mtl")
    found = load_mesh(MESHES / "cube.dae")
    written = export(write("r.urdf", robot(link("a", shape("visual", mesh("cube.dae"))))))
    colors = {part.rgba for part in found.parts}
    assert len(assets(written)) == len(colors)


@pytest.fixture
def painted(write, mesh):
    """The export of a mesh with an image beside it, or in it."""

    def made(name, *, image=True):
        if image:
            mesh("quadrants.png")
        mesh("textured.mtl")
        return export(write("r.urdf", robot(link("a", shape("visual", mesh(name))))))

    return made


@pytest.mark.parametrize("name", ["textured.obj", "textured.dae", "textured.glb"])
def test_the_image_of_a_converted_mesh_is_kept(painted, tmp_path, name):
    written = painted(name)
    model = tree(written)
    (texture,) = model.iter("texture")
    content = written.files[f"assets/{texture.get('file')}"]
    data = content if isinstance(content, bytes) else content.read_bytes()
    assert data == (MESHES / "quadrants.png").read_bytes()
    front, sides = (geom for geom in model.iter("geom") if geom.get("mesh"))
    material = next(m for m in model.iter("material") if m.get("texture"))
    assert front.get("material") == material.get("name")
    # 0.5 of glTF is linear light
    assert sides.get("rgba").startswith("0.73" if name.endswith("glb") else "0.5")
    (tmp_path / "made.obj").write_bytes(written.files["assets/textured_0.obj"])
    made = load_mesh(tmp_path / "made.obj")
    corners = made.vertices[made.faces]
    assert made.parts[0].uv == pytest.approx(corners[..., [0, 2]])
    assert b"vt" not in written.files["assets/textured_1.obj"]


@pytest.mark.parametrize("name", ["textured.obj", "textured.glb"])
def test_an_image_from_the_cache_is_the_same(painted, name):
    assert painted(name).files == painted(name).files


def test_an_image_that_is_not_there_is_said(painted):
    written = painted("textured.dae", image=False)
    assert rules(written) == ["lossy-texture"]
    assert "quadrants.png" in written.losses[0].message


def test_another_picture_becomes_a_png(write, mesh, tmp_path):
    image = pytest.importorskip("PIL.Image")
    image.open(MESHES / "quadrants.png").save(tmp_path / "quadrants.bmp")
    text = (MESHES / "textured.dae").read_text().replace("quadrants.png", "quadrants.bmp")
    write("textured.dae", text)
    written = export(write("r.urdf", robot(link("a", shape("visual", "textured.dae")))))
    assert written.files["assets/quadrants.png"].startswith(b"\x89PNG")


def test_an_image_without_texture_coordinates_is_said(write, mesh, tmp_path):
    mesh("quadrants.png")
    mesh("textured.mtl")
    text = "".join(
        line.replace("/1", "").replace("/2", "").replace("/3", "").replace("/-1", "")
        for line in (MESHES / "textured.obj").read_text().splitlines(keepends=True)
    )
    write("textured.obj", text)
    written = export(write("r.urdf", robot(link("a", shape("visual", "textured.obj")))))
    assert any("no texture coordinates" in loss.message for loss in written.losses)
    assert not list(tree(written).iter("texture"))


def test_flat_collision_is_thickened_and_said(write, mesh, tmp_path):
    written = export(write("r.urdf", robot(link("a", shape("collision", mesh("flat.stl"))))))
    (tmp_path / "made.obj").write_bytes(written.files["assets/flat.obj"])
    thickness = np.ptp(load_mesh(tmp_path / "made.obj").vertices, axis=0).min()
    assert thickness > 0
    [loss] = [loss for loss in written.losses if loss.data.get("note") == "flat-mesh"]
    assert loss.severity is Severity.WARNING


def test_a_note_by_which_nothing_is_lost_is_info(write, mesh):
    written = export(write("r.urdf", robot(link("a", shape("visual", mesh("trailing_bytes.stl"))))))
    assert [loss.severity for loss in written.losses if "note" in loss.data] == [Severity.INFO]


def test_open_visual_is_a_shell(write, mesh):
    written = export(write("r.urdf", robot(link("a", shape("visual", mesh("flat.stl"))))))
    assert assets(written) == [{"file": "flat.stl", "inertia": "shell"}]


def test_hull_is_said_where_it_is_larger(write, mesh):
    pytest.importorskip("scipy")
    written = export(write("r.urdf", robot(link("a", shape("collision", mesh("two_cubes.stl"))))))
    assert "lossy-nonconvex" in rules(written)
    written = export(write("s.urdf", robot(link("a", shape("collision", mesh("cube.stl"))))))
    assert "lossy-nonconvex" not in rules(written)


@pytest.mark.parametrize(("count", "lines"), [(3, 3), (4, 1)])
def test_hulls_of_many_meshes_are_one_warning(urdftool, write, mesh, tmp_path, count, lines):
    pytest.importorskip("scipy")
    shapes = [shape("collision", mesh("two_cubes.stl", f"{n}.stl")) for n in range(count)]
    path = write("r.urdf", robot(link("a", "".join(shapes))))
    words = "export", "mjcf", path, "-o", tmp_path / "out"
    result = urdftool(*words)
    assert result.err.count("[lossy-nonconvex]") == lines
    assert ("(the largest of 4; -v shows all)" in result.err) == (lines == 1)
    assert urdftool("-v", *words).err.count("[lossy-nonconvex]") == count


CUBE = (
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]),
)


def test_a_mesh_is_cut_into_pieces(write, mesh):
    asked = []

    def cutter(paths):
        asked.extend(paths)
        return {path: Cut([CUBE, (CUBE[0] + 2, CUBE[1])], 0.01) for path in paths}

    shapes = [
        shape("visual", mesh("two_cubes.stl")),
        shape("collision", "two_cubes.stl"),
        shape("collision", mesh("cube.stl")),
        shape("collision", mesh("flat.stl")),
    ]
    path = write("r.urdf", robot(link("a", INERTIAL + "".join(shapes))))
    written = export(path, decompose=True, cutter=cutter)
    assert [file.name for file in asked] == ["two_cubes.stl"]  # a cube is its hull
    collisions = [
        geom.get("mesh") for geom in tree(written).iter("geom") if geom.get("class") == "collision"
    ]
    assert collisions == ["two_cubes_collision_0", "two_cubes_collision_1", "cube", "flat"]
    (said,) = (loss for loss in written.losses if loss.code == "lossy-convex")
    assert "2 convex pieces" in said.message
    assert "1.00%" in said.message


def test_a_mesh_that_cannot_be_cut_stays_whole(write, mesh):
    path = write("r.urdf", robot(link("a", shape("collision", mesh("two_cubes.stl")))))
    written = export(
        path, decompose=True, cutter=lambda paths: dict.fromkeys(paths, "it took too long")
    )
    assert assets(written) == [{"file": "two_cubes.stl"}]
    assert any("it took too long" in loss.message for loss in written.losses)


@pytest.mark.slow
def test_decompose_of_the_command(urdftool, write, mesh, tmp_path):
    pytest.importorskip("coacd")
    pytest.importorskip("mujoco")
    path = write("r.urdf", robot(link("a", INERTIAL + shape("collision", mesh("two_cubes.stl")))))
    result = urdftool("export", "mjcf", path, "-o", tmp_path / "out", "--decompose", "--verify")
    assert result.code == 0, result.err
    assert len(list((tmp_path / "out" / "assets").iterdir())) == 2


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("lfs_pointer.stl", "git lfs pull"),
        ("truncated.stl", "truncated"),
        ("empty.stl", "empty"),
        ("nan.stl", "NaN"),
        ("broken.dae", "COLLADA"),
        ("absent.stl", "does not exist"),
    ],
)
def test_a_broken_mesh_is_named(write, mesh, name, word):
    if name != "absent.stl":
        mesh(name)
    path = write("r.urdf", robot("", link("a", shape("visual", name) + shape("collision", name))))
    with pytest.raises(Refused) as caught:
        export(path)
    assert word in caught.value.message
    assert caught.value.line == 2
    written = export(path, force=True)
    assert not [name for name in written.files if name.startswith("assets")]


def test_the_cache_gives_the_same(write, mesh):
    path = write("r.urdf", robot(link("a", shape("visual", mesh("cube.dae")))))
    first, second = export(path), export(path)
    assert first.files == second.files


def test_obj_has_each_point_once():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.1]])
    text = write_obj_bytes(points, np.array([[0, 1, 2], [3, 5, 4]])).decode()
    assert text.count("v ") == 4
    assert text.splitlines()[-2:] == ["f 1 3 2", "f 3 4 2"]


def test_colours_of_a_file_come_before_those_of_the_urdf():
    pieces = convert(MESHES / "cube.dae", collides=False).pieces
    assert any(piece.rgba is not None for piece in pieces)
