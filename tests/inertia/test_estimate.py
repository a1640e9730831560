"""Any mesh: the properties are right within 3 %, or the result says that they may not be."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from tests.mechanics.bodies import move
from urdftool.errors import MeshError
from urdftool.geometry.load import load_mesh
from urdftool.inertia.estimate import estimate_mass_properties
from urdftool.inertia.inertia_error import InertiaError
from urdftool.inertia.polyhedron import compute_solid_moments
from urdftool.inertia.requirements import is_consistent
from urdftool.inertia.solids import box
from urdftool.mechanics.spatial_inertia import combine

FIXTURES = Path(__file__).parents[2] / "fixtures" / "meshes"
CORPUS = Path(__file__).parents[3] / "shared" / "corpus-meshes"

needs_corpus = pytest.mark.skipif(
    not CORPUS.is_dir(), reason="the corpus of real meshes is not beside the checkout"
)
REAL = {
    "Print_Leader_SO_ARM100_08k_UP_BambuLabA1Mini_part1.STL": ("exact", True),
    "wrist_roll_pitch_so101_v2.stl": ("exact", True),
    "upperarm.dae": ("winding-number", False),
    "palm_lower.obj": ("exact", True),
    "link6.dae": ("winding-number", False),
    "husky_description__wheel.dae": ("exact", True),
    "husky_description__wheel.stl": ("exact", True),
    "link_5.dae": ("repaired", True),
    "right_tire.stl": ("exact", True),
}


def estimate(name, **amount):
    mesh = load_mesh(FIXTURES / name)
    return estimate_mass_properties(mesh.vertices, mesh.faces, **(amount or {"density": 1.0}))


def differences(got, wanted):
    """Of the mass, the center of mass by the radius of gyration, and the tensor; relative."""
    radius = np.sqrt(np.trace(wanted.inertia) / 2 / wanted.mass)
    return np.array(
        [
            abs(got.mass / wanted.mass - 1),
            np.linalg.norm(np.subtract(got.com, wanted.com)) / radius,
            np.abs(got.inertia - wanted.inertia).max() / np.abs(wanted.inertia).max(),
        ]
    )


def shapes():
    ring = trimesh.creation.annulus(r_min=0.5, r_max=1.0, height=0.4, sections=64)
    second = trimesh.creation.box((1, 0.2, 2)).subdivide().subdivide()
    second.apply_translation([0, 0, 3])
    pair = trimesh.util.concatenate([trimesh.creation.icosphere(subdivisions=2), second])
    return {
        "cube": trimesh.creation.box((1, 1, 1)),
        "plate": trimesh.creation.box((1, 2, 0.05)).subdivide().subdivide().subdivide(),
        "sphere": trimesh.creation.icosphere(subdivisions=3),
        "torus": trimesh.creation.torus(1.0, 0.3),
        "ring": ring,
        "capsule": trimesh.creation.capsule(1.0, 0.3),
        "two bodies": pair,
    }


def damaged(faces, kind, random):
    faces = faces.copy()
    if kind != "removed":
        turned = random.random(len(faces)) < 0.2
        faces[turned] = faces[turned][:, ::-1]
    if kind != "flipped":
        faces = faces[random.permutation(len(faces))[round(0.05 * len(faces)) or 1 :]]
    return faces


@pytest.mark.parametrize("kind", ["removed", "flipped", "both"])
@pytest.mark.parametrize("name", list(shapes()))
def test_damage_is_repaired_or_said(name, kind):
    mesh = shapes()[name]
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    wanted = compute_solid_moments(vertices, faces).with_density(2.0)
    trusted = 0
    for seed in range(2):
        broken = damaged(faces, kind, np.random.default_rng(seed))
        got = estimate_mass_properties(vertices, broken, density=2.0)
        assert is_consistent(got.properties)
        assert isinstance(got.reliable, bool)
        if got.reliable:
            trusted += 1
            assert differences(got.properties, wanted).max() < 0.03, got
        if kind == "flipped":
            assert got.method == "repaired"
            assert differences(got.properties, wanted).max() < 1e-9
    # admitting everything to be unreliable would be no repair
    assert trusted or name == "cube"


@pytest.mark.parametrize("name", ["sphere", "torus", "plate"])
def test_vertices_of_each_face_its_own(name):
    mesh = shapes()[name]
    vertices = np.asarray(mesh.triangles).reshape(-1, 3)
    faces = np.arange(len(vertices)).reshape(-1, 3)
    got = estimate_mass_properties(vertices, faces, mass=3.0)
    assert got.method == "exact"
    wanted = compute_solid_moments(np.asarray(mesh.vertices), np.asarray(mesh.faces)).with_mass(3.0)
    assert differences(got.properties, wanted).max() < 1e-12


def test_split_into_touching_bodies():
    left, right = trimesh.creation.box((1, 1, 1)), trimesh.creation.box((1, 1, 1))
    right.apply_translation([1, 0, 0])
    both = trimesh.util.concatenate([left, right])
    got = estimate_mass_properties(both.vertices, np.asarray(both.faces), density=1.0)
    assert got.method == "exact"
    wanted = move(box((2, 1, 1), density=1.0), xyz=(0.5, 0, 0))
    assert differences(got.properties, wanted).max() < 1e-12


@pytest.mark.parametrize(
    ("name", "volume", "words"),
    [
        ("cube.stl", 1.0, ()),
        ("inside_out.stl", 1.0, ("inside out",)),
        ("two_cubes.stl", 2.0, ()),
        ("cavity.stl", 0.875, ("cavities",)),
        ("nested_same_way.stl", 1.0, ("inside another solid",)),
    ],
)
def test_bodies(name, volume, words):
    got = estimate(name)
    assert (got.method, got.reliable, got.error) == ("exact", True, 0.0)
    assert got.volume == pytest.approx(volume, rel=1e-12)
    assert all(any(word in note.message for note in got.notes) for word in words)
    assert bool(words) == bool(got.notes)


def test_cavity_that_is_inside_out_with_its_body():
    mesh = load_mesh(FIXTURES / "cavity.stl")
    got = estimate_mass_properties(mesh.vertices, mesh.faces[:, ::-1], density=1.0)
    assert got.volume == pytest.approx(0.875, rel=1e-12)
    hole = box((0.5, 0.5, 0.5), density=1.0).inertia
    np.testing.assert_allclose(got.properties.inertia, box((1, 1, 1), density=1.0).inertia - hole)


def test_bodies_that_overlap_by_half_are_united():
    left, right = trimesh.creation.box((2, 1, 1)), trimesh.creation.box((2, 1, 1))
    right.apply_translation([1, 0.0, 0])
    both = trimesh.util.concatenate([left, right])
    got = estimate_mass_properties(both.vertices, np.asarray(both.faces), density=1.0)
    assert got.method == "winding-number"
    assert got.volume == pytest.approx(3.0, rel=0.03)
    assert [note.data["counted"] for note in got.notes if note.code == "bodies-overlap"] == [1]


def test_the_error_of_samples_is_that_of_the_moments_too():
    box = trimesh.creation.box()
    found = estimate_mass_properties(np.array(box.vertices), np.array(box.faces)[:-1], density=1.0)
    tensor = np.array(found.properties.tensor)[[0, 3, 5, 1, 2, 4]]
    error = 6 * np.abs(tensor - np.array([1 / 6] * 3 + [0] * 3)).max()
    assert error <= found.error < 0.005


def test_every_face_written_for_both_sides():
    mesh = trimesh.creation.icosphere(subdivisions=2)
    faces = np.concatenate([mesh.faces, mesh.faces[:, ::-1]])
    got = estimate_mass_properties(mesh.vertices, faces, density=1.0)
    assert got.method == "repaired"
    assert got.volume == pytest.approx(mesh.volume, rel=1e-12)


def test_open_box_is_a_guess():
    got = estimate("open_box.stl")
    assert not got.reliable
    assert got.volume == pytest.approx(1.0, rel=0.05)
    assert got.hull_volume == pytest.approx(1.0)
    assert "large-opening" in [note.code for note in got.notes]


def test_far_from_the_origin_and_tiny():
    mesh = trimesh.creation.icosphere(subdivisions=2, radius=1e-4)
    got = estimate_mass_properties(mesh.vertices + 50, np.asarray(mesh.faces), density=1.0)
    assert got.method == "exact"
    assert got.volume == pytest.approx(mesh.volume, rel=1e-6)


@pytest.mark.parametrize(
    ("name", "amount", "error", "words"),
    [
        ("flat.stl", {"mass": 1.0}, MeshError, "flat|four"),
        ("cube.stl", {"mass": 0.0}, InertiaError, "above zero"),
        ("cube.stl", {"density": -1.0}, InertiaError, "above zero"),
        ("cube.stl", {"mass": float("nan")}, InertiaError, "above zero"),
        ("cube.stl", {"mass": 1.0, "density": 1.0}, InertiaError, "not both"),
    ],
)
def test_bad_input(name, amount, error, words):
    with pytest.raises(error, match=words):
        estimate(name, **amount)


def test_random_triangles_never_give_an_impossible_tensor():
    random = np.random.default_rng(3)
    for count in (4, 6, 20, 60):
        for _ in range(3):
            vertices = random.normal(size=(count, 3))
            faces = random.integers(0, count, size=(2 * count, 3))
            try:
                got = estimate_mass_properties(vertices, faces, mass=1.0)
            except MeshError:
                continue
            assert is_consistent(got.properties)
            assert not got.reliable


def test_several_meshes_combine():
    parts = [estimate("cube.stl", mass=1.0).properties for _ in range(2)]
    whole = combine([parts[0], move(parts[1], xyz=(1, 0, 0))])
    np.testing.assert_allclose(whole.inertia, box((2, 1, 1), mass=2.0).inertia, atol=1e-12)


@pytest.mark.corpus
@pytest.mark.slow
@needs_corpus
@pytest.mark.parametrize("name", list(REAL))
def test_real_meshes(name):
    (file,) = CORPUS.glob(f"*__{name}")
    mesh = load_mesh(file)
    got = estimate_mass_properties(mesh.vertices, mesh.faces, density=1000.0)
    assert (got.method, got.reliable) == REAL[name]
    assert is_consistent(got.properties)
    judge = trimesh.Trimesh(mesh.vertices, mesh.faces)
    if got.method == "exact" and judge.is_watertight:
        judge.density = 1000.0
        assert got.properties.mass == pytest.approx(judge.mass, rel=1e-9)
        np.testing.assert_allclose(got.properties.com, judge.center_mass, rtol=1e-9, atol=1e-12)
        scale = np.abs(judge.moment_inertia).max()
        np.testing.assert_allclose(got.properties.inertia, judge.moment_inertia, atol=1e-9 * scale)


@pytest.mark.corpus
@pytest.mark.slow
@needs_corpus
@pytest.mark.parametrize("kind", ["removed", "flipped", "both"])
@pytest.mark.parametrize("name", [name for name, (method, _) in REAL.items() if method == "exact"])
def test_damaged_real_meshes(name, kind):
    (file,) = CORPUS.glob(f"*__{name}")
    mesh = load_mesh(file)
    wanted = estimate_mass_properties(mesh.vertices, mesh.faces, density=1000.0)
    broken = damaged(mesh.faces, kind, np.random.default_rng(0))
    got = estimate_mass_properties(mesh.vertices, broken, density=1000.0)
    assert is_consistent(got.properties)
    if got.reliable:
        assert differences(got.properties, wanted.properties).max() < 0.03


def make_two_boxes(*sizes):
    """Boxes with a common corner at the origin, as one mesh with shared points."""
    meshes = []
    for size in sizes:
        mesh = trimesh.creation.box(size)
        mesh.apply_translation(np.array(size) / 2)
        meshes.append(mesh)
    return trimesh.util.concatenate(meshes)


def test_a_doubled_shell_counts_once():
    twice = make_two_boxes((1, 1, 1), (1, 1, 1))
    estimate = estimate_mass_properties(twice.vertices, twice.faces, density=1.0)
    assert (estimate.method, estimate.volume) == ("exact", pytest.approx(1.0))
    assert [note.code for note in estimate.notes] == ["duplicate-faces"]


def test_a_body_that_shares_a_face_with_the_one_around_it_counts_once():
    nested = make_two_boxes((1, 1, 1), (1, 1, 0.5))
    estimate = estimate_mass_properties(nested.vertices, nested.faces, density=1.0)
    assert estimate.volume == pytest.approx(1.0, rel=0.01)
    assert estimate.method == "winding-number"
    assert estimate.error > 0


def test_two_boxes_that_share_an_edge_alone_are_exact():
    first = trimesh.creation.box((1, 1, 1))
    second = first.copy()
    second.apply_translation((1, 1, 0))
    both = trimesh.util.concatenate([first, second])
    estimate = estimate_mass_properties(both.vertices, both.faces, density=1.0)
    assert (estimate.method, estimate.volume) == ("exact", pytest.approx(2.0))


def test_the_error_of_samples_covers_products_of_inertia():
    box = trimesh.creation.box((1, 1, 1))
    estimate = estimate_mass_properties(box.vertices, box.faces[:-1], mass=1.0)
    off = np.abs(estimate.properties.inertia - np.eye(3) / 6).max() * 6
    assert 0 < off <= estimate.error
