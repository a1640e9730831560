"""Closed, consistent, how many bodies, in which unit."""

from pathlib import Path

import numpy as np
import pytest

from urdftool.geometry.load import load_mesh
from urdftool.geometry.topology import explain_unit_suspicion, label_bodies, merge_vertices, weld

FIXTURES = Path(__file__).parents[2] / "fixtures" / "meshes"


@pytest.mark.parametrize(
    ("name", "closed", "bodies"),
    [
        ("cube.stl", True, 1),
        ("inside_out.stl", True, 1),
        ("two_cubes.stl", True, 2),
        ("cavity.stl", True, 2),
        ("open_box.stl", False, 1),
    ],
)
def test_edges_and_bodies(name, closed, bodies):
    mesh = load_mesh(FIXTURES / name)
    _, faces, edges = weld(mesh.vertices, mesh.faces)
    assert (edges.closed, edges.cycle) == (closed, closed)
    assert label_bodies(len(faces), edges).max() + 1 == bodies


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
    assert explain_unit_suspicion(200.0).code == "mesh-in-millimeters"
    assert explain_unit_suspicion(0.0002).code == "mesh-scaled-twice"
    assert explain_unit_suspicion(0.3) is None
