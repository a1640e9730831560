"""The integrals over a mesh, against exact fractions and against trimesh."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import trimesh

from urdftool.errors import MeshError
from urdftool.inertia.polyhedron import (
    compute_shell_moments,
    compute_signed_volume,
    compute_solid_moments,
)
from urdftool.inertia.solids import box
from urdftool.mechanics.tensor import compute_inertia_from_second_moment, from_matrix, to_matrix
from urdftool.model.pose import rotation_from_rpy

FIXTURES = Path(__file__).parents[2] / "fixtures" / "meshes"


def tetrahedra_sum(vertices, faces):
    """Volume, centroid and ∫ x xᵀ about the centroid, in exact fractions.

    ∫ xᵢ xⱼ over a tetrahedron of volume V is V/20 (Σₖ pₖᵢ pₖⱼ + sᵢ sⱼ), with the origin as its
    fourth corner and s the sum of the corners.
    """
    points = [[Fraction(float(value)) for value in vertex] for vertex in vertices]
    volume = Fraction(0)
    first = [Fraction(0)] * 3
    second = [[Fraction(0)] * 3 for _ in range(3)]
    for face in faces:
        a, b, c = (points[i] for i in face)
        v = (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
        ) / 6
        s = [a[k] + b[k] + c[k] for k in range(3)]
        volume += v
        for i in range(3):
            first[i] += v * s[i] / 4
            for j in range(3):
                products = a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]
                second[i][j] += v * products / 20
    centroid = [f / volume for f in first]
    about = [
        [second[i][j] - volume * centroid[i] * centroid[j] for j in range(3)] for i in range(3)
    ]
    return (
        float(volume),
        np.array([float(c) for c in centroid]),
        np.array([[float(value) for value in row] for row in about]),
    )


def meshes():
    cube = trimesh.creation.box((1, 2, 3))
    sphere = trimesh.creation.icosphere(subdivisions=2, radius=0.3)
    torus = trimesh.creation.torus(0.1, 0.03, major_sections=12, minor_sections=8)
    return {"cube": cube, "sphere": sphere, "torus": torus}


@pytest.mark.parametrize("name", ["cube", "sphere", "torus"])
@pytest.mark.parametrize("offset", [0.0, 1000.0])
def test_equals_exact_fractions(name, offset):
    mesh = meshes()[name]
    turn = np.array(rotation_from_rpy((0.1, 0.5, 0.8)))
    vertices = mesh.vertices @ turn.T + offset
    faces = np.asarray(mesh.faces)
    volume, centroid, second = tetrahedra_sum(vertices, faces)
    moments = compute_solid_moments(vertices, faces)
    assert moments.measure == pytest.approx(volume, rel=1e-12)
    assert compute_signed_volume(vertices, faces) == pytest.approx(volume, rel=1e-12)
    np.testing.assert_allclose(moments.centroid, centroid, atol=1e-12 * max(1, offset))
    np.testing.assert_allclose(moments.second, second, atol=1e-12 * np.abs(second).max())


@pytest.mark.parametrize("name", ["cube", "sphere", "torus"])
def test_equals_trimesh(name):
    mesh = meshes()[name]
    mesh.apply_translation([0.3, -0.2, 0.1])
    body = compute_solid_moments(mesh.vertices, np.asarray(mesh.faces)).with_density(7.0)
    mesh.density = 7.0
    assert body.mass == pytest.approx(mesh.mass, rel=1e-9)
    np.testing.assert_allclose(body.com, mesh.center_mass, rtol=1e-9)
    scale = np.abs(mesh.moment_inertia).max()
    np.testing.assert_allclose(body.inertia, mesh.moment_inertia, atol=1e-9 * scale)


def test_box_by_mass():
    mesh = trimesh.creation.box((1, 2, 3))
    body = compute_solid_moments(mesh.vertices, np.asarray(mesh.faces)).with_mass(5.0)
    np.testing.assert_allclose(body.inertia, box((1, 2, 3), mass=5.0).inertia, atol=1e-12)


def test_shell_of_a_sphere():
    mesh = trimesh.creation.icosphere(subdivisions=5, radius=2.0)
    moments = compute_shell_moments(mesh.vertices + 5, np.asarray(mesh.faces))
    assert moments.measure == pytest.approx(16 * np.pi, rel=1e-3)
    np.testing.assert_allclose(moments.centroid, [5] * 3, atol=1e-9)
    tensor = compute_inertia_from_second_moment(from_matrix(moments.second / moments.measure))
    inertia = to_matrix(tensor)
    np.testing.assert_allclose(inertia, np.eye(3) * 2 / 3 * 4, atol=5e-3)


def test_shell_of_one_triangle_by_its_midpoints():
    # three midpoints with a third of the area each are exact for quadratics
    vertices = np.array([[0.0, 0, 0], [3, 0, 1], [0, 2, 0]])
    moments = compute_shell_moments(vertices, np.array([[0, 1, 2]]))
    middles = (vertices + np.roll(vertices, 1, axis=0)) / 2 - moments.centroid
    np.testing.assert_allclose(moments.second, moments.measure / 3 * middles.T @ middles)


def test_no_volume():
    flat = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    with pytest.raises(MeshError, match="no volume"):
        compute_solid_moments(flat, np.array([[0, 1, 2], [0, 2, 1]]))
    with pytest.raises(MeshError, match="no area"):
        compute_shell_moments(flat * 0, np.array([[0, 1, 2]]))
