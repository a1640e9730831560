"""The positions of a COLLADA scene, without its faces, materials and skins."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from .positions import UPRIGHT, Affine, Columns, chosen, is_much, joined, moved, numbers, product

_MAX_DEPTH = 64
_FACES = ("triangles", "polylist", "polygons", "trifans", "tristrips")


def collada_columns(path: Path) -> Columns | None:
    """The corners of the scene's faces [m], in the axes of the file; None if it has none.

    Raises:
        ValueError: The file is no COLLADA file, or its nodes form a circle.
    """
    data = path.read_bytes()
    if b"<!ENTITY" in data or "<!ENTITY".encode("utf-16-le") in data:
        raise ValueError("entities")
    try:
        root = ElementTree.fromstring(data)
    except ElementTree.ParseError as error:
        raise ValueError(str(error)) from error
    reader = _Reader(root)
    unit = root.find(f"{reader.space}asset/{reader.space}unit")
    factor = float(unit.get("meter", 1.0)) if unit is not None else 1.0
    scene = root.find(f"{reader.space}scene/{reader.space}instance_visual_scene")
    shown = reader.named.get((scene.get("url") or "")[1:]) if scene is not None else None
    if shown is None:
        return None
    for child in shown:
        if child.tag == f"{reader.space}node":
            reader.walk(child, _scale([factor] * 3), 0)
    return joined(reader.found) if reader.found else None


class _Reader:
    """A scene on its way to being points; sources are read once."""

    def __init__(self, root: Any) -> None:
        self.space = root.tag.partition("}")[0] + "}" if root.tag.startswith("{") else ""
        self.named = {element.get("id"): element for element in root.iter() if element.get("id")}
        self.found: list[Columns] = []
        self.read: dict[str, Columns] = {}

    def walk(self, node: Any, above: Affine, depth: int) -> None:
        """Add the points of a node and of those below it."""
        if depth > _MAX_DEPTH:
            raise ValueError("nodes in a circle")
        matrix, tag = above, len(self.space)
        for child in node:
            kind = child.tag[tag:]
            if kind in _TRANSFORMS:
                values = [float(word) for word in (child.text or "").split()]
                matrix = product(matrix, _TRANSFORMS[kind](values))
            elif kind == "node":
                self.walk(child, matrix, depth + 1)
            elif kind == "instance_node" and (other := self.target(child)) is not None:
                self.walk(other, matrix, depth + 1)
            elif kind == "instance_geometry" and (other := self.target(child)) is not None:
                self.add(other, matrix)
            elif kind == "instance_controller" and (other := self.target(child)) is not None:
                self.add_skin(other, matrix)

    def target(self, element: Any) -> Any:
        """What an instance is one of."""
        return self.named.get((element.get("url") or "")[1:])

    def add(self, geometry: Any, matrix: Affine) -> None:
        """Add the positions of a geometry's faces; points and lines are not a surface."""
        corners: dict[str, set[int]] = {}
        for child in geometry.iter():
            if child.tag[len(self.space) :] in _FACES:
                source, rows = self.corners(child)
                corners.setdefault(source, set()).update(rows)
        if not corners:
            return
        for vertices in geometry.iterfind(f".//{self.space}vertices"):
            rows = corners.get(vertices.get("id") or "", set())
            for entry in vertices.iterfind(f"{self.space}input"):
                if entry.get("semantic") == "POSITION" and rows:
                    columns = self.positions((entry.get("source") or "")[1:])
                    self.found.append(moved(chosen(columns, rows), matrix))

    def corners(self, primitive: Any) -> tuple[str, set[int]]:
        """The ``<vertices>`` that faces are made of, and the numbers of those that they have."""
        source, offset, stride = "", 0, 1
        for entry in primitive.iterfind(f"{self.space}input"):
            at = int(entry.get("offset") or 0)
            stride = max(stride, at + 1)
            if entry.get("semantic") == "VERTEX":
                source, offset = (entry.get("source") or "")[1:], at
        rows: set[int] = set()
        for p in primitive.iter(f"{self.space}p"):
            rows |= _rows(p.text or "", offset, stride)
        return source, rows

    def add_skin(self, controller: Any, matrix: Affine) -> None:
        """Add the positions of a skin in its bind shape."""
        skin = controller.find(f"{self.space}skin")
        geometry = self.named.get((skin.get("source") or "")[1:]) if skin is not None else None
        if skin is None or geometry is None:
            return
        bind = skin.find(f"{self.space}bind_shape_matrix")
        if bind is not None and bind.text:
            matrix = product(matrix, _matrix([float(word) for word in bind.text.split()]))
        self.add(geometry, matrix)

    def positions(self, source: str) -> Columns:
        """The rows of a ``<source>``."""
        if source not in self.read:
            element = self.named[source]
            array = element.find(f"{self.space}float_array")
            accessor = element.find(f".//{self.space}accessor")
            stride = int(accessor.get("stride", 3)) if accessor is not None else 3
            values = numbers((array.text or "").split())
            whole = values[: len(values) // stride * stride]
            self.read[source] = whole[0::stride], whole[1::stride], whole[2::stride]
        return self.read[source]


def _rows(text: str, offset: int, stride: int) -> set[int]:
    """Every number of a text at one place of each group."""
    if is_much(0.03 * len(text)):
        import numpy as np

        try:
            numbers_of = np.fromstring(text, dtype=np.int64, sep=" ")
        except (ValueError, DeprecationWarning) as error:  # not all of it is numbers
            raise ValueError("corners are not numbers") from error
        return set(np.unique(numbers_of[offset::stride]).tolist())
    return set(map(int, set(text.split()[offset::stride])))


def _matrix(values: list[float]) -> Affine:
    if len(values) != 16:
        raise ValueError("a matrix is not 16 numbers")
    a, b, c = (tuple(values[row : row + 4]) for row in (0, 4, 8))
    return a, b, c  # type: ignore[return-value]


def _translate(values: list[float]) -> Affine:
    return tuple((*row[:3], value) for row, value in zip(UPRIGHT, values, strict=True))


def _scale(values: list[float]) -> Affine:
    x, y, z = values
    return (x, 0.0, 0.0, 0.0), (0.0, y, 0.0, 0.0), (0.0, 0.0, z, 0.0)


def _rotate(values: list[float]) -> Affine:
    (x, y, z), angle = values[:3], math.radians(values[3])
    length = math.hypot(x, y, z)
    x, y, z = (x / length, y / length, z / length) if length else (0.0, 0.0, 1.0)
    c, s = math.cos(angle), math.sin(angle)
    d = 1 - c
    return (
        (c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0.0),
        (y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0.0),
        (z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0.0),
    )


_TRANSFORMS = {"matrix": _matrix, "translate": _translate, "scale": _scale, "rotate": _rotate}
