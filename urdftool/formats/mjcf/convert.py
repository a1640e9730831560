"""Conversion of a mesh file for MuJoCo: copied if possible, otherwise converted to OBJ.

MuJoCo reads binary STL of at most 200,000 triangles and OBJ; older versions read only the first
object of an OBJ file. A collision mesh needs four points that are not coplanar; a mesh that is not
declared a shell needs volume. Visual meshes are split by material.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import MeshError
from ...geometry.hull import compute_convex_hull, extract_hull_surface
from ...geometry.load import load_mesh
from ...geometry.mesh import Faces, Mesh, MeshNote, Part, Points
from ...geometry.stl_header import read_stl_header
from ...source.description import GltfUp
from .obj import write_obj_bytes

MAX_STL_TRIANGLES = 200_000
"""Largest number of triangles of an STL file that MuJoCo reads."""

FLAT = 1e-6
"""Thickness relative to the size below which a mesh counts as flat."""

THICKENED = 1e-3
"""Thickness that a flat collision mesh gets, relative to its size. Chosen, no source."""

MAX_FACET = 3000
"""Corners of one flat side of a hull up to which MuJoCo 3.3 computes it within 0.5 s of processor
time; the time grows with their square, and 30,000 corners take minutes. Measured on cones."""

LONG_FACE = re.compile(rb"\nf(?:[ \t]+\S+){101}")
"""A polygon of more than 100 vertices, which MuJoCo skips without a warning."""

_FACET_NOTE = MeshNote(
    "facet",
    f"The convex hull has a flat side of more than {MAX_FACET} corners, which MuJoCo computes too "
    "slowly; collision uses a hull with fewer corners.",
    lossy=True,
)

Rgba = tuple[float, float, float, float]
Image = Path | bytes


@dataclass
class Piece:
    """One mesh asset: its file and appearance.

    Attributes:
        data: Content of the file; None for the original file.
        rgba: Color in the mesh file, if any.
        texture: Image in the mesh file, if any: the path of a file, or the image itself.
        shell: Whether its volume is too small for MuJoCo's volume inertia.
    """

    data: bytes | None
    rgba: Rgba | None = None
    texture: Image | None = None
    shell: bool = False


@dataclass
class Converted:
    """A mesh file, converted as collision or visual geometry.

    Attributes:
        pieces: One for collision geometry; one for each material of visual geometry.
        hull: Ratio of the volume of the convex hull to that of the mesh; None for open meshes.
        notes: Notes to the user about the conversion.
        thick: Whether the mesh was flat and was thickened.
    """

    pieces: list[Piece]
    hull: float | None = None
    notes: list[MeshNote] = field(default_factory=list)
    thick: bool = False


def convert(path: Path, *, collides: bool, gltf_up: GltfUp = "y") -> Converted:
    """Convert a mesh file to MuJoCo's formats, unscaled, in the frame of the ``<geometry>``.

    Raises:
        MeshError: The file cannot be read.
    """
    mesh = load_mesh(path, gltf_up=gltf_up)
    notes = list(mesh.notes)
    copied = _is_readable(mesh)
    if collides:
        return _make_collision(mesh, copied, notes)
    groups = _group_by_material(mesh)
    pieces = []
    for part, faces, uv in groups:
        vertices = mesh.vertices
        shell = _is_shell(vertices, faces)
        data = None
        image = get_part_image(part)
        if image is None and not (part.texture is None and part.image is None):
            message = "An image has no texture coordinates in the file, so it is lost."
            notes.append(MeshNote("image-without-coordinates", message, lossy=True))
        if _count_points(vertices[faces]) < 4:
            message = "A part has fewer than four points, MuJoCo's least; it is thickened."
            notes.append(MeshNote("few-points", message, lossy=True))
            data, image = _convert_thick_obj(vertices[faces]), None
        elif not (copied and len(groups) == 1):
            # a piece without a color may get an image from the material of the visual
            seen = image is not None or part.rgba is None
            data = write_obj_bytes(vertices, faces, uv if seen else None)
        pieces.append(Piece(data, part.rgba, image, shell))
    return Converted(pieces, None, list(dict.fromkeys(notes)))


def _make_collision(mesh: Mesh, copied: bool, notes: list[MeshNote]) -> Converted:
    corners = mesh.vertices[mesh.faces]
    if _count_points(corners) < 4 or _compute_thickness(corners.reshape(-1, 3)) < FLAT:
        message = (
            "The mesh is flat, and MuJoCo collides bodies with volume; it is thickened to "
            f"{THICKENED:.1%} of its size."
        )
        notes.append(MeshNote("flat-mesh", message, lossy=True))
        return Converted([Piece(_convert_thick_obj(corners))], None, notes, thick=True)
    simple = _simplify_hull(mesh.vertices)
    if simple is not None:
        notes.append(_FACET_NOTE)
        return Converted([Piece(write_obj_bytes(*simple))], None, notes)
    data = None if copied else write_obj_bytes(mesh.vertices, mesh.faces)
    shell = _is_shell(mesh.vertices, mesh.faces)
    return Converted([Piece(data, shell=shell)], _compute_hull_ratio(mesh), notes)


def _is_readable(mesh: Mesh) -> bool:
    if mesh.format == "stl":
        facts = read_stl_header(mesh.path)
        return (
            facts.kind == "binary"
            and facts.size_agrees
            and 0 < (facts.triangles or 0) <= MAX_STL_TRIANGLES
        )
    if mesh.format == "obj":
        data = b"\n" + mesh.path.read_bytes()
        # MuJoCo would include points without a face in the hull
        stray = data.count(b"\nv ") > len(mesh.vertices)
        if stray or LONG_FACE.search(data):
            return False
        return data.count(b"\no ") + data.count(b"\ng ") <= 1 and len(mesh.parts) == 1
    return False


def get_part_image(part: Part) -> Image | None:
    """Return the image of a part; None if the part has no valid texture coordinates."""
    if part.uv is None or not np.isfinite(part.uv).all():
        return None
    return part.image if part.texture is None else part.texture


def _group_by_material(mesh: Mesh) -> list[tuple[Part, Faces, Points | None]]:
    """Group the faces by color and image, with their texture coordinates, in file order."""
    looks: dict[tuple[Rgba | None, Path | bytes | None], list[Part]] = {}
    for part in mesh.parts:
        looks.setdefault((part.rgba, get_part_image(part)), []).append(part)
    groups = []
    for parts in looks.values():
        faces = np.concatenate([mesh.get_part_faces(part) for part in parts])
        known = [part.uv for part in parts if part.uv is not None and np.isfinite(part.uv).all()]
        uv = np.concatenate(known) if len(known) == len(parts) else None
        groups.append((parts[0], faces, uv))
    return groups


def _count_points(corners: Points) -> int:
    """Count the distinct points among the first 64, up to four."""
    return min(len(np.unique(corners.reshape(-1, 3)[:64], axis=0)), 4)


def _compute_thickness(points: Points) -> float:
    """Compute the extent of points along their thinnest direction, relative to their size."""
    centered = points - points.mean(axis=0)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    if size == 0:
        return 0.0
    normal = np.linalg.eigh(centered.T @ centered)[1][:, 0]
    return float(np.ptp(centered @ normal)) / size


def _convert_thick_obj(corners: Points) -> bytes:
    """Convert triangles, shape (n, 3, 3), to an OBJ of two offset layers connected by walls."""
    points = corners.reshape(-1, 3)
    size = float(np.linalg.norm(np.ptp(points, axis=0))) or 1e-3
    centered = points - points.mean(axis=0)
    normal = np.linalg.eigh(centered.T @ centered)[1][:, 0]
    offset = normal * size * THICKENED / 2
    if len(points) > MAX_FACET:
        points = np.unique(points, axis=0)
        layers = np.concatenate([points + offset, points - offset])
        hull = compute_convex_hull(layers)
        if hull is not None:
            return write_obj_bytes(*(_simplify_hull(layers) or extract_hull_surface(hull)))
        points = corners[0]
    layers = np.concatenate([points + offset, points - offset])
    count = len(points)
    faces = np.arange(count).reshape(-1, 3)
    walls = []
    for a, b in ((0, 1), (1, 2), (2, 0)):
        first, second = faces[:, a], faces[:, b]
        walls.append(np.stack([first, first + count, second], axis=1))
        walls.append(np.stack([second, first + count, second + count], axis=1))
    return write_obj_bytes(layers, np.concatenate([faces, faces[:, ::-1] + count, *walls]))


def _simplify_hull(points: Points) -> tuple[Points, Faces] | None:
    """Return a hull without a flat side of more than :data:`MAX_FACET` corners.

    The points are rounded to a grid as fine as possible, of at most 1024 cells along each axis.

    Returns:
        Its vertices and triangles; None if the hull has no such side.
    """
    cells = 1024
    low, size = points.min(axis=0), float(np.ptp(points, axis=0).max())
    rounded = points
    while len(rounded) > MAX_FACET and cells >= 64:
        hull = compute_convex_hull(rounded)
        if hull is None:
            break
        vertices, faces = extract_hull_surface(hull)
        if _count_facet_corners(vertices, faces) <= MAX_FACET:
            return None if rounded is points else (vertices, faces)
        grid = np.round((vertices - low) * (cells / size)) * (size / cells) + low
        rounded, cells = np.unique(grid, axis=0), cells // 2
    hull = None if rounded is points else compute_convex_hull(rounded)
    return None if hull is None else extract_hull_surface(hull)


def _count_facet_corners(vertices: Points, faces: Faces) -> int:
    """Count the corners of the largest flat side of a hull."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    return int(np.unique(np.round(normals, 5), axis=0, return_counts=True)[1].max()) + 2


def compute_signed_volume(vertices: Points, faces: Faces) -> float:
    """Compute the volume [m³] by the divergence theorem; it is exact for closed surfaces."""
    a, b, c = (vertices[faces[:, i]] - vertices[faces[0, 0]] for i in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6


def _is_shell(vertices: Points, faces: Faces) -> bool:
    extent = np.ptp(vertices[faces].reshape(-1, 3), axis=0)
    volume = compute_signed_volume(vertices, faces)
    return volume < 1e-12 or volume < 1e-3 * float(np.prod(extent))


def _compute_hull_ratio(mesh: Mesh) -> float | None:
    """Compute the ratio of the hull's volume to the mesh's; None for an open or flat mesh."""
    if not _is_closed(mesh):
        return None
    volume = compute_signed_volume(mesh.vertices, mesh.faces)
    if volume <= 0:
        return None
    hull = compute_convex_hull(mesh.vertices)
    return None if hull is None else float(hull.volume()) / volume


def _is_closed(mesh: Mesh) -> bool:
    """Tell whether every edge is used once in each direction, after merging equal points."""
    _, same = np.unique(mesh.vertices, axis=0, return_inverse=True)
    faces = same.reshape(-1)[mesh.faces]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    count = int(faces.max()) + 1
    forward = np.sort(edges[:, 0] * count + edges[:, 1])
    backward = np.sort(edges[:, 1] * count + edges[:, 0])
    return bool(np.array_equal(forward, backward))


def call_conversion(path: Path, collides: bool, gltf_up: GltfUp) -> Converted | str:
    """Call ``convert``; return the message of a MeshError, for use in a worker process."""
    try:
        return convert(path, collides=collides, gltf_up=gltf_up)
    except MeshError as error:
        return error.message
