"""Copies of meshes with less detail, and what is kept of them."""

import numpy as np
import pytest

from urdftool.geometry import thin
from urdftool.geometry.load import load_mesh
from urdftool.geometry.mesh import Mesh, Part
from urdftool.geometry.tessellate import tessellate
from urdftool.geometry.thin import SMALL_FILE, ThinMeshes, compute_content_key, merge_in_cells
from urdftool.inertia.bodies import get_cached_mesh_body, integrate_mesh_body
from urdftool.storage import DiskCache, join_parts


def wavy(count):
    """A closed surface of about ``2 * count**2`` triangles."""
    vertices, faces = tessellate("sphere", (0.1,), count)
    length = 1 + 0.05 * np.sin(40 * vertices[:, 0])
    return vertices * length[:, None], faces


def as_mesh(path, vertices, faces, parts=()):
    return Mesh(vertices, faces, parts or (Part("", 0, len(faces)),), "stl", path)


def stl(vertices, faces):
    records = np.zeros(len(faces), [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    records["c"] = vertices[faces]
    return b"\0" * 80 + len(faces).to_bytes(4, "little") + records.tobytes()


@pytest.fixture
def heavy(tmp_path):
    vertices, faces = wavy(100)
    path = tmp_path / "heavy.stl"
    path.write_bytes(stl(vertices, faces))
    assert path.stat().st_size > SMALL_FILE
    return path


def test_no_vertex_moves_by_more_than_the_diagonal_of_a_cell(tmp_path):
    vertices, faces = wavy(200)
    cell = 0.01
    found = merge_in_cells(as_mesh(tmp_path, vertices, faces), cell)
    assert len(found.faces) < len(faces) / 4
    from scipy.spatial import cKDTree

    off, _ = cKDTree(found.vertices).query(vertices)
    assert off.max() <= cell * 3**0.5


def test_parts_keep_their_faces(tmp_path):
    vertices, faces = wavy(60)
    order = np.argsort(vertices[faces][:, :, 0].mean(axis=1))
    faces, half = faces[order], len(faces) // 2
    uv = np.zeros((len(faces) - half, 3, 2))
    uv[:, 0, 0] = np.arange(half, len(faces))
    parts = (
        Part("low", 0, half, (1, 0, 0, 1)),
        Part("high", half, len(faces) - half, (0, 1, 0, 1), uv=uv),
    )
    found = merge_in_cells(as_mesh(tmp_path, vertices, faces, parts), 0.01)
    low, high = found.parts
    assert (low.first, high.first, high.first + high.count) == (0, low.count, len(found.faces))
    assert found.vertices[found.get_part_faces(low)][..., 0].mean() < -0.03
    assert found.vertices[found.get_part_faces(high)][..., 0].mean() > 0.03
    assert len(high.uv) == high.count
    assert (np.diff(high.uv[:, 0, 0]) > 0).all()


def test_the_second_time_the_file_is_not_read(heavy, tmp_path, monkeypatch):
    cache = DiskCache(tmp_path / "cache")
    first = ThinMeshes(cache).read(heavy, (1, 1, 1), "y", 0.005)
    assert len(first.faces) < 10_000
    monkeypatch.setattr("urdftool.geometry.thin.load_mesh", None)
    second = ThinMeshes(cache).read(heavy, (1, 1, 1), "y", 0.005)
    assert (second.vertices == first.vertices).all()
    assert (second.faces == first.faces).all()
    assert second.parts == first.parts
    with pytest.raises(TypeError):  # another scale is another mesh
        ThinMeshes(cache).read(heavy, (2, 1, 1), "y", 0.005)


def test_fine_pictures_have_all_triangles(heavy, tmp_path):
    found = ThinMeshes(DiskCache(tmp_path / "cache")).read(heavy, (1, 1, 1), "y", 1e-5)
    assert len(found.faces) == len(load_mesh(heavy).faces)


def test_materials_belong_to_the_content(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("mtllib a.mtl\n")
    before = compute_content_key(path)
    (tmp_path / "a.mtl").write_text("newmtl red\n")
    assert compute_content_key(path) != before


def test_mass_properties_are_kept_by_content(heavy, tmp_path, monkeypatch):
    cache = DiskCache(tmp_path / "cache")
    first = get_cached_mesh_body(heavy, cache)
    plain = integrate_mesh_body(heavy)
    monkeypatch.setattr("urdftool.inertia.bodies.integrate_mesh_body", None)
    second = get_cached_mesh_body(heavy, cache)
    for body in (first, second):
        assert (body.unit, body.notes, body.method) == (plain.unit, plain.notes, plain.method)
        assert (body.lower == plain.lower).all()
        assert body.as_dict() == plain.as_dict()
    heavy.write_bytes(heavy.read_bytes()[:-1] + b"\1")
    with pytest.raises(TypeError):
        get_cached_mesh_body(heavy, cache)


PART = {"name": "", "first": 0, "count": 1, "rgba": None, "texture": None, "uv": False}
POINTS, FACE = bytes(72), np.array([0, 1, 2], "<i4").tobytes()
FORGED = [
    *(b"", b"7", b"[[1,2,3]]", b"[[NaN,0,0],[0,0,0]]", b"[" * 99_999, b"{}", b"PK\3\4"),
    *(join_parts(head, [POINTS, FACE]) for head in (None, {"parts": [7], "format": "stl"})),
    *(
        join_parts({"parts": [{**PART, **change}], "format": "stl"}, [POINTS, FACE])
        for change in ({"count": 9}, {"first": -1}, {"uv": True}, {"rgba": 7}, {"texture": 7})
    ),
    join_parts({"parts": [PART], "format": "stl"}, [POINTS, b"\xff" * 12]),
    join_parts({"parts": [PART], "format": "stl"}, [b"\xff" * 72, FACE]),
]


@pytest.mark.parametrize("data", FORGED)
def test_a_forged_entry_counts_as_absent(data, heavy, tmp_path):
    cache = DiskCache(tmp_path / "cache")
    mesh = ThinMeshes(cache).read(heavy, (1, 1, 1), "y", 0.01)
    body = get_cached_mesh_body(heavy, cache)
    entries = [path.name for path in (tmp_path / "cache").rglob("*") if path.is_file()]
    assert len(entries) == 3
    for entry in entries:
        cache.put(entry, data)
    again = ThinMeshes(cache).read(heavy, (1, 1, 1), "y", 0.01)
    assert again.vertices.tobytes() == mesh.vertices.tobytes()
    assert get_cached_mesh_body(heavy, cache).unit == body.unit


def test_a_thinned_mesh_is_read_as_it_was_written(tmp_path):
    vertices, faces = wavy(6)
    uv = np.arange(6.0 * len(faces)).reshape(-1, 3, 2)
    color = (0.1, 0.2, 0.3, 1.0)
    part = Part("a", 0, len(faces), color, tmp_path / "a.png", None, uv)
    mesh = as_mesh(tmp_path / "a.stl", vertices, faces, (part,))
    again = thin._unpack(thin._pack(mesh), mesh.path)
    assert (again.parts, again.format, again.path) == (mesh.parts, "stl", mesh.path)
    for one, other in ((again.vertices, vertices), (again.faces, faces), (again.parts[0].uv, uv)):
        assert one.tobytes() == other.tobytes()
