"""COLLADA (.dae): a scene of nodes with geometries, in the unit the file declares.

How the consumers of a robot description read ``<asset>``, according to their sources:

- ``<unit meter>``: RViz (assimp puts it into the root node) and Gazebo (``ColladaLoader`` in Gazebo
  Classic and gz-common scales the finished mesh) apply it. So does this reader.
- ``<up_axis>``: RViz sets assimp's IGNORE_UP_DIRECTION, Gazebo's loader ignores the element, and
  MoveIt drops the rotation that assimp derives from it. All three leave Y_UP files unrotated, as
  this reader does. PyBullet rotates them; a note reports that if it matters.

Coordinates are rounded to 32 bits, as assimp stores them.

Why not pycollada (0.9.3 was compared on 336 files): it reads 330 of them as this reader does, and
nothing of 4 (of ANYmal's foot, because an image is missing); it takes NaN for 0 and ignores a
malformed transform, 26 bytes of ``vcount`` make it allocate 15 GB, and 4,000 nodes that each show
the next take 210 s.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from xml.etree.ElementTree import ParseError

import numpy as np

from ..errors import MeshError
from .collada_materials import Appearance, Materials
from .collada_scene import Document, Instance, Triangles
from .mesh import MeshNote, Piece, Points, Reading
from .points import transform_points


def read(path: Path) -> Reading:
    """Read the triangles of a COLLADA scene [m], one piece per primitive of each instance.

    Node transforms are applied in full; mirrored instances have their winding reversed. Skins are
    read in their bind shape, without joints. Lines are skipped.

    Raises:
        MeshError: The file is malformed, declares XML entities or an invalid unit, or has no scene.
    """
    with _raise_mesh_errors(path):
        document = Document(path)
        materials = Materials(document.root, document.space, path)
        notes = []
        if materials.has_broken_binding():
            message = "A material of the COLLADA file is broken; its color is lost."
            notes.append(MeshNote("collada-broken-material", message, lossy=True))
        notes += document.make_notes()
        pieces = []
        for instance in document.find_instances():
            if instance.is_skin:
                message = (
                    "A skin of the COLLADA file is read in its bind shape, without its joints."
                )
                notes.append(MeshNote("collada-skin", message))
            bindings = materials.find_bindings(instance.element)
            for triangles in document.read_triangles(instance.geometry):
                appearance = materials.read_appearance(bindings.get(triangles.material))
                pieces.append(_make_piece(instance, triangles, appearance))
    return Reading(pieces, list(dict.fromkeys(notes)))


def _make_piece(instance: Instance, triangles: Triangles, appearance: Appearance) -> Piece:
    """Place triangles in the scene; a mirrored instance has their winding reversed."""
    faces, uv = triangles.faces, triangles.get_texture_coordinates(appearance.uv_set)
    if np.linalg.det(instance.matrix[:3, :3]) < 0:
        faces = np.ascontiguousarray(faces[:, ::-1])
        uv = None if uv is None else uv[:, ::-1]
    points = transform_points(triangles.points, instance.matrix)
    name = instance.geometry.get("name") or instance.geometry.get("id") or ""
    return Piece(points, faces, name, appearance.rgba, appearance.image, uv=uv)


def read_points(path: Path) -> Points | None:
    """Read the corners of a COLLADA scene's triangles [m], shape (n, 3); None if it has none.

    Raises:
        MeshError: As :func:`read`.
    """
    with _raise_mesh_errors(path):
        document = Document(path)
        points = [
            transform_points(triangles.points, instance.matrix)
            for instance in document.find_instances()
            for triangles in document.read_triangles(instance.geometry)
        ]
    return np.concatenate(points) if points else None


@contextmanager
def _raise_mesh_errors(path: Path) -> Iterator[None]:
    """Raise a MeshError for any error that a damaged file causes."""
    try:
        yield
    except (
        ValueError,
        LookupError,
        TypeError,
        ArithmeticError,
        RecursionError,
        ParseError,
    ) as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"the COLLADA file cannot be read ({reason}); export or fetch it again", path=path
        ) from error
