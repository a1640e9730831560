"""The outermost points of meshes: the same box as that of the triangles, and as far out."""

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.meshes.load import load_mesh
from urdftool.meshes.outline import extremes, outline, reach_of

SOUND = ["cube.dae", "cube.glb", "cube.obj", "cube.ply", "cube.stl", "cube_ascii.stl"]
SOUND += ["inch_y_up.dae", "instances.dae", "sphere.stl", "two_cubes.stl", "trailing_bytes.stl"]


@pytest.mark.parametrize("name", SOUND)
def test_box_is_that_of_the_triangles(name):
    points = outline(FIXTURES / "meshes" / name)
    mesh = load_mesh(FIXTURES / "meshes" / name)
    corners = mesh.vertices[mesh.faces].reshape(-1, 3)
    np.testing.assert_allclose(points.min(axis=0), corners.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(points.max(axis=0), corners.max(axis=0), atol=1e-6)


@pytest.mark.parametrize(
    "name",
    [
        *("empty.stl", "lfs_pointer.stl", "truncated.stl", "nan.stl", "broken.dae"),
        *("entities.dae", "huge_claim.stl", "no_such_file.stl"),
    ],
)
def test_a_damaged_file_says_nothing(name):
    assert outline(FIXTURES / "meshes" / name) is None


def test_few_of_many_points_reach_nearly_as_far():
    rng = np.random.default_rng(0)
    points = rng.normal(size=(50_000, 3))
    points *= (3, 2, 1) / np.linalg.norm(points, axis=1, keepdims=True)
    kept = extremes(points)
    assert len(kept) < 200
    ways = rng.normal(size=(300, 3))
    far, near = (points @ ways.T).max(axis=0), (kept @ ways.T).max(axis=0)
    assert (near <= far + 1e-9).all()
    assert (near > 0.9 * far).all()


def test_support_function_reaches_from_the_middle():
    corners = np.array([[x, y, z] for x in (0, 2) for y in (0, 4) for z in (0, 6)], dtype=float)
    middle, radius, reach = reach_of(corners)
    assert middle == (1, 2, 3)
    assert radius == pytest.approx(np.sqrt(14))
    assert reach(1, 0, 0) == 1
    assert reach(0, 0, -1) == 3
