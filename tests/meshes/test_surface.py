"""The surfaces of meshes, against the fuller account of ``solid``."""

import pytest

from tests.conftest import FIXTURES
from urdftool.meshes.load import load_mesh
from urdftool.meshes.solid import solid_facts
from urdftool.meshes.surface import hull_volume, surface

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


def test_a_damaged_file_has_no_surface():
    assert surface(FIXTURES / "meshes" / "truncated.stl") is None


def test_hull_of_a_cube_is_the_cube():
    assert hull_volume(FIXTURES / "meshes" / "cube.stl") == pytest.approx(1.0)
    assert hull_volume(FIXTURES / "meshes" / "flat.stl") is None
