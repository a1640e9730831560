"""Colours, images and normals as the files mean them."""

from io import BytesIO

import numpy as np
import pytest

from urdftool.drawing.materials import PLAIN
from urdftool.drawing.normals import compute_corner_normals
from urdftool.drawing.shapes import read_robot_shapes
from urdftool.drawing.texture import read_texture, sample_texture
from urdftool.errors import MeshError
from urdftool.geometry.tessellate import tessellate

from .robots import link, mask, read, seen, visual

QUAD = (
    "mtllib q.mtl\nv 0 -0.5 -0.5\nv 0 0.5 -0.5\nv 0 0.5 0.5\nv 0 -0.5 0.5\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n"
)
MESH = '<geometry><mesh filename="{}"/></geometry>'


def image_bytes(pixels, form="PNG"):
    from PIL import Image

    data = BytesIO()
    Image.fromarray(np.array(pixels, dtype=np.uint8)).save(data, form)
    return data.getvalue()


def quad(folder, mtl, image=None):
    (folder / "q.obj").write_text(QUAD)
    (folder / "q.mtl").write_text(f"newmtl m\n{mtl}\n")
    if image is not None:
        (folder / "t.png").write_bytes(image_bytes(image))


def colors(robot):
    return [tuple(np.round(c, 3)) for c in np.unique(read_robot_shapes(robot).colors, axis=0)]


def named(name, rgba=""):
    color = f'<color rgba="{rgba}"/>' if rgba else ""
    return f'<material name="{name}">{color}</material>'


def test_without_a_material_it_is_plain(tmp_path):
    assert colors(read(tmp_path, link("a", visual()))) == [PLAIN]
    assert colors(read(tmp_path, link("a", visual(material=named("nobody"))))) == [PLAIN]


def test_a_name_means_its_first_definition(tmp_path):
    robot = read(
        tmp_path,
        link("a", visual(material=named("m", "0 1 0 1"))),
        link("b", visual(material=named("n", "0 0 1 1"))),
        link("c", visual(material=named("m")), visual(material=named("n"))),
        named("m", "1 0 0 1"),
    )
    assert colors(robot) == [(0, 0, 1, 1), (1, 0, 0, 1)]


def test_colours_out_of_range_are_cut(tmp_path):
    assert colors(read(tmp_path, link("a", visual(rgba="255 -1 0.5 2")))) == [(1, 0, 0.5, 1)]


def test_a_mesh_s_own_colour_comes_before_the_material(tmp_path):
    quad(tmp_path, "Kd 0.1 0.2 0.3\nd 0.5")
    robot = read(tmp_path, link("a", visual(MESH.format("q.obj"), "1 0 0 1")))
    assert colors(robot) == [(0.1, 0.2, 0.3, 0.5)]


def test_a_mesh_without_colour_has_the_material_s(tmp_path):
    (tmp_path / "t.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    robot = read(tmp_path, link("a", visual(MESH.format("t.obj"), "0.5 0.25 1 1")))
    assert colors(robot) == [(0.5, 0.25, 1, 1)]


def test_an_image_lies_as_its_coordinates_say(tmp_path):
    red, green, blue, white = [255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]
    big = np.kron(np.array([[red, green], [blue, white]]), np.ones((32, 32, 1)))
    quad(tmp_path, "Kd 0 0 0\nmap_Kd t.png", big)
    image = seen(read(tmp_path, link("a", visual(MESH.format("q.obj"))))).astype(int)
    # the quad fills rows and columns 50 … 150; an image's first row is its upper edge
    assert np.argmax(image[70, 70]) == 0
    assert np.argmax(image[70, 130]) == 1
    assert np.argmax(image[130, 70]) == 2
    assert np.ptp(image[130, 130]) < 10


def test_a_missing_image_is_said_and_the_colour_kept(tmp_path):
    quad(tmp_path, "Kd 0 1 0\nmap_Kd t.png")
    shapes = read_robot_shapes(read(tmp_path, link("a", visual(MESH.format("q.obj")))))
    (problem,) = shapes.problems
    assert "r.urdf:1:" in str(problem)
    assert "t.png" in str(problem)
    assert tuple(shapes.colors[0]) == (0, 1, 0, 1)


def test_an_image_that_is_none_is_said(tmp_path):
    with pytest.raises(MeshError, match="cannot be read"):
        read_texture(b"no image")
    with pytest.raises(MeshError, match="does not exist"):
        read_texture(tmp_path / "gone.png")


def test_images_repeat_and_mix():
    texels = read_texture(image_bytes([[[0, 0, 0], [255, 255, 255]]]))
    at = np.array([[0.25, 0.5], [0.75, 0.5], [0.5, 0.5], [1.25, -3.5], [np.nan, np.inf]])
    assert sample_texture(texels, at)[:4, 0] == pytest.approx([0, 1, 0.5, 0])
    assert np.isfinite(sample_texture(texels, at)).all()


def test_normals_of_a_sphere_point_outwards():
    vertices, faces = tessellate("sphere", (2.0,), 64)
    outwards = vertices[faces] / 2.0
    dots = np.einsum("mij,mij->mi", compute_corner_normals(vertices, faces), outwards)
    assert np.quantile(dots, 0.03) > 0.999  # but at the poles, where very many faces meet
    assert dots.min() > 0.99


def test_normals_of_a_box_are_its_faces():
    vertices, faces = tessellate("box", (1.0, 2.0, 3.0))
    normals = compute_corner_normals(vertices, faces)
    assert np.allclose(np.sort(np.abs(normals), axis=2), [0, 0, 1])


def test_normals_of_a_cylinder_are_smooth_around_and_sharp_at_the_rim():
    vertices, faces = tessellate("cylinder", (1.0, 1.0), 48)
    normals = compute_corner_normals(vertices, faces).reshape(-1, 3)
    corners = vertices[faces].reshape(-1, 3)
    side = np.abs(normals[:, 2]) < 0.5
    assert np.allclose(np.abs(normals[~side, 2]), 1, atol=1e-9)
    radial = corners[side] * [1, 1, 0]
    assert np.einsum("ij,ij->i", normals[side], radial).min() > 0.999


def test_degenerate_faces_have_no_normal_and_do_no_harm():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0], [0, 0, 0]], dtype=float)
    normals = compute_corner_normals(vertices, np.array([[0, 1, 2], [0, 1, 3], [0, 0, 4]]))
    assert np.isfinite(normals).all()
    assert np.allclose(normals[0], [0, 0, 1])


def test_shapes_that_are_no_numbers_are_said_and_left_out(tmp_path):
    robot = read(
        tmp_path,
        link(
            "a",
            visual(),
            visual('<geometry><box size="1e200 1 1"/></geometry>'),
            visual('<geometry><box size="0 0 0"/></geometry>'),
            visual(xyz="1e200 0 0"),
            visual('<geometry><sphere radius="inf"/></geometry>'),
        ),
    )
    shapes = read_robot_shapes(robot)
    assert len(shapes) == 12
    assert all("r.urdf:1:" in str(problem) for problem in shapes.problems)
    assert len(shapes.problems) == 2
    assert mask(seen(robot)).sum() == pytest.approx(100**2, rel=0.03)


def test_one_mesh_is_read_once_and_its_trouble_said_at_each_use(tmp_path, monkeypatch):
    from urdftool.geometry import load as loading

    (tmp_path / "t.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    reads = []
    read_mesh = loading.load_mesh
    monkeypatch.setattr(loading, "load_mesh", lambda *a, **k: reads.append(a) or read_mesh(*a, **k))
    uses = [visual(MESH.format(name)) for name in ("t.obj", "gone.stl") * 3]
    told = []
    robot = read(tmp_path, *(link(str(n), use) for n, use in enumerate(uses)))
    shapes = read_robot_shapes(robot, progress=lambda *words: told.append(words))
    assert len(reads) == 2
    assert len(shapes.problems) == 3
    assert len(shapes) == 3
    assert told == [(1, 2, "t.obj"), (2, 2, "gone.stl")]


def test_shapes_with_nothing_in_them(tmp_path):
    robot = read(tmp_path, link("a", visual("<geometry><cone/></geometry>"), "<visual/>"))
    assert len(read_robot_shapes(robot)) == 0
    flat = read(tmp_path, link("a", visual('<geometry><box size="0 1 1"/></geometry>')))
    assert mask(seen(flat)).sum() == pytest.approx(100**2, rel=0.03)
