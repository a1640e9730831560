"""The surfaces of meshes, against the fuller account of ``solid``."""

import pytest

from tests.conftest import FIXTURES
from urdftool.meshes import surface as module
from urdftool.meshes.load import load_mesh
from urdftool.meshes.solid import solid_facts
from urdftool.meshes.surface import surface, surface_of
from urdftool.meshes.surface_arrays import hull_volume, surface_by_arrays

NAMES = ["cube.stl", "cube_ascii.stl", "cavity.stl", "inside_out.stl", "nested_same_way.stl"]
NAMES += ["open_box.stl", "sphere.stl", "two_cubes.stl", "cube.obj", "flat.stl"]


@pytest.mark.parametrize("name", NAMES)
def test_it_agrees_with_the_fuller_account(name):
    path = FIXTURES / "meshes" / name
    found = surface(path)
    mesh = load_mesh(path)
    facts = solid_facts(mesh.vertices, mesh.faces)
    assert (found.open_edges == 0) == facts.closed
    assert found.inside_out == facts.inside_out
    assert found.flat == facts.degenerate
    if facts.closed:
        assert found.volume == pytest.approx(facts.volume)


@pytest.mark.parametrize("name", [name for name in NAMES if name != "cube_ascii.stl"])
def test_plain_python_and_numpy_say_the_same(name, monkeypatch):
    monkeypatch.setattr(module, "is_much", lambda _: False)
    monkeypatch.setattr("urdftool.meshes.surface_arrays.surface_by_arrays", None)
    plain = surface(FIXTURES / "meshes" / name)
    monkeypatch.undo()
    other = surface_by_arrays(FIXTURES / "meshes" / name)
    assert plain[:4] == other[:4]
    if not other.open_edges:
        assert plain.volume == pytest.approx(other.volume)


def test_rounded_copies_of_a_point_are_one_point():
    corner = {k: tuple(float(k >> axis & 1) for axis in range(3)) for k in (0, 1, 2, 4)}
    faces = [(0, 2, 1), (0, 1, 4), (0, 4, 2), (1, 2, 4)]
    whole = surface_of([tuple(corner[k] for k in face) for face in faces])
    assert whole == (4, 0, 0, True, pytest.approx(1 / 6))
    off = [
        tuple(tuple(x + 1e-8 * (n - 2) for x in corner[k]) for k in face)
        for n, face in enumerate(faces)
    ]
    welded = surface_of(off)
    assert welded[:4] == (4, 0, 0, True)
    assert surface_of([tuple(corner[k] for k in face) for face in faces[1:]]).open_edges == 3


def test_a_damaged_file_has_no_surface():
    assert surface(FIXTURES / "meshes" / "truncated.stl") is None


def test_hull_of_a_cube_is_the_cube():
    assert hull_volume(FIXTURES / "meshes" / "cube.stl") == pytest.approx(1.0)
    assert hull_volume(FIXTURES / "meshes" / "flat.stl") is None
