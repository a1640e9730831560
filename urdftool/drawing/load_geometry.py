"""Surfaces of visuals and collisions, with the colors and images of their mesh files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..errors import MeshError, UrdftoolError
from ..geometry.mesh import Faces, Mesh, Part, Points
from ..geometry.tessellate import tessellate
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Material,
    Robot,
    Sphere,
    Vector,
    Visual,
)
from ..model.elements import Mesh as MeshGeometry
from ..model.materials import resolve_material
from ..model.pose import Pose, make_pose
from .materials import PLAIN, Rgba, Tints, clamp_color
from .normals import compute_corner_normals
from .raster import Floats, Indices
from .texture import Texels, read_texture

OVERLAY: Rgba = (0.08, 0.70, 0.42, 0.36)
"""Color of collision geometry drawn over visual geometry. Chosen, no source."""

TOUCHED: Rgba = (0.47, 0.80, 0.64, 1.0)
"""Color of collision geometry drawn alone. Chosen, no source."""

AROUND = 64
"""Corners of a circle. Chosen, no source."""

LARGEST = 1e30
"""Coordinate [m] beyond which nothing is drawn."""


@dataclass
class Surface:
    """Triangles of one shape in the frame of its ``<geometry>``, with their appearance.

    ``image`` holds rows of ``Gathering.images``, -1 for none. ``colored`` marks triangles whose
    color comes from the mesh file.
    """

    corners: Points
    normals: Floats
    colors: Floats
    colored: npt.NDArray[np.bool_]
    uv: Floats
    has_uv: npt.NDArray[np.bool_]
    image: Indices


@dataclass
class Gathering:
    """State of reading a robot's geometry: each file is read once; problems are collected."""

    robot: Robot
    tints: Tints
    images: list[Texels] = field(default_factory=list)
    problems: dict[str, UrdftoolError] = field(default_factory=dict)
    image_rows: dict[object, int] = field(default_factory=dict)
    surfaces: dict[tuple[str, Vector], Surface | MeshError] = field(default_factory=dict)
    read: Callable[[MeshGeometry], Mesh] | None = None
    """Reader of a mesh with less detail; None reads files as they are."""

    def load_image(self, source: Path | bytes, at: MeshGeometry | Material) -> int:
        """Return the row of an image; -1 with a problem recorded if it cannot be read."""
        if source not in self.image_rows:
            self.image_rows[source] = -1
            try:
                self.images.append(read_texture(self._read_image(source)))
                self.image_rows[source] = len(self.images) - 1
            except MeshError as error:
                self.record_problem(f"texture of {_get_name(at)}: {error}", at)
        return self.image_rows[source]

    def _read_image(self, source: Path | bytes) -> Path | bytes:
        """Return the content of an image file that the description may read.

        Raises:
            MeshError: It may not.
        """
        if isinstance(source, bytes) or self.robot.source is None:
            return source
        try:
            return self.robot.source.workspace.read_bytes(source)
        except FileNotFoundError:
            return source  # reported by the reader
        except OSError as error:
            raise MeshError(f"the image is not read: it {error.strerror}", path=source) from None

    def record_problem(
        self, message: str, at: MeshGeometry | Material | Visual | Collision
    ) -> None:
        """Record a problem, once per place."""
        error = MeshError(message, at=at.place)
        self.problems.setdefault(str(error), error)


def read_surface(
    gathering: Gathering, shape: Visual | Collision, *, over: bool = False
) -> Surface | None:
    """Read a visual or collision in the frame of its link; None if it cannot be drawn.

    The reason is recorded as a problem, unless the geometry is missing, unknown or empty.
    """
    surface = _read_surface(gathering, shape)
    if surface is None:
        return None
    placed = _place_surface(surface, make_pose(shape.origin))
    if not (np.abs(placed.corners) < LARGEST).all():
        gathering.record_problem(
            f"geometry extends beyond {LARGEST:g} m or is not finite; it is not drawn", shape
        )
        return None
    return _color_surface(gathering, placed, shape, over=over)


def _read_surface(gathering: Gathering, shape: Visual | Collision) -> Surface | None:
    geometry = shape.geometry
    if isinstance(geometry, MeshGeometry):
        try:
            return _read_mesh_surface(gathering, geometry)
        except UrdftoolError as error:
            gathering.record_problem(f"mesh '{geometry.filename}': {error.message}", geometry)
            return None
    sized = _get_primitive(geometry)
    if sized is None:
        return None
    kind, size = sized
    if not np.isfinite(size).all():
        gathering.record_problem(f"size of the {kind} is not finite; it is not drawn", shape)
        return None
    if not any(size) or (kind != "box" and not size[0]):
        return None
    vertices, faces = tessellate(kind, size, AROUND)
    return _make_surface(vertices, faces)


def _get_primitive(geometry: Geometry | None) -> tuple[str, Vector] | None:
    """Return kind and lengths of a primitive; None for other geometry."""
    if isinstance(geometry, Box):
        return "box", geometry.size
    if isinstance(geometry, Cylinder):
        return "cylinder", (geometry.radius, geometry.length, 0.0)
    if isinstance(geometry, Capsule):
        return "capsule", (geometry.radius, geometry.length, 0.0)
    if isinstance(geometry, Sphere):
        return "sphere", (geometry.radius, 0.0, 0.0)
    if isinstance(geometry, Ellipsoid):
        return "ellipsoid", geometry.radii
    if isinstance(geometry, Cone):
        return "cone", (geometry.radius, geometry.length, 0.0)
    return None


def _make_surface(vertices: Points, faces: Faces) -> Surface:
    count = len(faces)
    return Surface(
        vertices[faces],
        compute_corner_normals(vertices, faces),
        np.tile(np.array(PLAIN), (count, 1)),
        np.zeros(count, dtype=bool),
        np.zeros((count, 3, 2)),
        np.zeros(count, dtype=bool),
        np.full(count, -1, dtype=np.int64),
    )


def _read_mesh_surface(gathering: Gathering, geometry: MeshGeometry) -> Surface:
    """Read a mesh file at a scale, once.

    Raises:
        UrdftoolError: The file is not found or cannot be read.
    """
    from ..geometry.load import load_named

    key = (geometry.filename, geometry.scale)
    if key not in gathering.surfaces:
        source = gathering.robot.source
        if source is None:
            raise MeshError("meshes require a robot that was read from a file")
        try:
            if gathering.read is not None:
                mesh = gathering.read(geometry)
            else:
                mesh = load_named(source, geometry.filename, geometry.scale)
        except UrdftoolError as error:
            found = MeshError(error.message)
            gathering.surfaces[key] = found
            raise found from error
        surface = _make_surface(mesh.vertices, mesh.faces)
        for part in mesh.parts:
            _look(gathering, geometry, surface, mesh, part)
        gathering.surfaces[key] = surface
    surface_or_error = gathering.surfaces[key]
    if isinstance(surface_or_error, MeshError):
        raise surface_or_error
    return surface_or_error


def _look(
    gathering: Gathering, geometry: MeshGeometry, surface: Surface, mesh: Mesh, part: Part
) -> None:
    """Apply the color and image of a mesh part to its triangles."""
    some = slice(part.first, part.first + part.count)
    image = part.texture if part.image is None else part.image
    row = -1 if image is None else gathering.load_image(image, geometry)
    rgba = part.rgba
    if part.uv is not None:
        surface.uv[some], surface.has_uv[some] = part.uv, True
    if row >= 0:
        # only glTF multiplies the image by the color
        is_gltf = mesh.format in ("gltf", "glb")
        opacity = 1.0 if rgba is None else rgba[3]
        color = clamp_color(rgba if rgba is not None and is_gltf else (1.0, 1.0, 1.0, opacity))
        if part.uv is None:
            color = _compute_mean_color(gathering.images[row])
            row = -1
        surface.image[some], surface.colors[some] = row, color
        surface.colored[some] = True
    elif rgba is not None:
        surface.colors[some], surface.colored[some] = clamp_color(rgba), True


def _compute_mean_color(texels: Texels) -> Rgba:
    red, green, blue, alpha = (float(v) for v in texels.reshape(-1, 4).mean(axis=0) / 255)
    return red, green, blue, alpha


def _place_surface(surface: Surface, pose: Pose) -> Surface:
    rotation, shift = np.array(pose.rotation), np.array(pose.translation)
    return Surface(
        surface.corners @ rotation.T + shift,
        surface.normals @ rotation.T,
        surface.colors,
        surface.colored,
        surface.uv,
        surface.has_uv,
        surface.image,
    )


def _color_surface(
    gathering: Gathering, surface: Surface, shape: Visual | Collision, *, over: bool
) -> Surface:
    """Color the surface by its visual's material, or as collision geometry."""
    count = len(surface.corners)
    if isinstance(shape, Collision):
        color = OVERLAY if over else TOUCHED
        surface.colors = np.tile(np.array(color), (count, 1))
        surface.image = np.full(count, -1, dtype=np.int64)
        return surface
    material = resolve_material(gathering.robot, shape.material)
    bare = ~surface.colored
    if not bare.any():
        return surface
    if material is None:
        if (tint := gathering.tints.get_tint(shape)) != PLAIN:
            surface.colors = surface.colors.copy()
            surface.colors[bare] = tint
        return surface
    surface.colors = surface.colors.copy()
    surface.image = surface.image.copy()
    row = _load_material_image(gathering, material)
    if material.color is not None:
        surface.colors[bare] = clamp_color(material.color)
    if row >= 0:
        mapped = bare & surface.has_uv
        surface.colors[bare] = _compute_mean_color(gathering.images[row])
        surface.colors[mapped] = 1.0
        surface.image[mapped] = row
    return surface


def _load_material_image(gathering: Gathering, material: Material) -> int:
    if not material.texture or gathering.robot.source is None:
        return -1
    try:
        path = gathering.robot.source.resolve(material.texture)
    except UrdftoolError as error:
        gathering.record_problem(f"texture of {_get_name(material)}: {error.message}", material)
        return -1
    return gathering.load_image(path, material)


def _get_name(part: MeshGeometry | Material) -> str:
    if isinstance(part, MeshGeometry):
        return f"mesh '{part.filename}'"
    return f"material '{part.name}'"
