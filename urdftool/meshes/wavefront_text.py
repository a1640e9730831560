"""What an OBJ file says, as text: its points, the triangles of its faces, its material files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from ..errors import MeshError

_MOST = 2**48
"""No file has so many points; numpy could not hold the number of one beyond."""


@dataclass
class Run:
    """Triangles of one object and material: rows of their corners, from zero."""

    name: str
    material: str
    corners: list[int] = field(default_factory=list)
    texels: list[int] = field(default_factory=list)
    """Rows of texture coordinates, -1 for none; as long as ``corners``, or empty."""


class Written(NamedTuple):
    """The statements of an OBJ file.

    Attributes:
        points: What follows ``v``.
        texels: What follows ``vt``.
        runs: The faces.
        libraries: The files of materials.
    """

    points: list[str]
    texels: list[str]
    runs: list[Run]
    libraries: list[str]


def parse(path: Path) -> Written:
    """The statements of an OBJ file, polygons as fans of triangles.

    Raises:
        MeshError: It is binary, or a face names a point that is not there.
    """
    points: list[str] = []
    texels: list[str] = []
    runs: list[Run] = []
    libraries: list[str] = []
    name = material = ""
    fresh = True
    for number, line in logical_lines(path):
        keyword, _, rest = line.partition(" ")
        if keyword == "v":
            points.append(rest)
        elif keyword == "vt":
            texels.append(rest)
        elif keyword == "f":
            if fresh:
                runs.append(Run(name, material))
                fresh = False
            _fan(rest, len(points), runs[-1].corners, path, number)
            if texels:
                _texture_fan(rest, len(texels), runs[-1])
        elif keyword in ("o", "g"):
            name, fresh = rest.strip(), True
        elif keyword == "usemtl":
            material, fresh = rest.strip(), True
        elif keyword == "mtllib":
            libraries.append(rest.strip())
    return Written(points, texels, runs, libraries)


def logical_lines(path: Path) -> Iterator[tuple[int, str]]:
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


def _fan(rest: str, points: int, corners: list[int], path: Path, number: int) -> None:
    """Add the triangles of one ``f`` statement."""
    polygon = []
    for word in rest.split():
        try:
            index = int(word.partition("/")[0])
        except ValueError as error:
            raise MeshError(
                f"line {number} of the OBJ file: {word!r} is not the number of a vertex", path=path
            ) from error
        # negative numbers count back from the vertex read last
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


def _texture_fan(rest: str, texels: int, run: Run) -> None:
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
