"""Smaller visual meshes and images."""

import io
import json
import re
from pathlib import Path

import numpy as np
import pytest

from tests.bundle import files
from urdftool.bundle.limits import Limits
from urdftool.geometry.load import load_mesh
from urdftool.geometry.topology import weld

pytestmark = pytest.mark.library("scipy")


def grid(count, height):
    """Points and faces of a square of ``count`` cells a side, with a height at each point."""
    steps = np.linspace(0, 1, count + 1)
    x, y = (axis.reshape(-1) for axis in np.meshgrid(steps, steps, indexing="ij"))
    points = np.stack([x, y, height(x, y)], axis=1)
    a = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).reshape(-1)
    b, c, d = a + count + 1, a + count + 2, a + 1
    return points, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def roof(x, y):
    """A sharp ridge at x = 0.5, and slopes that bulge a little."""
    return np.minimum(x, 1 - x) * 2 + 0.02 * np.sin(3 * y)


def obj(points, faces, *, halves=False):
    """An OBJ whose texture has a seam at x = 0.5, and two materials if ``halves``."""
    left = points[faces].mean(axis=1)[:, 0] < 0.5
    lines = ["mtllib a.mtl"]
    lines += [f"v {x} {y} {z}" for x, y, z in points]
    lines += [f"vt {x} {y}" for x, y, _ in points]
    lines += [f"vt {1 - x} {y}" for x, y, _ in points]
    for side, material in ((left, "paint"), (~left, "other" if halves else "paint")):
        lines.append(f"usemtl {material}")
        shift = 0 if material == "paint" and side is left else len(points)
        lines += ["f " + " ".join(f"{v + 1}/{v + 1 + shift}" for v in face) for face in faces[side]]
    return "\n".join(lines) + "\n"


def ascii_stl(points, faces):
    lines = ["solid x"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points[face]]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid x"])


def image(width, height):
    from PIL import Image

    stream = io.BytesIO()
    Image.new("RGB", (width, height), (200, 100, 50)).save(stream, "PNG")
    return stream.getvalue()


def bundle(urdftool, write, mesh, *options, collision=""):
    path = write("r.urdf", files.robot((mesh, collision or "other.stl")))
    write("other.stl", files.stl())
    result = urdftool("bundle", path, "-o", "out", "--check", *options)
    assert (result.code, result.out) == (0, "")
    return result


def entry(tmp_path, name):
    document = json.loads((tmp_path / "out" / "bundle.json").read_text())
    return next(one for one in document["files"] if one["path"] == f"meshes/{name}")


def test_ridge_seam_and_outline_stay(tmp_path, write):
    from urdftool.bundle.reduce import reduce_mesh

    points, faces = grid(40, roof)
    write("a.mtl", files.mtl())
    mesh = load_mesh(write("a.obj", obj(points, faces, halves=True)))
    reduced = reduce_mesh(mesh, Limits(max_triangles=200))
    after = reduced.mesh
    assert len(after.faces) <= 200
    assert reduced.triangles == 3200
    assert reduced.error < 0.005
    assert [part.name for part in after.parts] == [part.name for part in mesh.parts]
    # no face crosses the ridge, where material, crease and seam are
    corners = after.vertices[after.faces]
    sides = corners[..., 0] - 0.5
    assert (sides.min(axis=1) * sides.max(axis=1) > -1e-12).all()
    # no gap opens: the only open edges are those of the outline
    points, faces, edges = weld(after.vertices, after.faces)
    outline = points[edges.pairs[(edges.forward + edges.backward) % 2 == 1]]
    on_side = np.isclose(outline[..., :2], 0) | np.isclose(outline[..., :2], 1)
    assert on_side.any(axis=-1).all()
    # each texture coordinate is still that of its point
    for part, mirrored in zip(after.parts, (False, True), strict=True):
        place = after.vertices[after.get_part_faces(part)]
        expected = 1 - place[..., 0] if mirrored else place[..., 0]
        assert np.allclose(part.uv[..., 0], expected, atol=1e-6)
    # normals are those of the source, which do not blend across the ridge
    assert (np.abs(reduced.normals[..., 0]) > 0.5).all()


@pytest.mark.parametrize("limit", [0.02, 0.002])
def test_the_error_is_within_the_limit_and_measured(write, limit):
    from urdftool.bundle.reduce import reduce_mesh

    points, faces = grid(30, lambda x, y: 0.2 * np.sin(5 * x) * np.cos(4 * y))
    mesh = load_mesh(write("a.stl", ascii_stl(points, faces)))
    reduced = reduce_mesh(mesh, Limits(max_error=limit))
    assert len(reduced.mesh.faces) < 0.7 * len(faces)
    assert 0 < reduced.error <= limit
    # an independent bound: heights of the reduced surface above the points of the source
    off = 0.0
    for triangle in reduced.mesh.vertices[reduced.mesh.faces]:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = triangle
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if abs(area) < 1e-12:
            continue
        v = ((points[:, 0] - ax) * (cy - ay) - (cx - ax) * (points[:, 1] - ay)) / area
        w = ((bx - ax) * (points[:, 1] - ay) - (points[:, 0] - ax) * (by - ay)) / area
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        heights = az + v * (bz - az) + w * (cz - az)
        off = max(off, np.abs(heights - points[:, 2])[inside].max(initial=0))
    size = np.linalg.norm(np.ptp(points, axis=0))
    assert off / size < 2 * limit  # vertical distances exceed the nearest ones


def test_visual_only_and_a_table(urdftool, write, tmp_path):
    points, faces = grid(20, roof)
    write("a.stl", ascii_stl(points, faces))
    result = bundle(urdftool, write, "a.stl", "--max-triangles", "100", collision="a.stl")
    meshes = tmp_path / "out" / "meshes"
    text = (tmp_path / "out" / "arm.urdf").read_text()
    visual, collision = text.split("<collision>")
    reduced = next(path for path in meshes.iterdir() if path.name in visual)
    whole = next(path for path in meshes.iterdir() if path.name in collision)
    assert len(load_mesh(reduced).faces) <= 100
    assert len(load_mesh(whole).faces) == 800
    assert whole.stat().st_size == 84 + 50 * 800  # binary, also where it is not reduced
    assert entry(tmp_path, reduced.name)["before"]["triangles"][0] == 800
    assert "800 → " in result.err
    assert "all meshes and images" in result.err


def test_a_mesh_that_cannot_be_reduced_is_announced(urdftool, write, tmp_path):
    spikes = [(x, y, 5.0 * ((x + y) % 2)) for x in range(6) for y in range(6)]
    faces = np.array(
        [
            f
            for i in range(5)
            for j in range(5)
            for f in ((6 * i + j, 6 * i + j + 6, 6 * i + j + 7),)
        ]
    )
    write("a.stl", ascii_stl(np.array(spikes), faces))
    result = bundle(urdftool, write, "a.stl", "--max-triangles", "12")
    assert "[large-mesh]" in result.err
    lines = result.err.splitlines()
    (last,) = [line for line in lines if line.startswith("more triangles than --max-triangles in ")]
    assert "in 1 mesh: meshes/" in last
    assert all((tmp_path / "out" / name).is_file() for name in re.findall(r"\S+\.\w+(?= \()", last))


@pytest.mark.library("PIL")
def test_images_are_scaled_down(urdftool, write, tmp_path):
    from PIL import Image

    points, faces = grid(4, roof)
    write("a.mtl", files.mtl("skin.png"))
    write("skin.png", image(64, 16))
    write("a.obj", obj(points, faces))
    bundle(urdftool, write, "a.obj", "--max-texture", "32")
    assert Image.open(tmp_path / "out" / "meshes" / "skin.png").size == (32, 8)
    assert entry(tmp_path, "skin.png")["before"]["pixels"] == [[64, 16], [32, 8]]
    before = (tmp_path / "out" / "meshes" / "a.obj").read_bytes()
    assert before == Path("a.obj").read_bytes()
    write("skin.png", image(64, 16)[:60])  # damaged
    result = bundle(urdftool, write, "a.obj", "--max-texture", "32", "--overwrite")
    assert "image 'meshes/skin.png' is kept, though --max-texture is 32" in result.err
    write("skin.png", image(64, 16))
    # and inside a GLB, whose other contents stay
    bundle(urdftool, write, "a.obj", "--meshes", "glb", "--overwrite")
    write("b.glb", (tmp_path / "out" / "meshes" / "a.glb").read_bytes())
    old = load_mesh("b.glb")
    bundle(urdftool, write, "b.glb", "--max-texture", "32", "--overwrite")
    new = load_mesh(tmp_path / "out" / "meshes" / "b.glb")
    assert Image.open(io.BytesIO(new.parts[0].image)).size == (32, 8)
    assert np.array_equal(new.vertices, old.vertices)
    assert np.array_equal(new.parts[0].uv, old.parts[0].uv)


@pytest.mark.library("PIL")
@pytest.mark.parametrize("data", [b"", b"\x89PNG\r\n\x1a\n" + b"\0" * 40, b"GIF89a" + b"\0" * 9])
def test_damaged_images_stay(data):
    from urdftool.bundle.textures import shrink_glb_images, shrink_image

    assert shrink_image(data, 8) is None
    assert shrink_glb_images(files.glb(b'{"images":[{"bufferView":3}]}', data), 8) is None


@pytest.mark.parametrize("words", [("--max-error", "0"), ("--max-triangles", "1")])
def test_limits_are_positive(urdftool, write, words):
    path = write("r.urdf", files.robot(("a.stl", "a.stl")))
    assert urdftool("bundle", path, "-o", "out", *words).code == 2
