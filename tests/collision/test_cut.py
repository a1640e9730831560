"""What is cut: the solid around any mesh, cuts within a distance, and pieces joined again."""

import numpy as np
import pytest

from tests.collision.shapes import finer, l_profile, noisy
from tests.conftest import FIXTURES
from urdftool.collision import cut, decompose
from urdftool.collision.choose import choose
from urdftool.collision.convex import compute_hull, compute_planes
from urdftool.collision.cut import Cutter, Joiner
from urdftool.collision.decompose import make_solid
from urdftool.collision.distance import Surface, spread
from urdftool.collision.measure import ReferenceSurface
from urdftool.collision.piece import make_mesh_piece, make_primitive
from urdftool.collision.remesh import Layer, Outside, compute_remesh, intersect
from urdftool.collision.settings import Settings
from urdftool.collision.surface import prepare, read_surface
from urdftool.geometry.topology import find_edges


def soup():
    """Two boxes through each other, one of them without a lid, and a loose triangle."""
    one, faces = noisy("box", (0.3, 0.2, 0.1))
    other = make_primitive("box", (0.1, 0.1, 0.3), np.eye(3), (0.05, 0, 0))
    loose = np.array([[0.2, 0.2, 0], [0.25, 0.2, 0], [0.2, 0.25, 0.0]])
    points = np.concatenate([one, other.vertices, loose])
    more = other.faces[2:] + len(one)
    last = np.array([[0, 1, 2]]) + len(one) + len(other.vertices)
    return prepare(points, np.concatenate([faces, more, last]))


def test_what_is_made_of_any_mesh_is_closed_and_near_to_it():
    surface = soup()
    vertices, faces = compute_remesh(Layer(surface.corners))
    edges = find_edges(faces)
    assert (edges.forward == 1).all()
    assert (edges.backward == 1).all()
    off = Surface(surface.corners, spread(surface.corners, 40_000)).measure_distance(vertices)
    assert off.max() < 0.005 * surface.size
    corners = vertices[faces]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume > 0


def test_one_closed_body_is_cut_as_it_is():
    surface = prepare(*l_profile())
    assert (make_solid(ReferenceSurface(surface)).vertices == surface.vertices).all()


def test_what_a_solid_and_a_box_have_in_common():
    solid = make_primitive("box", (0.2, 0.2, 0.2), np.eye(3), (0, 0, 0))
    other = make_primitive("box", (0.2, 0.2, 0.2), np.eye(3), (0.1, 0, 0))
    vertices, _ = intersect(solid.corners, other.vertices, other.faces)
    assert vertices.min(axis=0) == pytest.approx((0, -0.1, -0.1), abs=0.004)
    assert vertices.max(axis=0) == pytest.approx((0.1, 0.1, 0.1), abs=0.004)
    away = make_primitive("box", (0.1, 0.1, 0.1), np.eye(3), (1, 0, 0))
    assert intersect(solid.corners, away.vertices, away.faces) is None


def test_the_distance_outside_is_read_from_a_grid():
    sphere = make_primitive("sphere", (0.1,), np.eye(3), (0, 0, 0))
    points = np.array([[0, 0, 0], [0.05, 0, 0], [0.105, 0, 0], [0, 0, 0.103]])
    found = Outside(Layer(sphere.corners)).measure_distance(points)
    assert found == pytest.approx([0, 0, 0.005, 0.003], abs=0.001)


def test_pieces_are_joined_where_their_hull_is_near_enough():
    surface = prepare(*l_profile())
    boxes = [
        make_primitive("box", (0.05, 0.05, 0.1), np.eye(3), (0.025 + 0.05 * k, 0.025, 0.05))
        for k in range(4)
    ] + [
        make_primitive("box", (0.05, 0.05, 0.1), np.eye(3), (0.025, 0.075 + 0.05 * k, 0.05))
        for k in range(3)
    ]
    pieces = [make_mesh_piece(box.vertices, box.faces) for box in boxes]
    joined = Joiner(ReferenceSurface(surface)).join(pieces, 0.003)
    assert len(joined) == 2
    covered = np.concatenate([piece.vertices for piece in joined])
    assert np.ptp(covered, axis=0) == pytest.approx((0.2, 0.2, 0.1))


def bent(parts):
    """Boxes along a quarter of a ring."""
    angles = np.linspace(0, np.pi / 2, parts)
    found = []
    for angle in angles:
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        box = make_primitive("box", (0.04, 0.05, 0.05), turn, (0.2 * c, 0.2 * s, 0))
        found.append(make_mesh_piece(box.vertices, box.faces))
    return found


@pytest.mark.slow
def test_joins_go_on_beyond_the_distance_until_the_triangles_are_few_enough(monkeypatch):
    boxes = bent(12)
    corners = np.concatenate([box.corners for box in boxes])
    surface = prepare(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    monkeypatch.setattr(cut, "decompose", lambda *_, **__: boxes)
    monkeypatch.setattr(cut, "divide", lambda *_, **__: [])
    counts, errors = [], []
    for most in (1000, 100, 40):
        settings = Settings(method="coacd", max_triangles=most)
        made = Cutter(ReferenceSurface(surface), settings).cut(0.002, 0.002)
        assert made is not None
        counts.append(made[1].triangles)
        errors.append(made[1].hausdorff)
        assert counts[-1] <= most
    assert counts[0] > 100
    assert errors[0] < errors[2]


def slotted():
    """A block of 0.2 × 0.1 × 0.1 with a slot, 0.02 wide and 0.08 deep; and its hull."""
    boxes = [
        make_primitive("box", size, np.eye(3), center)
        for size, center in (
            ((0.2, 0.1, 0.02), (0, 0, 0.01)),
            ((0.09, 0.1, 0.08), (-0.055, 0, 0.06)),
            ((0.09, 0.1, 0.08), (0.055, 0, 0.06)),
        )
    ]
    corners = np.concatenate([box.corners for box in boxes]).reshape(-1, 3)
    surface = prepare(corners, np.arange(len(corners)).reshape(-1, 3))
    return (
        surface,
        make_mesh_piece(*compute_hull(surface.vertices)),
        [make_mesh_piece(b.vertices, b.faces) for b in boxes],
    )


@pytest.mark.slow
def test_a_piece_that_buries_a_slot_is_cut_again(monkeypatch):
    surface, whole, parts = slotted()
    monkeypatch.setattr(cut, "divide", lambda *_, **__: parts)
    target = ReferenceSurface(surface)
    cutter = Cutter(target, Settings(method="coacd"))
    assert max(cut.compute_excess_of_each(target, [whole])) < 0.012  # it hardly sticks out
    assert cutter._cut_again([whole], 0.012) == parts
    assert cutter._cut_again([whole], 0.06) == [whole]


@pytest.mark.slow
def test_all_runs_on_a_mesh_share_one_time_limit(monkeypatch):
    surface, whole, _ = slotted()
    limits: list[float] = []

    def slow(vertices, faces, options, threads):
        limits.append(options["time_limit"])
        return [whole.vertices]

    monkeypatch.setattr(decompose, "run_child", slow)
    monkeypatch.setattr(decompose, "_measure_children_time", lambda: float(len(limits)))
    cutter = Cutter(ReferenceSurface(surface), Settings(method="coacd", time_limit=0.5))
    pieces, _ = cutter.cut(0.012, 0.012)
    assert limits == [0.5]  # what was left did not do for another
    assert len(pieces) == 1
    assert cutter.notes[0].code == "coacd-failed"
    with pytest.raises(decompose.DecompositionError, match="took longer"):
        cutter.cut(0.012, 0.012)


def test_a_simplified_mesh_says_what_its_hull_is_off():
    choice = choose(prepare(*l_profile()), Settings(method="simplify"))
    assert choice.measures.error < 0.003
    assert choice.notes[0].code == "hull-of-engines"


@pytest.mark.slow
def test_a_shell_of_a_few_flat_sides_becomes_plates():
    choice = choose(read_surface(FIXTURES / "meshes/open_box.stl"), Settings(max_error=0.01))
    assert (choice.method, len(choice.pieces)) == ("hull", 5)
    assert choice.measures.error < 0.002


def test_auto_never_takes_a_concave_mesh():
    choice = choose(prepare(*l_profile()), Settings(max_hulls=1))
    assert choice.method in ("primitive", "hull", "cuts")
    assert [piece.kind for piece in choice.pieces] != ["mesh"]
    assert choice.measures.error > 0.05
    (note,) = choice.notes
    assert (note.code, note.data["pieces"]) == ("more-pieces", 2)
    assert note.data["error"] < 0.03


@pytest.mark.slow
def test_cuts_keep_to_their_distance():
    vertices, faces = finer(*finer(*l_profile()))
    loose = np.array([[0.05, 0.0, 0.1], [0.1, 0.0, 0.1], [0.05, 0.05, 0.1]])
    more = np.array([[0, 1, 2]]) + len(vertices)
    surface = prepare(np.concatenate([vertices, loose]), np.concatenate([faces, more]))
    choice = choose(surface, Settings(method="coacd"))
    assert 2 <= len(choice.pieces) <= 4
    assert choice.measures.hausdorff <= 1.4 * 0.03 * 0.2
    assert choice.measures.volume_ratio == pytest.approx(1, abs=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("most", [1, 2, 5])
def test_no_more_pieces_than_are_allowed(most):
    surface = prepare(*finer(*l_profile()))
    settings = Settings(method="coacd", max_hulls=most, threshold=0.01, max_error=0.05)
    choice = choose(surface, settings)
    assert choice.method == "coacd"
    assert 1 <= len(choice.pieces) <= most
    assert (choice.measures.error < 0.01) == (most > 1)


@pytest.mark.slow
def test_the_pieces_do_not_hang_on_the_number_of_cores():
    surface = read_surface(FIXTURES / "meshes/open_box.stl")
    settings = Settings(method="coacd")
    one, many = (choose(surface, settings, cores) for cores in (1, 3))
    assert len(one.pieces) > 1
    assert [piece.as_dict() for piece in one.pieces] == [piece.as_dict() for piece in many.pieces]
    assert one.measures == many.measures


@pytest.mark.parametrize(
    ("version", "threads"), [("1.0.14", 4), ("1.1.0", 4), ("1.0.9", 1), ("odd", 1)]
)
def test_an_older_coacd_works_with_one_thread(monkeypatch, version, threads):
    monkeypatch.setattr("importlib.metadata.version", lambda name: version)
    assert decompose.choose_threads(4) == threads


def test_widening_cells_is_a_dilation():
    from scipy import ndimage

    from urdftool.collision.remesh import widen

    cells = np.random.default_rng(0).random((9, 7, 8)) > 0.95
    whole = np.ones((3, 3, 3), dtype=bool)
    assert (widen(cells, 2) == ndimage.binary_dilation(cells, whole, iterations=2)).all()


def test_planes_are_told_once_each():
    vertices, faces = compute_hull(np.array(list(np.ndindex(2, 2, 2)), dtype=float))
    assert len(faces) == 12
    assert len(compute_planes(vertices, faces)) == 6
