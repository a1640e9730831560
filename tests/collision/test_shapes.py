"""Shapes that are known come back, and distances that are known are measured."""

import numpy as np
import pytest

from tests.collision.shapes import SIZES, finer, l_profile, noisy, turned
from urdftool.collision.choose import choose
from urdftool.collision.convex import compute_capped_hull, compute_planes, measure_plane_distance
from urdftool.collision.decimate import decimate
from urdftool.collision.distance import to_triangles
from urdftool.collision.measure import ReferenceSurface, measure
from urdftool.collision.piece import make_mesh_piece, make_primitive
from urdftool.collision.settings import Settings
from urdftool.collision.surface import prepare
from urdftool.geometry.topology import find_edges


@pytest.mark.parametrize(
    ("kind", "noise"),
    [
        ("box", 0.0),
        *(
            pytest.param(kind, 0.002, marks=pytest.mark.slow)
            for kind in ("box", "capsule", "cylinder", "sphere")
        ),
    ],
)
def test_auto_finds_the_primitive_again(kind, noise):
    rotation = turned(np.random.default_rng(3))
    mesh = noisy(kind, SIZES[kind], noise=noise, rotation=rotation, center=(0.1, -0.2, 0.3))
    choice = choose(prepare(*mesh), Settings(max_error=0.01))
    (piece,) = choice.pieces
    assert (choice.method, piece.kind) == ("primitive", kind)
    assert sorted(piece.size) == pytest.approx(sorted(SIZES[kind]), rel=0.01)
    assert piece.center == pytest.approx((0.1, -0.2, 0.3), abs=1e-3)
    assert choice.measures.error < 0.011
    assert choice.measures.volume_ratio == pytest.approx(1, abs=0.02)


@pytest.mark.slow
def test_an_upright_box_is_not_turned():
    choice = choose(prepare(*noisy("box", (0.3, 0.2, 0.1), noise=0.001)), Settings())
    assert (choice.pieces[0].rotation == np.eye(3)).all()
    assert choice.pieces[0].size == pytest.approx((0.3, 0.2, 0.1), rel=0.01)


def test_the_distance_to_a_triangle_is_exact():
    corner = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], dtype=float)
    for point, distance in [
        ((0.2, 0.2, 0.5), 0.5),
        ((-1, 0.5, 0), 1),
        ((-3, -4, 0), 5),
        ((1, 1, 0), 2**-0.5),
    ]:
        assert to_triangles(np.array([point], dtype=float), corner)[0] == pytest.approx(distance)


def test_a_box_that_is_too_large_is_measured_as_such():
    target = ReferenceSurface(prepare(*noisy("box", (0.2, 0.2, 0.2))))
    larger = make_primitive("box", (0.22, 0.2, 0.2), np.eye(3), (0, 0, 0))
    found = measure(target, [larger])
    assert found.hausdorff == pytest.approx(0.01, rel=0.02)
    assert found.volume_ratio == pytest.approx(1.1, rel=1e-6)
    assert found.outside == 0
    smaller = make_primitive("box", (0.18, 0.2, 0.2), np.eye(3), (0, 0, 0))
    assert measure(target, [smaller]).outside == pytest.approx(1 / 3, abs=0.1)


def test_what_is_enclosed_is_not_measured():
    outer, faces = noisy("box", (0.2, 0.2, 0.2))
    inner, more = noisy("sphere", (0.05,))
    both = prepare(np.concatenate([outer, inner]), np.concatenate([faces, more + len(outer)]))
    found = measure(
        ReferenceSurface(both), [make_primitive("box", (0.2, 0.2, 0.2), np.eye(3), (0, 0, 0))]
    )
    assert found.error < 4e-3
    assert found.enclosed == pytest.approx(0.0314 / (0.24 + 0.0314), abs=0.01)


def test_two_pieces_of_a_bracket_leave_nothing_out():
    surface = prepare(*l_profile())
    legs = [
        make_primitive("box", (0.2, 0.05, 0.1), np.eye(3), (0.1, 0.025, 0.05)),
        make_primitive("box", (0.05, 0.15, 0.1), np.eye(3), (0.025, 0.125, 0.05)),
    ]
    found = measure(ReferenceSurface(surface), legs)
    assert found.error < 4e-3
    assert found.volume_ratio == pytest.approx(1, abs=0.03)
    assert found.outside < 0.001


@pytest.mark.slow
def test_pieces_that_coincide_are_measured():
    box = make_primitive("box", (0.2, 0.1, 0.1), np.eye(3), (0, 0, 0))
    target = ReferenceSurface(prepare(box.vertices, box.faces))
    twice = [make_mesh_piece(box.vertices, box.faces)] * 2
    twins = [
        make_mesh_piece(box.vertices * 1.1, box.faces),
        make_mesh_piece(box.vertices * 1.1, box.faces),
    ]
    assert measure(target, twice).hausdorff == pytest.approx(0, abs=1e-9)
    corner = 0.1 * float(np.linalg.norm((0.2, 0.1, 0.1))) / 2
    assert measure(target, twins).hausdorff == pytest.approx(corner, rel=0.1)


def test_a_capped_hull_keeps_to_its_vertices_and_to_its_tolerance():
    points = make_primitive("sphere", (1.0,), np.eye(3), (0, 0, 0)).vertices
    vertices, faces = compute_capped_hull(points, 24)
    assert len(vertices) <= 24
    assert find_edges(faces).cycle
    vertices, faces = compute_capped_hull(points, 500, 0.05)
    assert measure_plane_distance(points, compute_planes(vertices, faces)).max() <= 0.05


def test_simplified_stays_closed():
    vertices, faces = noisy("sphere", (0.1,), noise=0.0005)
    fewer, triangles = decimate(vertices, faces, 200)
    assert len(triangles) <= 200
    assert find_edges(triangles).cycle
    error = measure(
        ReferenceSurface(prepare(vertices, faces)),
        [make_mesh_piece(fewer, triangles, convex=False)],
    )
    assert error.error < 0.03


@pytest.mark.slow
def test_a_bracket_is_cut_in_two():
    vertices, faces = l_profile()
    for _ in range(3):
        vertices, faces = finer(vertices, faces)
    choice = choose(prepare(vertices, faces), Settings())
    assert choice.method == "cuts"
    assert len(choice.pieces) == 2
    assert choice.measures.error <= 0.01


def test_coacd_that_dies_is_replaced_and_said(monkeypatch):
    from urdftool.collision import cut as module
    from urdftool.collision.decompose import DecompositionError

    def dies(*_, **__):
        raise DecompositionError("CoACD died (SIGABRT)", data={"cause": "died"})

    monkeypatch.setattr(module, "decompose", dies)
    choice = choose(prepare(*l_profile()), Settings(method="coacd"))
    assert choice.method == "hull"
    assert "CoACD died" in choice.notes[0].message
    assert [note.code for note in choice.notes] == ["coacd-failed"] * 2 + ["hull-instead"]


def test_a_child_that_takes_too_long_is_ended():
    from urdftool.collision.decompose import DecompositionError, run_child

    vertices, faces = noisy("sphere", (0.1,), noise=0.02)
    with pytest.raises(DecompositionError, match="took longer"):
        run_child(vertices, faces, {"threshold": 0.01, "time_limit": 0.1})


def test_inside_out_and_doubled_meshes_are_mended():
    vertices, faces = noisy("box", (0.2, 0.2, 0.2))
    surface = prepare(vertices, np.concatenate([faces[:, ::-1], faces[:10, ::-1]]))
    assert surface.volume == pytest.approx(0.008, rel=1e-6)
    assert {"turned-faces", "inside-out"} & {note.code for note in surface.notes}
