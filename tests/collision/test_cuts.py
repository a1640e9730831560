"""Plane cuts: the outline of a mesh, its partition, and pieces within an error and a number."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, QhullError

from tests.collision.shapes import finer, l_profile, noisy
from urdftool.collision.choose import choose
from urdftool.collision.convex import compute_hull
from urdftool.collision.cuts import PlaneCutter
from urdftool.collision.distance import Surface, spread
from urdftool.collision.measure import ReferenceSurface
from urdftool.collision.outline import TRIANGLES, compute_outline
from urdftool.collision.partition import clip
from urdftool.collision.piece import make_primitive
from urdftool.collision.settings import QUALITIES, Settings
from urdftool.collision.surface import prepare


def housing():
    """A box with a sphere inside it that nothing can touch."""
    outer, faces = noisy("box", (0.3, 0.2, 0.1))
    inner, more = noisy("sphere", (0.03,))
    return prepare(np.concatenate([outer, inner]), np.concatenate([faces, more + len(outer)]))


def stairs(count):
    """Boxes of increasing height side by side."""
    made = [
        make_primitive(
            "box", (0.05, 0.1, 0.03 * (k + 1)), np.eye(3), (0.05 * k, 0, 0.015 * (k + 1))
        )
        for k in range(count)
    ]
    corners = np.concatenate([box.corners for box in made]).reshape(-1, 3)
    return prepare(corners, np.arange(len(corners)).reshape(-1, 3))


def test_the_outline_is_near_and_without_interior():
    surface = housing()
    target = ReferenceSurface(surface)
    vertices, faces = compute_outline(target)
    assert len(faces) <= TRIANGLES
    assert np.abs(vertices).max(axis=0) == pytest.approx((0.15, 0.1, 0.05), abs=0.003)
    assert (np.linalg.norm(vertices, axis=1) > 0.045).all()
    found = Surface(vertices[faces], spread(vertices[faces], 20_000))
    assert found.measure_distance(target.exterior_samples).max() < 0.02 * surface.size


def test_a_sheet_without_thickness_remains():
    a, b, c = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.3, 0.0]])
    surface = prepare(np.array([a, b, c, b + c]), np.array([[0, 1, 2], [1, 3, 2]]))
    vertices, faces = compute_outline(ReferenceSurface(surface))
    assert np.ptp(vertices, axis=0) == pytest.approx((0.3, 0.3, 0.0), abs=0.01)
    assert len(faces) > 10


def test_clipping_keeps_what_is_below_the_plane():
    box = make_primitive("box", (2.0, 2.0, 2.0), np.eye(3), (0, 0, 0))
    plane = np.array([0.6, 0, 0.8, 0.2])
    points, faces = clip(box.vertices, box.faces, plane)
    assert (points @ plane[:3] - plane[3]).max() == pytest.approx(0, abs=1e-12)
    above, others = clip(box.vertices, box.faces, -plane)
    areas = [
        np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1).sum() / 2
        for t in (points[faces], above[others])
    ]
    assert sum(areas) == pytest.approx(24)


def areas_and_normals(corners):
    """Area of each triangle, and normal of that length."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    return np.linalg.norm(normal, axis=1), normal


@pytest.mark.parametrize("axis", [0, 1])
def test_a_face_in_the_plane_belongs_to_its_solid(axis):
    vertices, faces = l_profile()
    plane = np.append(np.eye(3)[axis], 0.05)  # in which one leg ends
    noise = np.random.default_rng(1).normal(0, 1e-12, vertices.shape)
    total = 0.0
    for side in (plane, -plane):
        points, kept = clip(vertices + noise, faces, side, 1e-9)
        area, normal = areas_and_normals(points[kept])
        assert area.min() > 1e-6
        flat = np.abs(points[kept] @ side[:3] - side[3]).max(axis=1) < 1e-9
        assert (normal[flat] @ side[:3] > 0).all()
        total += area.sum()
    assert total == pytest.approx(areas_and_normals(vertices[faces])[0].sum())


def test_cuts_through_the_same_points_do_not_multiply_triangles():
    points, faces = noisy("box", (0.3, 0.2, 0.1))
    before = len(faces)
    random = np.random.default_rng(2)
    for _ in range(20):
        normal = np.array([0.6, 0, 0.8]) + random.normal(0, 1e-13, 3)
        points, faces = clip(points, faces, np.append(normal, 0.03), 1e-9)
    assert len(faces) < 2 * before


def test_a_hull_with_facets_that_qhull_finds_too_wide():
    y, z = (-0.16967401679506897, -0.16967401678750763), 0.03663993934611936
    points = [
        (-0.05576687540312109, y[0], 0.062105389472597146), (0.011249977000942607, y[0], z),
        (0.011249977000942607, y[1], 0.03673185805495809),
        (0.011238709725432859, y[1], 0.03663995523273686),
        (0.011249977000942607, y[1], 0.03663993934612712),
        (-0.05576687539830151, y[1], 0.062105389474508256),
        (-0.05576687519050419, y[0], 0.06210538943691654),
    ]  # fmt: skip
    with pytest.raises(QhullError):
        ConvexHull(np.array(points))
    vertices, faces = compute_hull(np.array(points))
    assert min(len(vertices), len(faces)) >= 4


@pytest.mark.slow
def test_the_fewest_pieces_within_the_error_are_taken():
    surface = stairs(6)
    counts = [
        len(choose(surface, Settings(method="cuts", max_error=e)).pieces) for e in (0.2, 0.05, 0.01)
    ]
    assert counts[0] < counts[1] < counts[2] <= 12


@pytest.mark.slow
@pytest.mark.parametrize("most", [1, 2, 3])
def test_the_smallest_error_of_the_budget(most):
    choice = choose(stairs(6), Settings(method="cuts", max_error=0.001, max_hulls=most))
    assert len(choice.pieces) == most
    assert choice.measures.error < {1: 0.2, 2: 0.1, 3: 0.07}[most]
    (note,) = choice.notes
    assert note.data["pieces"] == 2 * most
    assert note.data["error"] <= choice.measures.error


@pytest.mark.slow
def test_twice_the_pieces_give_about_what_was_forecast():
    surface = stairs(8)
    one, two = (
        choose(surface, Settings(method="cuts", max_error=0.001, max_hulls=n)) for n in (2, 4)
    )
    assert two.measures.error == pytest.approx(one.notes[0].data["error"], rel=0.5)


def test_pieces_are_the_same_with_any_number_of_cores():
    surface = prepare(*finer(*l_profile()))
    one, many = (choose(surface, Settings(), cores) for cores in (1, 3))
    assert [piece.as_dict() for piece in one.pieces] == [piece.as_dict() for piece in many.pieces]
    assert one.measures == many.measures


def test_a_flat_surface_has_no_part():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
    surface = prepare(corners, np.array([[0, 1, 2]]))
    cutter = PlaneCutter(ReferenceSurface(surface), 64, QUALITIES["fast"])
    cutter.__dict__["whole"] = None
    assert cutter.decompose(0.05, 4) is None


def test_a_quality_brings_its_limits_unless_they_are_given():
    fast = Settings().replace_some({"quality": "fast"})
    assert (fast.max_error, fast.most) == (0.08, 4)
    assert Settings().most == 16
    assert Settings().replace_some({"quality": "tight", "max_error": 0.1}).max_error == 0.1
