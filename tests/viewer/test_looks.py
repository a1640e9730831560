import io
import shutil

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.drawing.shapes import read_robot_shapes
from urdftool.viewer.render_mesh import compute_link_boxes, list_render_meshes

from .robots import ARM, link, read, urdf


def triangles(vertices, faces):
    corners = np.asarray(vertices, dtype=np.float32)[np.asarray(faces)].reshape(len(faces), -1)
    return np.round(corners[np.lexsort(corners.T)], 6)


def test_the_triangles_are_those_of_the_shapes(tmp_path):
    shapes = read_robot_shapes(read(tmp_path / "r.urdf", ARM))
    looks = list(list_render_meshes(shapes))
    assert {name for name, _ in looks} == {"base", "upper", "lower", "finger", "thumb"}
    assert sum(len(look.faces) for _, look in looks) == len(shapes)
    for name, look in looks:
        row = shapes.links.index(name)
        wanted = shapes.corners[shapes.link == row]
        flat = triangles(wanted.reshape(-1, 3), np.arange(3 * len(wanted)).reshape(-1, 3))
        assert np.array_equal(triangles(look.vertices, look.faces), flat)


def test_edges_are_sharp_and_round_surfaces_share_points(tmp_path):
    round_one = '<visual><geometry><cylinder radius="1" length="1"/></geometry></visual>'
    robot = read(tmp_path / "r.urdf", urdf(link("box"), link("round", round_one)))
    looks = dict(list_render_meshes(read_robot_shapes(robot)))
    assert len(looks["box"].vertices) == 24  # each corner once for each of its three sides
    assert len(looks["round"].vertices) < 1.2 * len(looks["round"].faces)


def test_a_colour_is_a_mesh(tmp_path):
    red = '<material name="red"><color rgba="1 0 0 0.5"/></material>'
    both = (
        f'<visual><geometry><box size="1 1 1"/></geometry>{red}</visual>'
        '<visual><geometry><sphere radius="1"/></geometry></visual>'
    )
    looks = [
        look
        for _, look in list_render_meshes(
            read_robot_shapes(read(tmp_path / "r.urdf", urdf(link("a", both))))
        )
    ]
    assert {(look.rgb, round(look.opacity, 2)) for look in looks} >= {((255, 0, 0), 0.5)}
    assert len(looks) == 2


def test_an_image_comes_as_gltf_that_others_read(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    for name in ("textured.obj", "textured.mtl", "quadrants.png"):
        shutil.copy(FIXTURES / "meshes" / name, tmp_path)
    inside = '<visual><geometry><mesh filename="textured.obj"/></geometry></visual>'
    shapes = read_robot_shapes(read(tmp_path / "r.urdf", urdf(link("a", inside))))
    packed = [look for _, look in list_render_meshes(shapes) if look.glb is not None]
    assert packed, shapes.problems
    loaded = trimesh.load(io.BytesIO(packed[0].glb), file_type="glb", force="mesh", process=False)
    assert len(loaded.faces) == len(packed[0].faces)
    assert np.allclose(
        triangles(loaded.vertices, loaded.faces), triangles(packed[0].vertices, packed[0].faces)
    )
    image = np.asarray(loaded.visual.material.baseColorTexture.convert("RGBA"))
    assert np.array_equal(image[::-1], shapes.images[0])


def test_the_box_around_a_link(tmp_path):
    low, high = compute_link_boxes(read_robot_shapes(read(tmp_path / "r.urdf", ARM)))["upper"]
    assert low.tolist() == pytest.approx([-0.05, -0.05, -0.1])
    assert high.tolist() == pytest.approx([0.05, 0.05, 0.1])
