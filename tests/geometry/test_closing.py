"""How much closing the holes of a mesh changes what MuJoCo computes of it."""

import struct

import numpy as np
import pytest

from urdftool.geometry.surface import change_by_closing

X, Y, Z = np.eye(3)
QUADS = [
    (o, a, b)
    for o, a, b in ((0 * X, Y, X), (Z, X, Y), (0 * X, X, Z), (Y, Z, X), (0 * X, Z, Y), (X, Y, Z))
]


def cube(parts=4):
    """The outward triangles of a unit cube, each side in parts × parts squares."""
    found = []
    for corner, one, two in QUADS:
        for i in range(parts):
            for j in range(parts):
                a = corner + (i * one + j * two) / parts
                b, c, d = a + one / parts, a + (one + two) / parts, a + two / parts
                found += [(a, b, c), (a, c, d)]
    return np.array(found)


def written(path, triangles, stretch=(1, 1, 1)):
    rows = [struct.pack("<12fH", 0, 0, 0, *(t * stretch).reshape(-1), 0) for t in triangles]
    path.write_bytes(b"cube".ljust(80) + struct.pack("<I", len(rows)) + b"".join(rows))
    return path


def test_a_closed_mesh_does_not_change(tmp_path):
    assert change_by_closing(written(tmp_path / "a.stl", cube())) == pytest.approx(0, abs=1e-12)


def test_an_open_side_changes_by_what_is_missing(tmp_path):
    without_lid = [t for t in cube() if not (t[:, 2] == 1).all()]
    path = written(tmp_path / "a.stl", without_lid)
    # pyramids from the mean of the surface, 0.4 high, to the five sides have their center at h
    h = (0.4 / 3 * 0.1 + 2 / 3 * 0.475) / (0.4 / 3 + 2 / 3)
    volume = h / 3 + 2 / 3
    second = h**3 / 5 + 4 * 0.5 / 5 * (1 / 12 + (0.5 - h) ** 2)  # along z, about h
    assert change_by_closing(path) == pytest.approx(1 - second / volume * 12)


def test_a_small_hole_changes_little(tmp_path):
    triangles = cube(32)
    path = written(tmp_path / "a.stl", triangles[1:])
    assert 0 < change_by_closing(path) < 0.001


def test_two_holes_are_closed_each_by_itself(tmp_path):
    sides = [t for t in cube(8) if not (np.ptp(t[:, 2]) == 0 and t[0, 2] in (0, 1))]
    # a third of the volume is missing; one fan over both would add nothing to it
    path = written(tmp_path / "tube.stl", sides, (1, 1, 5))
    assert change_by_closing(path) == pytest.approx(0.4)


def test_what_is_flat_has_no_volume_to_compare_with(tmp_path):
    lid = [t for t in cube() if (t[:, 2] == 1).all()]
    assert change_by_closing(written(tmp_path / "a.stl", lid)) == float("inf")


def test_what_cannot_be_read_is_not_compared(tmp_path):
    (tmp_path / "a.stl").write_bytes(b"nothing")
    assert change_by_closing(tmp_path / "a.stl") is None
