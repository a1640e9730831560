"""Whether surfaces of triangles cross, against shapes whose distance is known."""

import numpy as np
import pytest
import trimesh

from urdftool.geometry.tessellate import tessellate
from urdftool.geometry.triangle_contact import find_crossing


def shape(kind, size, at=(0.0, 0.0, 0.0)):
    vertices, faces = tessellate(kind, size, 32)
    return (vertices + np.array(at))[faces]


@pytest.mark.parametrize(
    ("one", "other", "crosses"),
    [
        (shape("box", (1, 1, 1)), shape("box", (1, 1, 1), (0.9, 0.8, 0.7)), True),
        (shape("box", (1, 1, 1)), shape("box", (1, 1, 1), (1.001, 0, 0)), False),
        (shape("box", (1, 1, 1)), shape("box", (0.5, 0.5, 0.5)), False),  # wholly inside
        (shape("sphere", (1,)), shape("sphere", (1,), (1.1, 1.1, 0.9)), True),
        (shape("sphere", (1,)), shape("sphere", (1,), (1.2, 1.2, 1.2)), False),
        (shape("box", (1, 1, 1)), np.zeros((0, 3, 3)), False),
    ],
)
def test_surfaces_cross(one, other, crosses):
    assert find_crossing(one, other) is crosses
    assert find_crossing(other, one) is crosses


@pytest.mark.parametrize(("radius", "crosses"), [(0.69, False), (0.72, True)])
def test_a_rod_through_a_ring_is_within_its_hull_alone(radius, crosses):
    ring = trimesh.creation.torus(1.0, 0.3, major_sections=48, minor_sections=24)
    rod = shape("cylinder", (radius, 3.0))
    assert find_crossing(np.asarray(ring.triangles), rod) is crosses


def test_thousands_of_triangles_are_answered_or_the_answer_is_unknown():
    ball = np.asarray(trimesh.creation.icosphere(4).triangles)
    assert find_crossing(ball, ball + np.array([2.001, 0, 0])) is False
    assert find_crossing(ball, ball + np.array([1.9, 0.1, 0])) is True
    assert find_crossing(ball, 0.97 * ball, most=10) is None


def test_boxes_in_any_pose_cross_if_no_axis_separates_them():
    random = np.random.default_rng(3)
    answers = set()
    for _ in range(60):
        meshes = [trimesh.creation.box(random.uniform(0.5, 1, 3)) for _ in range(2)]
        for mesh in meshes:
            mesh.apply_transform(trimesh.transformations.random_rotation_matrix(random.random(3)))
        meshes[1].apply_translation(random.uniform(-1, 1, 3))
        one, other = (np.asarray(mesh.triangles) for mesh in meshes)
        apart = is_separated(*meshes)
        inside = meshes[0].contains(meshes[1].vertices).all()
        inside |= meshes[1].contains(meshes[0].vertices).all()
        assert find_crossing(one, other) is (not apart and not inside)
        answers.add(apart)
    assert answers == {True, False}


def is_separated(one, other):
    """Tell whether a face normal or a product of two edges separates two boxes."""
    normals = [mesh.face_normals for mesh in (one, other)]
    axes = [*normals[0], *normals[1], *(np.cross(a, b) for a in normals[0] for b in normals[1])]
    for axis in axes:
        a, b = one.vertices @ axis, other.vertices @ axis
        if np.linalg.norm(axis) > 1e-6 and (a.max() < b.min() or b.max() < a.min()):
            return True
    return False
