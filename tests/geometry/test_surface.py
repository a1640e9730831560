"""The surfaces of mesh files."""

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.geometry.surface import compute_hull_volume, measure_surface, read_surface


@pytest.mark.parametrize(
    ("name", "open_edges", "inside_out", "flat", "volume"),
    [
        ("cube.stl", 0, False, 0, 1.0),
        ("cube_ascii.stl", 0, False, 0, 1.0),
        ("cube.obj", 0, False, 0, 2.0),
        ("inside_out.stl", 0, True, 0, -1.0),
        ("two_cubes.stl", 0, False, 0, 2.0),
        ("cavity.stl", 0, False, 0, 0.875),
        ("open_box.stl", 4, False, 0, None),
    ],
)
def test_surface_of_a_file(name, open_edges, inside_out, flat, volume):
    found = read_surface(FIXTURES / "meshes" / name)
    assert (found.open_edges, found.inside_out, found.flat) == (open_edges, inside_out, flat)
    if volume is not None:
        assert found.volume == pytest.approx(volume, abs=1e-12)


def test_flat_faces_are_counted():
    assert read_surface(FIXTURES / "meshes" / "flat.stl").flat == 8


def test_rounded_copies_of_a_point_are_one_point():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    assert measure_surface(corners, faces) == (4, 0, 0, True, pytest.approx(1 / 6), 1.0)
    off = np.concatenate([corners[face] + 1e-8 * (n - 2) for n, face in enumerate(faces)])
    assert measure_surface(off, np.arange(12).reshape(-1, 3))[:4] == (4, 0, 0, True)
    assert measure_surface(corners, faces[1:]).open_edges == 3


def test_a_damaged_file_has_no_surface():
    assert read_surface(FIXTURES / "meshes" / "truncated.stl") is None


def test_hull_of_a_cube_is_the_cube():
    assert compute_hull_volume(FIXTURES / "meshes" / "cube.stl") == pytest.approx(1.0)
    assert compute_hull_volume(FIXTURES / "meshes" / "flat.stl") is None
