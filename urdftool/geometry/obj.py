"""Wavefront OBJ with MTL: objects, groups, polygons, colors and images; it declares no unit."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..errors import MeshError
from ..source.access import is_companion_allowed
from .color import Rgba
from .limits import check_instances
from .mesh import MeshNote, Piece, Points, Reading
from .points import select_used

_MOST = 2**48
"""Largest vertex index; a larger one would overflow in numpy."""


@dataclass
class Material:
    """Diffuse color and image of a ``newmtl``."""

    rgb: tuple[float, float, float] | None = None
    opacity: float = 1.0
    texture: Path | None = None

    @property
    def rgba(self) -> Rgba | None:
        """Return the color with its opacity; None if the file has no ``Kd``."""
        return (*self.rgb, self.opacity) if self.rgb else None


def read(path: Path) -> Reading:
    """Read the faces of an OBJ file, one piece per run of an object and a material.

    Polygons are split into fans from their first corner: the signed triangles sum to a planar
    polygon even if it is not convex. Lines, points and curves are skipped.

    Raises:
        MeshError: As :func:`parse`, or a vertex is not three numbers.
    """
    written = parse(path)
    notes: list[MeshNote] = []
    materials = _read_materials(path, written.libraries, notes)
    vertices = _parse_vertices(written.points, path)
    texture_points = _parse_texture_points(written.texels)
    pieces = []
    for run in written.runs:
        used = materials.get(run.material, Material())
        faces = np.array(run.corners, dtype=np.int64).reshape(-1, 3)
        if faces.max(initial=-1) >= len(vertices):
            raise MeshError(
                f"a face of the OBJ file names vertex {faces.max() + 1} of {len(vertices)}",
                path=path,
            )
        used_vertices, rows = select_used(vertices, faces)
        pieces.append(
            Piece(
                used_vertices,
                rows,
                run.name or run.material,
                used.rgba,
                used.texture,
                uv=_make_uv(texture_points, run),
            )
        )
    return Reading(pieces, notes)


def _parse_texture_points(texels: list[str]) -> Points | None:
    """Parse the ``vt`` statements, shape (n, 2); None if there are none or one is not a number."""
    try:
        rows = [[*texel.split(), "0"][:2] for texel in texels]
        return np.array(rows, dtype=np.float64) if rows else None
    except ValueError:
        return None


def _make_uv(texture_points: Points | None, run: Run) -> Points | None:
    """Return the texture coordinates of a run's corners, shape (m, 3, 2); None if some lack one."""
    rows = np.array(run.texels, dtype=np.int64).reshape(-1, 3)
    if texture_points is None or not rows.size or 3 * len(rows) != len(run.corners):
        return None
    if rows.min() < 0 or rows.max() >= len(texture_points):
        return None
    return np.asarray(texture_points[rows])


def _parse_vertices(points: list[str], path: Path) -> Points:
    try:
        return np.array([point.split()[:3] for point in points], dtype=np.float64).reshape(-1, 3)
    except ValueError as error:
        raise MeshError(
            f"a vertex of the OBJ file is not three numbers ({error})", path=path
        ) from error


def _read_materials(path: Path, libraries: list[str], notes: list[MeshNote]) -> dict[str, Material]:
    materials: dict[str, Material] = {}
    seen: set[str] = set()
    for library in dict.fromkeys(libraries):
        file = path.parent / library
        if not os.path.isfile(file):
            message = f"{library} is not in the folder of the OBJ file, so the mesh has no colors"
            notes.append(MeshNote("obj-without-materials", message))
            continue
        if not is_companion_allowed(path, file):
            message = f"{library} may not be read; its colors are lost"
            notes.append(MeshNote("obj-without-materials", message, lossy=True))
            continue
        real = os.path.realpath(file)
        if real in seen:  # the same file in another spelling
            continue
        seen.add(real)
        current = Material()
        for _, line in list_logical_lines(file):
            keyword, _, rest = line.partition(" ")
            words = rest.split()
            if keyword == "newmtl":
                current = materials[rest.strip()] = Material()
            elif keyword in ("Kd", "d", "Tr") and words:
                _set_color(current, keyword, words)
            elif keyword == "map_Kd" and words:
                # options precede the name
                current.texture = path.parent / words[-1].replace("\\", "/")
    return materials


def _set_color(material: Material, keyword: str, words: list[str]) -> None:
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


@dataclass
class Run:
    """Triangles of one object and material, as zero-based vertex indices of their corners."""

    name: str
    material: str
    corners: list[int] = field(default_factory=list)
    texels: list[int] = field(default_factory=list)
    """Indices of texture coordinates, -1 for none; as long as ``corners``, or empty."""


class Statements(NamedTuple):
    """Statements of an OBJ file.

    Attributes:
        points: Arguments of the ``v`` statements.
        texels: Arguments of the ``vt`` statements.
        runs: Faces.
        libraries: Material files.
    """

    points: list[str]
    texels: list[str]
    runs: list[Run]
    libraries: list[str]


def parse(path: Path) -> Statements:
    """Parse the statements of an OBJ file; polygons become fans of triangles.

    Raises:
        MeshError: The file is binary, a face refers to an invalid vertex, or it has too many parts
            or triangles.
    """
    size, triangles = path.stat().st_size, 0
    points: list[str] = []
    texels: list[str] = []
    runs: list[Run] = []
    libraries: list[str] = []
    name = material = ""
    fresh = True
    for number, line in list_logical_lines(path):
        keyword, _, rest = line.partition(" ")
        if keyword == "v":
            points.append(rest)
        elif keyword == "vt":
            texels.append(rest)
        elif keyword == "f":
            if fresh:
                runs.append(Run(name, material))
                fresh = False
            triangles += _add_fan(rest, len(points), runs[-1].corners, path, number)
            check_instances(path, size, triangles=triangles, parts=len(runs))
            if texels:
                _add_texture_fan(rest, len(texels), runs[-1])
        elif keyword in ("o", "g"):
            name, fresh = rest.strip(), True
        elif keyword == "usemtl":
            material, fresh = rest.strip(), True
        elif keyword == "mtllib":
            libraries.append(rest.strip())
    return Statements(points, texels, runs, libraries)


def list_logical_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Yield numbered lines without comments, joined at trailing backslashes, tabs as spaces.

    Raises:
        MeshError: The file is binary.
    """
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


def _add_fan(rest: str, points: int, corners: list[int], path: Path, number: int) -> int:
    """Add the triangles of one ``f`` statement to ``corners``; return their number."""
    if _add_plain_triangle(rest, corners):
        return 1
    polygon = []
    for word in rest.split():
        try:
            index = int(word.partition("/")[0])
        except ValueError as error:
            raise MeshError(
                f"line {number} of the OBJ file: {word!r} is not the number of a vertex", path=path
            ) from error
        # negative indices count back from the last vertex so far
        index = index - 1 if index > 0 else points + index
        if not 0 <= index < _MOST or word.startswith("0"):
            raise MeshError(
                f"line {number} of the OBJ file names vertex {word}, of {points} so far; they are "
                "counted from 1",
                path=path,
            )
        polygon.append(index)
    for second in range(1, len(polygon) - 1):
        corners += (polygon[0], polygon[second], polygon[second + 1])
    return max(len(polygon) - 2, 0)


def _add_plain_triangle(rest: str, corners: list[int]) -> bool:
    """Add one triangle of positive indices, the usual face, and tell whether it is one."""
    try:
        one, two, three = [int(word.partition("/")[0]) for word in rest.split()]
    except ValueError:
        return False
    if not (0 < one <= _MOST and 0 < two <= _MOST and 0 < three <= _MOST):
        return False
    if rest.startswith("0") or " 0" in rest:
        return False
    corners += (one - 1, two - 1, three - 1)
    return True


def _add_texture_fan(rest: str, texels: int, run: Run) -> None:
    """Add the texture coordinates of the triangles of one ``f`` statement."""
    polygon = []
    for word in rest.split():
        try:
            index = int(word.split("/", 2)[1])
        except (IndexError, ValueError):
            index = 0
        place = index - 1 if index > 0 else texels + index if index < 0 else -1
        polygon.append(place if 0 <= place < _MOST else -1)
    for second in range(1, len(polygon) - 1):
        run.texels += (polygon[0], polygon[second], polygon[second + 1])
