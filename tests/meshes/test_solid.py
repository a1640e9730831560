"""Closed, consistent, outwards, how many bodies, in which unit."""

from pathlib import Path

import numpy as np
import pytest

from urdftool.meshes.load import load_mesh
from urdftool.meshes.solid import merge_vertices, solid_facts, unit_suspicion, weld

FIXTURES = Path(__file__).parents[2] / "fixtures" / "meshes"


@pytest.mark.parametrize(
    ("name", "closed", "inside_out", "bodies", "volume"),
    [
        ("cube.stl", True, False, 1, 1.0),
        ("inside_out.stl", True, True, 1, -1.0),
        ("two_cubes.stl", True, False, 2, 2.0),
        ("cavity.stl", True, False, 2, 0.875),
        ("open_box.stl", False, False, 1, None),
    ],
)
def test_facts(name, closed, inside_out, bodies, volume):
    mesh = load_mesh(FIXTURES / name)
    facts = solid_facts(mesh.vertices, mesh.faces)
    assert (facts.closed, facts.inside_out, facts.bodies) == (closed, inside_out, bodies)
    if volume is not None:
        assert facts.volume == pytest.approx(volume, abs=1e-12)


def test_degenerate_faces_are_counted():
    mesh = load_mesh(FIXTURES / "flat.stl")
    assert solid_facts(mesh.vertices, mesh.faces).degenerate == 8


def test_zero_and_minus_zero_are_one_point():
    vertices = np.array([[0.0, 0, 0], [-0.0, 0, 0], [1, 0, 0]])
    points, faces = merge_vertices(vertices, np.array([[0, 1, 2]]))
    assert len(points) == 2
    assert faces.tolist() == [[0, 0, 1]]


def test_rounded_copies_are_welded_where_that_closes_the_surface():
    mesh = load_mesh(FIXTURES / "sphere.stl")
    shaken = mesh.vertices + np.random.default_rng(0).uniform(-1e-8, 1e-8, mesh.vertices.shape)
    points, _, edges = weld(shaken, mesh.faces)
    assert edges.cycle
    assert len(points) == 642


def test_unit_suspicion():
    assert "millimetre" in unit_suspicion(200.0)
    assert "twice" in unit_suspicion(0.0002)
    assert unit_suspicion(0.3) is None
