"""Wavefront OBJ with its MTL: objects, groups, polygons and diffuse colours, in no unit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import MeshError
from .mesh import Piece, Points, Reading

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
    points: list[str] = []
    runs: list[tuple[str, str, list[tuple[int, ...]]]] = []
    libraries: list[str] = []
    name = material = ""
    fresh = True
    for number, line in _logical_lines(path):
        keyword, _, rest = line.partition(" ")
        if keyword == "v":
            points.append(rest)
        elif keyword == "f":
            if fresh:
                runs.append((name, material, []))
                fresh = False
            runs[-1][2].extend(_fan(rest, len(points), path, number))
        elif keyword in ("o", "g"):
            name, fresh = rest.strip(), True
        elif keyword == "usemtl":
            material, fresh = rest.strip(), True
        elif keyword == "mtllib":
            libraries.append(rest.strip())
    notes: list[str] = []
    materials = _materials(path, libraries, notes)
    vertices = _vertices(points, path)
    pieces = []
    for object_name, material_name, triangles in runs:
        used = materials.get(material_name, Material())
        faces = np.array(triangles, dtype=np.int64).reshape(-1, 3)
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
                object_name or material_name,
                used.rgba,
                used.texture,
            )
        )
    return Reading(pieces, notes)


def _logical_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Lines without comments, joined where they end in a backslash, with tabs as blanks."""
    text = path.read_text(encoding="utf-8", errors="replace").replace("\t", " ")
    if "\x00" in text[:1024]:
        raise MeshError("the file is binary; an OBJ file is text", path=path)
    held = ""
    for number, line in enumerate(text.splitlines(), start=1):
        if line.endswith("\\"):
            held += line[:-1] + " "
            continue
        full = (held + line).partition("#")[0].strip() if held or "#" in line else line.strip()
        held = ""
        if full:
            yield number, full


def _fan(rest: str, points: int, path: Path, number: int) -> Iterator[tuple[int, int, int]]:
    """Triangles of one ``f`` statement, with indices from zero."""
    corners = []
    for word in rest.split():
        try:
            index = int(word.partition("/")[0])
        except ValueError as error:
            raise MeshError(
                f"line {number} of the OBJ file: {word!r} is not the number of a vertex", path=path
            ) from error
        # negative numbers count back from the vertex read last
        index = index - 1 if index > 0 else points + index
        if index < 0 or word.startswith("0"):
            raise MeshError(
                f"line {number} of the OBJ file names vertex {word}, of {points} so far; they are "
                "counted from 1",
                path=path,
            )
        corners.append(index)
    for second in range(1, len(corners) - 1):
        yield corners[0], corners[second], corners[second + 1]


def _vertices(points: list[str], path: Path) -> Points:
    try:
        return np.array([point.split()[:3] for point in points], dtype=np.float64).reshape(-1, 3)
    except ValueError as error:
        raise MeshError(
            f"a vertex of the OBJ file is not three numbers ({error})", path=path
        ) from error


def _materials(path: Path, libraries: list[str], notes: list[str]) -> dict[str, Material]:
    materials: dict[str, Material] = {}
    for library in dict.fromkeys(libraries):
        file = path.parent / library
        if not file.is_file():
            notes.append(
                f"The material file {library} is not beside the OBJ file; colours are lost."
            )
            continue
        current = Material()
        for _, line in _logical_lines(file):
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
