"""Primitives given as noisy meshes come back, from millimetres to ten metres, however they lie."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from tests.collision.shapes import noisy, turned
from urdftool.collision.choose import choose
from urdftool.collision.settings import Settings
from urdftool.collision.surface import prepare

SHAPES = [
    ("box", (1.0, 1.0, 1.0)),
    ("box", (5.0, 4.0, 0.4)),
    ("cylinder", (1.0, 0.3)),
    ("cylinder", (0.3, 3.0)),
    ("capsule", (1.0, 0.4)),
    ("capsule", (0.2, 3.0)),
    ("sphere", (1.0,)),
]


def found_in(vertices, faces, kind):
    (piece,) = choose(prepare(vertices, faces), Settings()).pieces
    assert piece.kind == kind
    return np.sort(piece.size) if kind == "box" else np.array(piece.size)


@pytest.mark.slow
@pytest.mark.parametrize(("scale", "noise"), [(1e-3, 0.001), (0.03, 0.002), (10.0, 0.0015)])
@pytest.mark.parametrize(("kind", "shape"), SHAPES)
def test_a_primitive_comes_back(kind, shape, scale, noise):
    size = np.array(shape) * scale
    rng = np.random.default_rng(17)
    mesh = noisy(
        kind, tuple(size), noise=noise, rotation=turned(rng), center=4 * scale * rng.random(3)
    )
    wanted = np.sort(size) if kind == "box" else size
    assert found_in(*mesh, kind) == pytest.approx(wanted, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_a_sphere_of_uneven_triangles_is_no_capsule(seed):
    points = np.random.default_rng(seed).normal(size=(1200, 3))
    points *= 0.4 / np.linalg.norm(points, axis=1)[:, None]
    triangles = ConvexHull(points).simplices.astype(np.int64)
    assert found_in(points, triangles, "sphere") == pytest.approx([0.4], rel=0.01)
