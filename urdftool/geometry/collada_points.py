"""Positions of a COLLADA scene, without faces, materials and skins, by the XML parser."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from .mesh import Array, Points
from .points import IDENTITY, select_points, transform_points

_MAX_DEPTH = 64
_FACES = ("triangles", "polylist", "polygons", "trifans", "tristrips")


def read_collada_points(path: Path) -> Points | None:
    """Read the corners of the scene's faces [m], in the axes of the file; None if it has none.

    Raises:
        ValueError: The file is not a COLLADA file, or its nodes form a cycle.
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
    return np.concatenate(reader.found) if reader.found else None


class _Reader:
    """Traversal of a scene that collects its points; each source is parsed once."""

    def __init__(self, root: Any) -> None:
        self.space = root.tag.partition("}")[0] + "}" if root.tag.startswith("{") else ""
        self.named = {element.get("id"): element for element in root.iter() if element.get("id")}
        self.found: list[Points] = []
        self.read: dict[str, Points] = {}

    def walk(self, node: Any, above: Array, depth: int) -> None:
        """Add the points of a node and its descendants.

        Raises:
            ValueError: The nodes are nested too deep, as in a cycle.
        """
        if depth > _MAX_DEPTH:
            raise ValueError("nodes in a circle")
        matrix, tag = above, len(self.space)
        for child in node:
            kind = child.tag[tag:]
            if kind in _TRANSFORMS:
                values = [float(word) for word in (child.text or "").split()]
                matrix = matrix @ _TRANSFORMS[kind](values)
            elif kind == "node":
                self.walk(child, matrix, depth + 1)
            elif kind == "instance_node" and (other := self.target(child)) is not None:
                self.walk(other, matrix, depth + 1)
            elif kind == "instance_geometry" and (other := self.target(child)) is not None:
                self.add(other, matrix)
            elif kind == "instance_controller" and (other := self.target(child)) is not None:
                self.add_skin(other, matrix)

    def target(self, element: Any) -> Any:
        """Return the element to which an instance refers."""
        return self.named.get((element.get("url") or "")[1:])

    def add(self, geometry: Any, matrix: Array) -> None:
        """Add the positions of a geometry's faces, but not of points and lines."""
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
                    points = self.positions((entry.get("source") or "")[1:])
                    used = select_points(points, rows)
                    self.found.append(transform_points(used, matrix))

    def corners(self, primitive: Any) -> tuple[str, set[int]]:
        """Return the id of a primitive's ``<vertices>`` and the indices that its faces use."""
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

    def add_skin(self, controller: Any, matrix: Array) -> None:
        """Add the positions of a skin in its bind shape."""
        skin = controller.find(f"{self.space}skin")
        geometry = self.named.get((skin.get("source") or "")[1:]) if skin is not None else None
        if skin is None or geometry is None:
            return
        bind = skin.find(f"{self.space}bind_shape_matrix")
        if bind is not None and bind.text:
            matrix = matrix @ _matrix([float(word) for word in bind.text.split()])
        self.add(geometry, matrix)

    def positions(self, source: str) -> Points:
        """Return the rows of a ``<source>``, shape (n, 3)."""
        if source not in self.read:
            element = self.named[source]
            array = element.find(f"{self.space}float_array")
            accessor = element.find(f".//{self.space}accessor")
            stride = int(accessor.get("stride", 3)) if accessor is not None else 3
            values = np.array((array.text or "").split(), dtype=np.float64)
            whole = values[: len(values) // stride * stride]
            self.read[source] = whole.reshape(-1, stride)[:, :3]
        return self.read[source]


def _rows(text: str, offset: int, stride: int) -> set[int]:
    """Return the distinct numbers at one offset of each group of ``stride`` numbers."""
    return set(map(int, set(text.split()[offset::stride])))


def _matrix(values: list[float]) -> Array:
    if len(values) != 16:
        raise ValueError("a matrix is not 16 numbers")
    matrix: Array = np.array(values).reshape(4, 4)
    matrix[3] = IDENTITY[3]
    return matrix


def _translate(values: list[float]) -> Array:
    matrix: Array = IDENTITY.copy()
    x, y, z = values
    matrix[:3, 3] = x, y, z
    return matrix


def _scale(values: list[float]) -> Array:
    x, y, z = values
    matrix: Array = np.diag([x, y, z, 1.0])
    return matrix


def _rotate(values: list[float]) -> Array:
    (x, y, z), angle = values[:3], math.radians(values[3])
    length = math.hypot(x, y, z)
    x, y, z = (x / length, y / length, z / length) if length else (0.0, 0.0, 1.0)
    c, s = math.cos(angle), math.sin(angle)
    d = 1 - c
    matrix: Array = IDENTITY.copy()
    matrix[:3, :3] = [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
    ]
    return matrix


_TRANSFORMS = {"matrix": _matrix, "translate": _translate, "scale": _scale, "rotate": _rotate}
