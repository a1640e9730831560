"""Wavefront OBJ with its MTL: objects, groups, polygons, colours and images, in no unit."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import MeshError
from .mesh import MeshNote, Piece, Points, Reading
from .wavefront_text import Run, logical_lines, parse

Rgba = tuple[float, float, float, float]


@dataclass
class Material:
    """Diffuse colour and image of one ``newmtl``."""

    rgb: tuple[float, float, float] | None = None
    opacity: float = 1.0
    texture: Path | None = None

    @property
    def rgba(self) -> Rgba | None:
        """The colour with its opacity; None where the file gives no ``Kd``."""
        return (*self.rgb, self.opacity) if self.rgb else None


def read(path: Path) -> Reading:
    """The faces of an OBJ file, one piece for each run of an object and a material.

    Polygons are cut into fans from their first corner: in the plane of the polygon the signed
    triangles add up to it even where it is not convex. Lines, points and curves are left out.
    """
    written = parse(path)
    notes: list[MeshNote] = []
    materials = _materials(path, written.libraries, notes)
    vertices = _vertices(written.points, path)
    texture_points = _texture_points(written.texels)
    pieces = []
    for run in written.runs:
        used = materials.get(run.material, Material())
        faces = np.array(run.corners, dtype=np.int64).reshape(-1, 3)
        if faces.max(initial=-1) >= len(vertices):
            raise MeshError(
                f"a face of the OBJ file names vertex {faces.max() + 1} of {len(vertices)}",
                path=path,
            )
        kept, inverse = np.unique(faces, return_inverse=True)
        pieces.append(
            Piece(
                vertices[kept],
                inverse.reshape(-1, 3).astype(np.int64),
                run.name or run.material,
                used.rgba,
                used.texture,
                uv=_uv(texture_points, run),
            )
        )
    return Reading(pieces, notes)


def _texture_points(texels: list[str]) -> Points | None:
    """The ``vt`` statements, shape (n, 2); None where there are none, or one is no number."""
    try:
        rows = [[*texel.split(), "0"][:2] for texel in texels]
        return np.array(rows, dtype=np.float64) if rows else None
    except ValueError:
        return None


def _uv(texture_points: Points | None, run: Run) -> Points | None:
    """The texture coordinates of a run's corners; None unless each of them has one."""
    rows = np.array(run.texels, dtype=np.int64).reshape(-1, 3)
    if texture_points is None or not rows.size or 3 * len(rows) != len(run.corners):
        return None
    if rows.min() < 0 or rows.max() >= len(texture_points):
        return None
    return np.asarray(texture_points[rows])


def _vertices(points: list[str], path: Path) -> Points:
    try:
        return np.array([point.split()[:3] for point in points], dtype=np.float64).reshape(-1, 3)
    except ValueError as error:
        raise MeshError(
            f"a vertex of the OBJ file is not three numbers ({error})", path=path
        ) from error


def _materials(path: Path, libraries: list[str], notes: list[MeshNote]) -> dict[str, Material]:
    materials: dict[str, Material] = {}
    for library in dict.fromkeys(libraries):
        file = path.parent / library
        if not os.path.isfile(file):
            message = f"The material file {library} is not beside the OBJ file; colours are lost."
            notes.append(MeshNote("obj-without-materials", message, lossy=True))
            continue
        current = Material()
        for _, line in logical_lines(file):
            keyword, _, rest = line.partition(" ")
            words = rest.split()
            if keyword == "newmtl":
                current = materials[rest.strip()] = Material()
            elif keyword in ("Kd", "d", "Tr") and words:
                _colour(current, keyword, words)
            elif keyword == "map_Kd" and words:
                # options stand before the name, which is last
                current.texture = path.parent / words[-1].replace("\\", "/")
    return materials


def _colour(material: Material, keyword: str, words: list[str]) -> None:
    try:
        values = [float(word) for word in words[:3]]
    except ValueError:
        return
    if keyword == "Kd" and len(values) == 3:
        material.rgb = (values[0], values[1], values[2])
    elif keyword == "d":
        material.opacity = values[0]
    elif keyword == "Tr":
        material.opacity = 1.0 - values[0]
