"""The outermost points of meshes: the same box as that of the triangles, and as far out."""

import json
import os
from base64 import b64encode
from threading import Thread

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.errors import MeshError
from urdftool.geometry.convex_points import (
    ConvexPoints,
    drop_repeated,
    read_convex_points,
    select_extreme_points,
    support_function_of,
)
from urdftool.geometry.load import load_mesh

SOUND = ["cube.dae", "cube.glb", "cube.obj", "cube.ply", "cube.stl", "cube_ascii.stl"]
SOUND += ["inch_y_up.dae", "instances.dae", "sphere.stl", "two_cubes.stl", "trailing_bytes.stl"]


@pytest.mark.parametrize("name", SOUND)
def test_box_is_that_of_the_triangles(name):
    found = read_convex_points(FIXTURES / "meshes" / name)
    mesh = load_mesh(FIXTURES / "meshes" / name)
    corners = mesh.vertices[mesh.faces].reshape(-1, 3)
    box = corners.min(axis=0), corners.max(axis=0)
    np.testing.assert_allclose((found.low, found.high), box, atol=1e-6)
    points = np.array(found.points)
    np.testing.assert_allclose((points.min(axis=0), points.max(axis=0)), box, atol=1e-6)


QUARTER = ((0.0, -1.0, 6e-17), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
TILTED = ((0.36, 0.48, -0.8), (-0.8, 0.6, 0.0), (0.48, 0.64, 0.6))


@pytest.mark.parametrize("rotation", [QUARTER, TILTED])
def test_box_of_a_mesh_that_is_scaled_turned_and_moved(rotation):
    found = read_convex_points(FIXTURES / "meshes" / "instances.dae")
    mesh = load_mesh(FIXTURES / "meshes" / "instances.dae", (2.0, -1.0, 0.5))
    corners = mesh.vertices[mesh.faces].reshape(-1, 3) @ np.array(rotation).T + (1, 2, 3)
    box = found.compute_box((2.0, -1.0, 0.5), rotation, (1.0, 2.0, 3.0))
    np.testing.assert_allclose(box, (corners.min(axis=0), corners.max(axis=0)), atol=1e-6)


@pytest.mark.parametrize(
    "name",
    [
        *("empty.stl", "lfs_pointer.stl", "truncated.stl", "nan.stl", "broken.dae"),
        *("entities.dae", "huge_claim.stl", "no_such_file.stl"),
    ],
)
def test_a_damaged_file_says_nothing(name):
    assert read_convex_points(FIXTURES / "meshes" / name) is None


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name")
@pytest.mark.parametrize("name", ["pipe.stl", "zeros.obj", "beside.gltf"])
def test_what_never_ends_is_no_mesh(name, tmp_path):
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "zeros.obj").symlink_to("/dev/zero")
    points = {"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}
    tree = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 12, "uri": "pipe.stl"}],
        "bufferViews": [{"buffer": 0, "byteLength": 12}],
        "accessors": [points],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
    }
    (tmp_path / "beside.gltf").write_text(json.dumps(tree))
    found = []
    reading = Thread(target=lambda: found.append(read_convex_points(tmp_path / name)), daemon=True)
    reading.start()
    reading.join(5)
    assert found == [None]
    with pytest.raises(MeshError, match=r"a device or a pipe|'pipe.stl' is not a file"):
        load_mesh(tmp_path / name)


@pytest.mark.parametrize("count", [300, 5_000, 60_000])
def test_few_of_many_points_reach_nearly_as_far(count):
    rng = np.random.default_rng(0)
    points = rng.normal(size=(count, 3))
    points *= (3, 2, 1) / np.linalg.norm(points, axis=1, keepdims=True)
    kept = np.array(select_extreme_points(points))
    assert len(kept) < 200
    ways = rng.normal(size=(300, 3))
    far, near = (points @ ways.T).max(axis=0), (kept @ ways.T).max(axis=0)
    assert (near <= far + 1e-9).all()
    assert (near > (0.9 if count > 1_000 else 0.8) * far).all()
    whole = ConvexPoints(points)
    np.testing.assert_allclose((whole.low, whole.high), (points.min(axis=0), points.max(axis=0)))


def test_many_triangles_reach_as_far_as_their_points():
    """Of a mesh with each position six times, as an STL file of it has."""
    rng = np.random.default_rng(0)
    points = rng.normal(size=(10_000, 3))
    whole = ConvexPoints(rng.permutation(np.repeat(points, 6, axis=0)))
    for way in rng.normal(size=(50, 3)):
        found = whole.find_outermost((1.0, 2.0, 3.0), way)
        assert np.dot(found, way) == pytest.approx((points * (1, 2, 3) @ way).max(), abs=1e-12)
    low, high = whole.compute_box((1.0, 1.0, 1.0), TILTED, (0.0, 0.0, 0.0))
    turned = points @ np.array(TILTED).T
    np.testing.assert_allclose((low, high), (turned.min(axis=0), turned.max(axis=0)), atol=1e-12)


def test_repeated_points_are_dropped_and_the_others_keep_their_order():
    points = np.array([[1, 2, 3], [0, 0, 0], [1, 2, 3], [3, 2, 1], [-0.0, 0, 0], [1, 2, 4.0]])
    np.testing.assert_array_equal(drop_repeated(points), points[[0, 1, 3, 5]])


def test_support_function_reaches_from_the_middle():
    corners = [(x, y, z) for x in (0, 2) for y in (0, 4) for z in (0, 6)]
    middle, radius, reach = support_function_of(corners)
    assert middle == (1, 2, 3)
    assert radius == pytest.approx(np.sqrt(14))
    assert reach(1, 0, 0) == 1
    assert reach(0, 0, -1) == 3


def test_a_gltf_scene_of_which_one_node_is_moved(tmp_path):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype="<f4").tobytes()
    data = "data:application/octet-stream;base64," + b64encode(corners).decode()
    tree = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 36, "uri": data}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}],
        "scenes": [{"nodes": [0, 1]}],
    }
    path = tmp_path / "two.gltf"
    path.write_text(json.dumps(tree))
    found = read_convex_points(path, "z")
    assert (found.low, found.high) == ((0.0, 0.0, 0.0), (6.0, 1.0, 0.0))
