"""COLLADA (.dae): a scene of nodes with geometries, in the unit the file declares.

How the consumers of a robot description read ``<asset>``, according to their sources:

- ``<unit meter>``: RViz (assimp puts it into the root node) and Gazebo (``ColladaLoader`` in Gazebo
  Classic and gz-common scales the finished mesh) apply it. So does this reader.
- ``<up_axis>``: RViz sets assimp's IGNORE_UP_DIRECTION, Gazebo's loader ignores the element, and
  MoveIt drops the rotation that assimp derives from it. All three leave Y_UP files unrotated, as
  this reader does. PyBullet rotates them; a note reports that if it matters.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import numpy as np

from ..errors import MeshError
from ..extras import make_missing_error
from .mesh import MeshNote, Piece, Points, Reading

MAX_DEPTH = 256
"""Largest depth of nested nodes; deeper files are rejected, as instances may form a cycle."""


def read(path: Path) -> Reading:
    """Read the triangles of a COLLADA scene [m], one piece per primitive of each instance.

    Node transforms are applied in full; mirrored instances have their winding reversed. Skins are
    read in their bind shape, without joints. Lines are skipped.

    Args:
        path: The file.

    Raises:
        MeshError: The file is malformed, declares XML entities or an invalid unit, or has no scene.
        MissingDependency: pycollada is not installed.
    """
    notes: list[MeshNote] = []
    document = _parse(path, notes)
    unit = 1.0 if document.assetInfo.unitmeter is None else float(document.assetInfo.unitmeter)
    if not (math.isfinite(unit) and unit > 0):
        raise MeshError(
            f"the COLLADA file declares a unit of {unit:g} m; a length above zero is needed",
            path=path,
        )
    if not math.isclose(unit, 1.0):
        message = f"The COLLADA file is in units of {unit:g} m, which is applied."
        notes.append(MeshNote("collada-unit", message))
    up = str(document.assetInfo.upaxis or "Y_UP")
    if up != "Z_UP" and "up_axis" in _asset_children(document):
        done = "not turned: RViz and Gazebo do not, PyBullet does"
        message = f"The up_axis of the COLLADA file is {up}, {done}."
        notes.append(MeshNote("collada-up-axis", message))
    matrix = np.diag([unit, unit, unit, 1.0])
    if document.scene is None:
        raise MeshError(
            "the COLLADA file shows no scene; it needs an instance_visual_scene", path=path
        )
    pieces: list[Piece] = []
    for node in document.scene.nodes:
        pieces.extend(_node_pieces(node, matrix, path, notes, 0))
    return Reading(pieces, list(dict.fromkeys(notes)))


def _parse(path: Path, notes: list[MeshNote]) -> Any:
    try:
        import collada
    except ModuleNotFoundError as error:
        raise make_missing_error("collada", "reading a COLLADA mesh (.dae)") from error

    head = path.read_bytes()
    if b"<!ENTITY" in head or "<!ENTITY".encode("utf-16-le") in head:
        raise MeshError(
            "the COLLADA file declares XML entities, which are not read; write their text out",
            path=path,
        )
    try:
        with open(path, "rb") as file:
            document = collada.Collada(file, ignore=[collada.common.DaeError])
        if document.errors and _drop_broken_materials(document):
            message = "A material of the COLLADA file is broken; its colour is lost."
            notes.append(MeshNote("collada-broken-material", message, lossy=True))
            repaired = BytesIO()
            document.xmlnode.write(repaired)
            repaired.seek(0)
            document = collada.Collada(repaired, ignore=[collada.common.DaeError])
        return document
    # the parser raises arbitrary exceptions for malformed files
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"the COLLADA file cannot be read ({reason}); export or fetch it again", path=path
        ) from error


def _drop_broken_materials(document: Any) -> bool:
    """Remove bindings to broken materials, with which pycollada drops the geometry, too."""
    known = {f"#{material.id}" for material in document.materials}
    broken = [
        (parent, child)
        for parent in document.xmlnode.getroot().iter()
        for child in parent
        if str(child.tag).endswith("}instance_material") and child.get("target") not in known
    ]
    for parent, child in broken:
        parent.remove(child)
    return bool(broken)


def _asset_children(document: Any) -> set[str]:
    root = document.xmlnode.getroot()
    return {
        str(child.tag).rpartition("}")[2]
        for asset in root
        if str(asset.tag).endswith("}asset")
        for child in asset
    }


def _node_pieces(
    node: Any, matrix: Points, path: Path, notes: list[MeshNote], depth: int
) -> Iterator[Piece]:
    import collada

    if depth > MAX_DEPTH:
        raise MeshError(
            f"the nodes of the COLLADA file are more than {MAX_DEPTH} deep; an instance_node may "
            "not contain itself",
            path=path,
        )
    if isinstance(node, collada.scene.Node):
        inner = matrix @ np.asarray(node.matrix, dtype=np.float64)
        for child in node.children or ():
            yield from _node_pieces(child, inner, path, notes, depth + 1)
    elif isinstance(node, collada.scene.GeometryNode):
        yield from _geometry_pieces(node.geometry, node.materials, matrix, path)
    elif isinstance(node, collada.scene.ControllerNode):
        geometry = getattr(node.controller, "geometry", None)
        bind = getattr(node.controller, "bind_shape_matrix", None)
        if geometry is not None:
            message = "A skin of the COLLADA file is read in its bind shape, without its joints."
            notes.append(MeshNote("collada-skin", message))
            inner = matrix if bind is None else matrix @ np.asarray(bind, dtype=np.float64)
            yield from _geometry_pieces(geometry, node.materials, inner, path)


def _geometry_pieces(geometry: Any, bound: Any, matrix: Points, path: Path) -> Iterator[Piece]:
    materials = {material.symbol: material for material in bound}
    for written in geometry.primitives:
        # triangleset() splits polygons into fans
        try:
            counts, index = getattr(written, "vcounts", None), getattr(written, "index", ())
            if counts is not None and len(counts) and np.sum(counts, dtype=float) > len(index):
                raise ValueError(f"they want {counts.sum()} corners, and there are {len(index)}")
            primitive = written.triangleset() if hasattr(written, "triangleset") else written
        except (ValueError, IndexError, TypeError) as error:  # invalid counts
            raise MeshError(
                f"the polygons of geometry {geometry.id!r} of the COLLADA file cannot be cut into "
                f"triangles ({error}); export or fetch it again",
                path=path,
            ) from error
        corners = getattr(primitive, "vertex_index", None)
        if primitive.vertex is None or corners is None or np.ndim(corners) != 2:
            continue
        if corners.shape[1] != 3:
            continue
        faces = np.asarray(corners, dtype=np.int64)
        if faces.size and (faces.min() < 0 or faces.max() >= len(primitive.vertex)):
            raise MeshError(
                f"geometry {geometry.id!r} of the COLLADA file names vertex {faces.max()} of "
                f"{len(primitive.vertex)}; they are counted from 0",
                path=path,
            )
        points = np.asarray(primitive.vertex, dtype=np.float64)[:, :3]
        points = points @ matrix[:3, :3].T + matrix[:3, 3]
        material = materials.get(primitive.material)
        effect = material.target.effect if material is not None else None
        rgba, texture = _diffuse(effect, path)
        uv = _uv(primitive, material)
        if np.linalg.det(matrix[:3, :3]) < 0:
            faces = faces[:, ::-1]
            uv = None if uv is None else uv[:, ::-1]
        name = geometry.name or geometry.id or ""
        yield Piece(points, np.ascontiguousarray(faces), name, rgba, texture, uv=uv)


def _uv(primitive: Any, material: Any) -> Points | None:
    """Return the texture coordinates bound to the image of each corner, or else the first set.

    Returns:
        Shape (m, 3, 2); None if there are none or they are out of range.
    """
    sets = getattr(primitive, "texcoordset", None)
    if not sets:
        return None
    chosen = 0
    channel = getattr(getattr(getattr(material, "target", None), "effect", None), "diffuse", None)
    wanted = [
        number
        for semantic, _, number in getattr(material, "inputs", ())
        if semantic == getattr(channel, "texcoord", None)
    ]
    written = [str(source[3] or 0) for source in primitive.sources["TEXCOORD"]]
    if wanted and str(wanted[0] or 0) in written:
        chosen = written.index(str(wanted[0] or 0))
    points = np.asarray(sets[chosen], dtype=np.float64)
    rows = primitive.texcoord_indexset[chosen]
    if not rows.size or rows.min() < 0 or rows.max() >= len(points):
        return None
    return np.asarray(points[rows][:, :, :2])


def _diffuse(
    effect: Any, path: Path
) -> tuple[tuple[float, float, float, float] | None, Path | None]:
    diffuse = getattr(effect, "diffuse", None)
    if isinstance(diffuse, tuple) and len(diffuse) in (3, 4):
        red, green, blue, alpha = (*(float(value) for value in diffuse), 1.0)[:4]
        return (red, green, blue, alpha), None
    surface = getattr(getattr(diffuse, "sampler", None), "surface", None)
    image = getattr(getattr(surface, "image", None), "path", None)
    if not image:
        return None, None
    # images are named by URIs, in practice also by Windows paths
    name = unquote(urlsplit(str(image)).path) if str(image).startswith("file:") else str(image)
    return None, path.parent / unquote(name).replace("\\", "/")
