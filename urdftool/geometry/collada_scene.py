"""Scene of a COLLADA file: its geometries at their places, cut into triangles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple, TypeVar
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
import numpy.typing as npt

from ..errors import MeshError
from .limits import check_instances, check_tree
from .mesh import Array, Faces, MeshNote, Points
from .points import IDENTITY, select_used

MAX_DEPTH = 256
"""Largest depth of nested nodes; deeper files are rejected, as instances may form a cycle. Chosen,
no source."""

PRIMITIVES = ("triangles", "polylist", "polygons", "trifans", "tristrips")

Number = TypeVar("Number", np.float32, np.float64, np.int64)


class Instance(NamedTuple):
    """Geometry at its place in the scene.

    Attributes:
        geometry: Its element.
        matrix: Its pose and scale, shape (4, 4), with lengths in meters.
        element: The ``<instance_…>`` element, which binds its materials.
        is_skin: Whether it is the bind shape of a skin.
    """

    geometry: Element
    matrix: Array
    element: Element
    is_skin: bool


class TextureSet(NamedTuple):
    """Texture coordinates of a primitive: number of the set, points, and a row for each corner."""

    number: str
    points: Array
    rows: Faces


class Triangles(NamedTuple):
    """Triangles of one primitive, in the unit and axes of its geometry.

    Attributes:
        points: Those that the faces use, shape (n, 3).
        faces: Rows of the points, shape (m, 3).
        material: Symbol that an instance binds to a material.
        texture_sets: Texture coordinates, in the order of the file.
    """

    points: Points
    faces: Faces
    material: str
    texture_sets: list[TextureSet]

    def get_texture_coordinates(self, number: str | None) -> Points | None:
        """Return texture coordinates of a set, else the first, at each corner, shape (m, 3, 2).

        Returns:
            None if there are none, or a row is out of range.
        """
        if not self.texture_sets:
            return None
        first = self.texture_sets[0]
        chosen = next((one for one in self.texture_sets if one.number == number), first)
        rows = chosen.rows
        if not rows.size or rows.min() < 0 or rows.max() >= len(chosen.points):
            return None
        return np.asarray(chosen.points[rows][:, :, :2])


class _Input(NamedTuple):
    semantic: str
    offset: int
    source: str
    number: str


class _Node(NamedTuple):
    matrix: Array
    contents: list[Element | Instance]


class _Count(NamedTuple):
    """What a node shows, all instances in it included; ``height`` is its depth of nesting."""

    nodes: int
    parts: int
    triangles: int
    height: int


class Document:
    """COLLADA file; sources and primitives are parsed once, on demand."""

    def __init__(self, path: Path) -> None:
        """Parse the file.

        Raises:
            MeshError: It declares XML entities or an invalid unit, has too many elements, or has
                no scene.
            ElementTree.ParseError: It is not XML.
        """
        data = path.read_bytes()
        self._size = len(data)
        check_tree(path, data, b"<")
        if b"<!ENTITY" in data or "<!ENTITY".encode("utf-16-le") in data:
            raise MeshError(
                "the COLLADA file declares XML entities, which are not read; write their text out",
                path=path,
            )
        self.root = ElementTree.fromstring(data)
        tag = self.root.tag
        self.space = tag.partition("}")[0] + "}" if tag.startswith("{") else ""
        self._path = path
        self._named = {
            (element.tag, element.get("id")): element
            for element in self.root.iter()
            if element.get("id")
        }
        self._sources: dict[str, Array] = {}
        self._triangles: dict[Element, list[Triangles]] = {}
        self._nodes: dict[Element, _Node] = {}
        self._counts: dict[Element, _Count] = {}
        self.unit = self._read_unit()
        shown = self._find(self.root, "scene/instance_visual_scene")
        scene = self._follow(shown, "visual_scene") if shown is not None else None
        if scene is None:
            raise MeshError(
                "the COLLADA file shows no scene; it needs an instance_visual_scene", path=path
            )
        self._scene = scene

    def _find(self, element: Element, names: str) -> Element | None:
        return element.find("/".join(self.space + name for name in names.split("/")))

    def _follow(self, element: Element, kind: str, attribute: str = "url") -> Element | None:
        """Return the element of a kind to which a ``#…`` reference leads."""
        return self._named.get((self.space + kind, (element.get(attribute) or "")[1:]))

    def _read_unit(self) -> float:
        """Return the unit of lengths [m], 1 if none is declared."""
        element = self._find(self.root, "asset/unit")
        try:
            unit = float((element.get("meter") if element is not None else None) or 1.0)
        except ValueError:
            unit = 1.0
        if not (math.isfinite(unit) and unit > 0):
            raise MeshError(
                f"the COLLADA file declares a unit of {unit:g} m; a length above zero is needed",
                path=self._path,
            )
        return unit

    def make_notes(self) -> Iterator[MeshNote]:
        """Yield what users should know of the unit and the up axis of the file."""
        if not math.isclose(self.unit, 1.0):
            message = f"The COLLADA file is in units of {self.unit:g} m, which is applied."
            yield MeshNote("collada-unit", message)
        element = self._find(self.root, "asset/up_axis")
        up = (element.text or "").strip() if element is not None else "Z_UP"
        if up != "Z_UP":
            up = up if up in ("X_UP", "Y_UP") else "Y_UP"
            treatment = "not turned: RViz and Gazebo do not, PyBullet does"
            message = f"The up_axis of the COLLADA file is {up}, {treatment}."
            yield MeshNote("collada-up-axis", message)

    def find_instances(self) -> Iterator[Instance]:
        """Yield the geometries of the scene, once for each time that one is shown.

        Raises:
            MeshError: Nodes are nested too deeply, contain themselves, or exceed a limit with all
                instances; none was made.
        """
        roots = [child for child in self._scene if child.tag == self.space + "node"]
        for root in roots:
            self._count(root, 0)
        counts = [self._counts[root] for root in roots]
        check_instances(
            self._path,
            self._size,
            triangles=sum(count.triangles for count in counts),
            parts=sum(count.parts for count in counts),
            nodes=sum(count.nodes for count in counts),
        )
        matrix: Array = np.diag([self.unit, self.unit, self.unit, 1.0])
        for root in roots:
            yield from self._walk(root, matrix)

    def _count(self, node: Element, depth: int) -> _Count:
        """Count what a node shows; each node is counted once, however often it is shown."""
        known = self._counts.get(node)
        if depth + (known.height if known is not None else 0) > MAX_DEPTH:
            raise MeshError(
                f"the nodes of the COLLADA file are more than {MAX_DEPTH} deep; an instance_node "
                "may not contain itself",
                path=self._path,
            )
        if known is not None:
            return known
        nodes, parts, triangles, height = 1, 0, 0, 0
        for item in self._read_node(node).contents:
            if isinstance(item, Instance):
                count = self._count_geometry(item.geometry)
            else:
                count = self._count(item, depth + 1)
                height = max(height, count.height + 1)
            nodes, parts = nodes + count.nodes, parts + count.parts
            triangles += count.triangles
        self._counts[node] = _Count(nodes, parts, triangles, height)
        return self._counts[node]

    def _count_geometry(self, geometry: Element) -> _Count:
        if geometry not in self._counts:
            primitives = self.read_triangles(geometry)
            triangles = sum(len(one.faces) for one in primitives)
            self._counts[geometry] = _Count(1, len(primitives), triangles, 0)
        return self._counts[geometry]

    def _walk(self, node: Element, above: Array) -> Iterator[Instance]:
        read = self._read_node(node)
        matrix = above @ read.matrix
        for item in read.contents:
            if isinstance(item, Instance):
                yield item._replace(matrix=matrix @ item.matrix)
            else:
                yield from self._walk(item, matrix)

    def _read_node(self, node: Element) -> _Node:
        """Return the pose of a node in the one above, and its inner nodes and geometries."""
        if node not in self._nodes:
            matrix = IDENTITY
            contents: list[Element | Instance] = []
            for child in node:
                kind = child.tag[len(self.space) :]
                other: Element | None
                if kind in _TRANSFORMS:
                    matrix = matrix @ _TRANSFORMS[kind](_parse_numbers(child.text, np.float64))
                elif kind == "node":
                    contents.append(child)
                elif kind == "instance_node":
                    if (other := self._follow(child, "node")) is not None:
                        contents.append(other)
                elif kind == "instance_geometry":
                    if (other := self._follow(child, "geometry")) is not None:
                        contents.append(Instance(other, IDENTITY, child, is_skin=False))
                elif kind == "instance_controller":
                    contents += self._find_skin(child)
            self._nodes[node] = _Node(matrix, contents)
        return self._nodes[node]

    def _find_skin(self, element: Element) -> Iterator[Instance]:
        """Yield the geometry of a skin in its bind shape."""
        controller = self._follow(element, "controller")
        skin = self._find(controller, "skin") if controller is not None else None
        geometry = self._follow(skin, "geometry", "source") if skin is not None else None
        if skin is None or geometry is None:
            return
        matrix: Array = IDENTITY
        bind = self._find(skin, "bind_shape_matrix")
        if bind is not None and bind.text:
            matrix = _make_matrix(_parse_numbers(bind.text, np.float64))
        yield Instance(geometry, matrix, element, is_skin=True)

    def read_triangles(self, geometry: Element) -> list[Triangles]:
        """Return the triangles of a geometry's mesh, one item for each primitive that has any.

        Raises:
            MeshError: Polygons cannot be triangulated, or a corner names a point out of range.
            ValueError: Numbers are malformed.
        """
        known = self._triangles.get(geometry)
        if known is None:
            mesh = self._find(geometry, "mesh")
            primitives = () if mesh is None else mesh
            read = (self._read_primitive(geometry, primitive) for primitive in primitives)
            known = self._triangles[geometry] = [one for one in read if one is not None]
        return known

    def _read_primitive(self, geometry: Element, primitive: Element) -> Triangles | None:
        kind = primitive.tag[len(self.space) :]
        if kind not in PRIMITIVES:
            return None
        inputs = self._list_inputs(primitive)
        positions = next((one for one in inputs if one.semantic == "POSITION"), None)
        if positions is None:
            return None
        named = geometry.get("id") or ""
        stride = 1 + max(one.offset for one in inputs)
        corners = self._read_corners(primitive, kind, stride, named)
        if not len(corners):
            return None
        points = self._read_source(positions.source)
        faces = np.ascontiguousarray(corners[:, :, positions.offset])
        if faces.min() < 0 or faces.max() >= len(points):
            raise MeshError(
                f"geometry {named!r} of the COLLADA file names vertex {faces.max()} of "
                f"{len(points)}; they are counted from 0",
                path=self._path,
            )
        if points.shape[1] < 3:
            raise ValueError(f"the points of geometry {named!r} have less than 3 coordinates")
        sets = [
            TextureSet(
                one.number,
                self._read_source(one.source),
                np.ascontiguousarray(corners[:, :, one.offset]),
            )
            for one in inputs
            if one.semantic == "TEXCOORD"
        ]
        points, faces = select_used(points[:, :3], faces)
        return Triangles(points, faces, primitive.get("material") or "", sets)

    def _list_inputs(self, primitive: Element) -> list[_Input]:
        """Return the inputs of a primitive, those of its ``<vertices>`` included."""
        inputs = []
        for entry in primitive.iterfind(f"{self.space}input"):
            offset, number = int(entry.get("offset") or 0), entry.get("set") or "0"
            semantic, source = entry.get("semantic") or "", (entry.get("source") or "")[1:]
            if semantic != "VERTEX":
                inputs.append(_Input(semantic, offset, source, number))
                continue
            vertices = self._follow(entry, "vertices", "source")
            for inner in () if vertices is None else vertices.iterfind(f"{self.space}input"):
                semantic, source = inner.get("semantic") or "", (inner.get("source") or "")[1:]
                inputs.append(_Input(semantic, offset, source, number))
        return inputs

    def _read_corners(self, primitive: Element, kind: str, stride: int, geometry: str) -> Faces:
        """Return what the three corners of each triangle name, shape (m, 3, stride)."""
        texts = [p.text or "" for p in primitive.iterfind(f"{self.space}p")]
        if not texts:
            return np.zeros((0, 3, stride), dtype=np.int64)
        if kind == "polygons":
            corners = _parse_numbers(" ".join(texts), np.int64).reshape(-1, stride)
            counts = np.array([len(text.split()) for text in texts])
            if (counts % stride).any():
                raise ValueError(f"a polygon of geometry {geometry!r} has a part of a corner")
            return _split_fans(corners, counts // stride)
        runs = [_parse_numbers(text, np.int64).reshape(-1, stride) for text in texts]
        if kind == "triangles":
            return np.concatenate(runs).reshape(-1, 3, stride)
        if kind == "tristrips":
            return np.concatenate([_split_strip(run) for run in runs])
        if kind == "polylist":
            table = np.concatenate(runs)
            vcount = self._find(primitive, "vcount")
            sizes = _parse_numbers(vcount.text if vcount is not None else "", np.int64)
            total = sizes.sum(dtype=np.float64) if len(sizes) else 0
            if total > len(table) or (len(sizes) and sizes.min() < 0):
                raise MeshError(
                    f"the polygons of geometry {geometry!r} of the COLLADA file cannot be cut into "
                    f"triangles (vcount requires {total:.0f} corners, of which there are "
                    f"{len(table)}); export or fetch it again",
                    path=self._path,
                )
            return _split_fans(table, sizes)
        return np.concatenate([_split_fans(run, np.array([len(run)])) for run in runs])

    def _read_source(self, name: str) -> Array:
        """Return the rows of a ``<source>``.

        Raises:
            ValueError: It is missing or malformed.
        """
        if name not in self._sources:
            element = self._named.get((self.space + "source", name))
            array = self._find(element, "float_array") if element is not None else None
            if element is None or array is None:
                raise ValueError(f"it has no numbers of the source {name!r}")
            accessor = self._find(element, "technique_common/accessor")
            parameters = list(accessor) if accessor is not None else []
            written = accessor.get("stride") if accessor is not None else None
            stride = int(written) if written else len(parameters) or 3
            values = _parse_numbers(array.text, np.float32).astype(np.float64)
            self._sources[name] = values.reshape(-1, stride)
        return self._sources[name]


def _parse_numbers(text: str | None, kind: type[Number]) -> npt.NDArray[Number]:
    """Parse numbers that are separated by whitespace.

    Raises:
        ValueError: One of them is malformed.
    """
    if text is None or not text.strip():
        return np.zeros(0, dtype=kind)
    return np.fromstring(text, dtype=kind, sep=" ")


def _split_strip(corners: Faces) -> Faces:
    """Cut a strip into triangles, shape (m, 3, …); every second one is reversed."""
    triangles = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    triangles[1::2] = triangles[1::2, ::-1]
    return triangles


def _split_fans(corners: Faces, counts: Faces) -> Faces:
    """Cut polygons, given by their numbers of corners, into fans of triangles, shape (m, 3, …)."""
    first = np.cumsum(counts) - counts
    amounts = np.maximum(counts - 2, 0)
    start = np.repeat(first, amounts)
    step = np.arange(amounts.sum()) - np.repeat(np.cumsum(amounts) - amounts, amounts)
    return np.stack([corners[start], corners[start + step + 1], corners[start + step + 2]], axis=1)


def _make_matrix(values: Array) -> Array:
    if len(values) != 16:
        raise ValueError("a matrix is not 16 numbers")
    matrix: Array = values.reshape(4, 4).copy()
    matrix[3] = IDENTITY[3]
    return matrix


def _make_translation(values: Array) -> Array:
    matrix: Array = IDENTITY.copy()
    x, y, z = values
    matrix[:3, 3] = x, y, z
    return matrix


def _make_scale(values: Array) -> Array:
    x, y, z = values
    matrix: Array = np.diag([x, y, z, 1.0])
    return matrix


def _make_rotation(values: Array) -> Array:
    x, y, z, degrees = values.tolist()
    angle, length = math.radians(degrees), math.hypot(x, y, z)
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


def _reject_skew(_: Array) -> Array:
    raise ValueError("<skew> is not supported")


_TRANSFORMS: dict[str, Callable[[Array], Array]] = {
    "matrix": _make_matrix,
    "translate": _make_translation,
    "scale": _make_scale,
    "rotate": _make_rotation,
    "skew": _reject_skew,
}
"""Transforms of nodes; ``<lookat>`` is for cameras, and ignored."""
