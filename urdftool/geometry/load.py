"""Reading of mesh files in all supported formats."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np

from ..errors import MeshError
from .image_file import is_special
from .mesh import Mesh, MeshNote, Part, Piece, Reading
from .points import select_used
from .stl_header import is_lfs_pointer

if TYPE_CHECKING:
    from ..source.description import Description, GltfUp

# suffix -> module of this package with a function ``read``
READERS = {
    "stl": "stl",
    "obj": "obj",
    "dae": "collada",
    "ply": "ply",
    "gltf": "gltf",
    "glb": "gltf",
}

FARTHEST = 1e12
"""Largest coordinate [m]; the cubes of lengths beyond it would overflow."""


def load_mesh(
    path: str | Path,
    scale: Sequence[float] = (1.0, 1.0, 1.0),
    *,
    gltf_up: GltfUp = "y",
) -> Mesh:
    """Read the triangles of a mesh file [m], in the frame of the ``<geometry>`` as in RViz.

    Unit and axes of each format:

    - STL, OBJ, PLY: coordinates are in meters, axes are kept.
    - COLLADA: ``<unit meter>`` is applied; ``<up_axis>`` is ignored, as by RViz, Gazebo and MoveIt
      (PyBullet rotates the mesh).
    - glTF: meters; Y becomes Z, as in the standard and in RViz (Gazebo keeps the axes), unless
      ``gltf_up`` is ``z``.

    Args:
        path: A file whose suffix, in any case, is its format: stl, obj, dae, ply, gltf or glb.
        scale: The three factors of URDF's ``<mesh scale>``, applied last. If their product is
            negative, the mesh is mirrored and its winding reversed, so that its volume keeps its
            sign.
        gltf_up: Up axis of a glTF file; ``z`` keeps its axes.

    Raises:
        MeshError: The file does not exist, is a folder, empty, a git-LFS pointer, truncated or of
            another format; it has no face, or a coordinate that is not finite or too large; or the
            scale is not three finite nonzero factors.
    """
    file = Path(path)
    factors = _parse_scale(scale, file)
    suffix = _require_format(file)
    module = import_module(f".{READERS[suffix]}", __package__)
    read = cast(Callable[..., Reading], module.read)
    try:
        reading = read(file, gltf_up=gltf_up) if READERS[suffix] == "gltf" else read(file)
    except OSError as error:
        raise MeshError(f"the mesh cannot be read: {error.strerror}", path=file) from error
    return _assemble(file, suffix, reading, factors)


def load_named(
    description: Description, uri: str, scale: Sequence[float] = (1.0, 1.0, 1.0)
) -> Mesh:
    """Read a mesh with the URI resolution and the glTF up axis of a description.

    Raises:
        UrdftoolError: The file is not found, or as :func:`load_mesh`.
    """
    return load_mesh(description.resolve(uri), scale, gltf_up=description.gltf_up)


def _parse_scale(scale: Sequence[float], file: Path) -> tuple[float, ...]:
    factors = tuple(float(factor) for factor in scale)
    if len(factors) != 3 or not all(math.isfinite(f) and f != 0 for f in factors):
        given = " ".join(f"{factor:g}" for factor in factors)
        raise MeshError(
            f'the scale "{given}" is not three finite factors other than zero, such as '
            '"0.001 0.001 0.001"',
            path=file,
        )
    return factors


def _require_format(file: Path) -> str:
    if os.path.isdir(file):
        raise MeshError("this is a folder; a mesh file is needed", path=file)
    if not os.path.exists(file):
        raise MeshError("there is no such mesh file", path=file)
    suffix = file.suffix.lower().removeprefix(".")
    if suffix not in READERS:
        known = ", ".join(READERS)
        raise MeshError(
            f'"{file.suffix}" is not a mesh format that can be read; those are {known}', path=file
        )
    if not os.path.isfile(file):
        raise MeshError("this is a device or a pipe; a mesh file is needed", path=file)
    try:
        if file.stat().st_size == 0:
            raise MeshError("the mesh file is empty; export or fetch it again", path=file)
        if is_lfs_pointer(file):
            raise MeshError(
                "this is a git-LFS pointer, not the mesh itself; fetch it with `git lfs pull`",
                path=file,
            )
    except OSError as error:
        raise MeshError(f"the mesh cannot be read: {error.strerror}", path=file) from error
    return suffix


def _drop_unused(piece: Piece) -> Piece:
    """Drop the vertices that no face uses; faces out of range are rejected later."""
    vertices, faces = select_used(piece.vertices, piece.faces)
    return piece if vertices is piece.vertices else replace(piece, vertices=vertices, faces=faces)


def _assemble(file: Path, suffix: str, reading: Reading, factors: tuple[float, ...]) -> Mesh:
    pieces = [_drop_unused(piece) for piece in reading.pieces if len(piece.faces)]
    if not pieces:
        raise MeshError("the mesh has no faces; at least one triangle is needed", path=file)
    offsets = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
    vertices = np.concatenate([piece.vertices for piece in pieces])
    faces = np.concatenate(
        [piece.faces + offset for piece, offset in zip(pieces, offsets[:-1], strict=True)]
    )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise MeshError(
            f"a face names vertex {faces.max()} of {len(vertices)}; the file is damaged", path=file
        )
    bad = np.unique(faces[~np.isfinite(vertices[faces]).all(axis=(1, 2))])
    if len(bad):
        raise MeshError(
            "coordinates of the mesh are NaN or infinite; every vertex needs three finite numbers",
            path=file,
        )
    vertices = vertices * np.array(factors)
    reach = float(np.abs(vertices[faces]).max())
    if not reach < FARTHEST:
        raise MeshError(
            f"the mesh reaches {reach:.3g} m from its origin; the file or its scale is damaged",
            path=file,
        )
    mirrored = math.prod(factors) < 0
    if mirrored:
        faces = np.ascontiguousarray(faces[:, ::-1])
    parts, first = [], 0
    special: dict[Path, bool] = {}
    for piece in pieces:
        count = len(piece.faces)
        uv = piece.uv[:, ::-1] if mirrored and piece.uv is not None else piece.uv
        texture = piece.texture
        if texture is not None and texture not in special:
            special[texture] = is_special(texture)
        texture = None if texture is None or special[texture] else texture
        parts.append(Part(piece.name, first, count, piece.rgba, texture, piece.image, uv))
        first += count
    notes = [
        MeshNote("special-texture", f"{texture} is not a file, so it is not read.", lossy=True)
        for texture, is_one in special.items()
        if is_one
    ]
    return Mesh(vertices, faces, tuple(parts), suffix, file, (*reading.notes, *notes))
