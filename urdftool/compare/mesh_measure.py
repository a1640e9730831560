"""Extent, area and center of meshes, to compare files of different formats."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import PackageNotFound, UrdftoolError
from ..extras import is_installed
from ..geometry.image_file import open_image
from ..geometry.load import load_mesh
from ..geometry.mesh_deviation import measure_deviation
from ..geometry.reference_patterns import INIT_FROM, MAP, MTLLIB, URI
from ..mechanics.reference import Array
from ..model.elements import Geometry, Mesh, Robot
from ..source.packages import shorten_path

_NAMED = {".obj": MTLLIB, ".mtl": MAP, ".dae": INIT_FROM, ".gltf": URI}
"""Expressions of the names of other files, by the suffix of a file."""

_HEAD = 4096
"""Bytes of an OBJ in which its file of materials is named."""


Faces = npt.NDArray[np.integer]


@dataclass(frozen=True)
class Measure:
    """Surface of one or several meshes, in the frame of a body.

    Attributes:
        low: Lower corner of the bounding box [m].
        high: Upper corner [m].
        area: Area [m²].
        center: Center of the area [m].
        second: Second moments of the area about the center, divided by the area [m²].
        parts: The meshes, with the pose of each, 4 × 4.
    """

    low: Array
    high: Array
    area: float
    center: Array
    second: Array
    parts: tuple[tuple[_Surface, Array], ...]

    @property
    def size(self) -> float:
        """Return the length of the diagonal of the box [m]."""
        return float(np.linalg.norm(self.high - self.low))

    def compute_corners(self) -> Array:
        """Compute the corners of all triangles [m], shape (n, 3, 3)."""
        placed = [
            (surface.points @ pose[:3, :3].T + pose[:3, 3])[surface.faces]
            for surface, pose in self.parts
        ]
        return np.concatenate(placed)


class _Surface(NamedTuple):
    """A mesh in its own frame.

    Attributes:
        points: Vertices of its triangles [m], shape (n, 3).
        faces: Numbers of the vertices of each triangle, shape (m, 3).
        area: Area [m²].
        center: Center of the area [m].
        second: Second moments of the area about the center, divided by the area [m²].
    """

    points: Array
    faces: Faces
    area: float
    center: Array
    second: Array


_Key = tuple[str, tuple[float, float, float]]


@dataclass
class MeshMeasures:
    """Meshes that have been read and measured, by path, scale and pose."""

    _read: dict[_Key, _Surface | None] = field(default_factory=dict)
    _measured: dict[tuple[_Key, bytes], Measure] = field(default_factory=dict)
    _digests: dict[str, str] = field(default_factory=dict)
    _reasons: dict[str, str] = field(default_factory=dict)

    def find(self, robot: Robot, mesh: Mesh) -> Path | None:
        """Return the file of a mesh; None if it does not exist."""
        try:
            path = (
                Path(mesh.filename) if robot.source is None else robot.source.resolve(mesh.filename)
            )
        except UrdftoolError:
            return None
        if robot.source is not None and robot.source.workspace.get_overlay(path) is not None:
            return robot.source.workspace.materialize(path)  # a mesh that is not written yet
        return path if path.is_file() else None

    def explain_unread(self, robot: Robot, mesh: Mesh) -> str:
        """Return why a mesh cannot be measured; empty if it can."""
        path = self.find(robot, mesh)
        if path is not None:
            surface = self._load(robot, (str(path), mesh.scale))
            return "" if surface is not None else self._reasons[str(path)]
        try:
            if robot.source is not None:
                robot.source.resolve(mesh.filename)
        except UrdftoolError as error:
            return str(error.data.get("reason") or error.message)
        return "does not exist"

    def name_file(self, robot: Robot, mesh: Mesh) -> str:
        """Return the path of a mesh file; its URI if the package is not found."""
        path, uri = _locate(robot, mesh)
        return uri or shorten_path(path)

    def is_one_file(self, robots: tuple[Robot, Robot], meshes: tuple[Mesh, Mesh]) -> bool:
        """Tell whether two meshes are one file, which need not exist, with one scale."""
        if meshes[0].scale != meshes[1].scale:
            return False
        places = [_locate(*side) for side in zip(robots, meshes, strict=True)]
        return places[0] == places[1]

    def get_digest(self, path: Path) -> str:
        """Return a digest of the content of a file."""
        if str(path) not in self._digests:
            self._digests[str(path)] = sha256(path.read_bytes()).hexdigest()
        return self._digests[str(path)]

    def has_equal_looks(self, robots: tuple[Robot, Robot], meshes: tuple[Mesh, Mesh]) -> bool:
        """Tell whether two mesh files, and the files of colors that they name, are equal."""
        paths = [self.find(*side) for side in zip(robots, meshes, strict=True)]
        if paths[0] is None or paths[1] is None:
            return self.is_one_file(robots, meshes)
        one, two = (
            _digest_with_named(robot, path, 0)
            for robot, path in zip(robots, paths, strict=True)
            if path is not None
        )
        return one == two

    def get_pixel_digest(self, path: Path) -> str:
        """Return a digest of the pixels of an image; of its file if it cannot be decoded."""
        if not is_installed("PIL"):
            return self.get_digest(path)
        try:
            with open_image(path) as image:
                plain = image.convert("RGBA")
        except Exception:  # Pillow raises arbitrary exceptions for damaged files
            return self.get_digest(path)
        return sha256(repr(plain.size).encode() + plain.tobytes()).hexdigest()

    def has_own_colors(self, robot: Robot, geometry: Geometry | None) -> bool:
        """Tell whether a mesh file has colors, of which readers show either those or a material."""
        if not isinstance(geometry, Mesh):
            return False
        name = geometry.filename.lower()
        if not name.endswith(".obj"):
            return name.endswith((".dae", ".gltf", ".glb"))
        path = self.find(robot, geometry)
        if path is None:
            return False
        with path.open("rb") as file:
            return b"mtllib" in file.read(_HEAD)

    def measure(self, robot: Robot, meshes: list[tuple[Mesh, Array]]) -> Measure | None:
        """Measure the union of meshes at poses; None if one of them cannot be read."""
        parts = []
        for mesh, pose in meshes:
            path = self.find(robot, mesh)
            key = str(path), mesh.scale
            surface = None if path is None else self._load(robot, key)
            if surface is None:
                return None
            placed = key, pose.tobytes()
            if placed not in self._measured:
                self._measured[placed] = _place(surface, pose)
            parts.append(self._measured[placed])
        return parts[0] if len(parts) == 1 else _unite(parts)

    def _load(self, robot: Robot, key: _Key) -> _Surface | None:
        """Return the surface of a file with a scale; None if it cannot be read."""
        if key not in self._read:
            up = "y" if robot.source is None else robot.source.gltf_up
            try:
                loaded = load_mesh(Path(key[0]), key[1], gltf_up=up or "y")
            except UrdftoolError as error:
                self._read[key] = None
                self._reasons[key[0]] = error.message
            else:
                vertices = np.asarray(loaded.vertices, dtype=np.float64)
                faces = np.asarray(loaded.faces)
                self._read[key] = _make_surface(vertices, faces) if len(faces) else None
                if not len(faces):
                    self._reasons[key[0]] = "has no triangles"
        return self._read[key]


def _digest_with_named(robot: Robot, path: Path, depth: int) -> bytes:
    """Return a digest of a file and those that it names; of a file that is not read, its path."""
    try:
        data = (
            path.read_bytes() if robot.source is None else robot.source.workspace.read_bytes(path)
        )
    except (OSError, ValueError):
        return os.path.normpath(path).encode()
    found = sha256(data).digest()
    pattern = _NAMED.get(path.suffix.lower())
    for name in dict.fromkeys(pattern.findall(data)) if pattern and depth < 2 else ():
        other = path.parent / name.decode("utf-8", "replace").strip().replace("\\", "/")
        found = sha256(found + _digest_with_named(robot, other, depth + 1)).digest()
    return found


def _locate(robot: Robot, mesh: Mesh) -> tuple[Path, str]:
    """Return the place of a mesh; of an unknown package the folder of the robot, and its URI."""
    if robot.source is None:
        return Path(mesh.filename), ""
    try:
        return Path(os.path.normpath(robot.source.packages.locate(mesh.filename))), ""
    except PackageNotFound:
        return Path(robot.source.path).parent, mesh.filename


def _make_surface(vertices: Array, faces: Faces) -> _Surface:
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    total = float(areas.sum()) or 1e-300
    center = areas @ (a + b + c) / (3 * total)
    second = np.zeros((3, 3))
    for middle in ((a + b) / 2, (b + c) / 2, (c + a) / 2):  # exact for quadratic functions
        arm = middle - center
        second += (arm * (areas / 3)[:, None]).T @ arm
    used, numbers = np.unique(faces, return_inverse=True)
    return _Surface(vertices[used], numbers.reshape(faces.shape), total, center, second / total)


def _place(surface: _Surface, pose: Array) -> Measure:
    """Return the measure of a surface at a pose, 4 × 4."""
    turn, at = pose[:3, :3], pose[:3, 3]
    points = surface.points @ turn.T
    low, high = points.min(axis=0) + at, points.max(axis=0) + at
    center, second = turn @ surface.center + at, turn @ surface.second @ turn.T
    return Measure(low, high, surface.area, center, second, ((surface, pose),))


def _unite(parts: list[Measure]) -> Measure:
    """Return the measure of several surfaces together."""
    area = sum(part.area for part in parts)
    center = sum((part.area * part.center for part in parts), np.zeros(3)) / area
    second = np.zeros((3, 3))
    for part in parts:
        arm = part.center - center
        second += part.area / area * (part.second + np.outer(arm, arm))
    low = np.min([part.low for part in parts], axis=0)
    high = np.max([part.high for part in parts], axis=0)
    together = tuple(surface for part in parts for surface in part.parts)
    return Measure(low, high, area, center, second, together)


def measure_distance(one: Measure, two: Measure, tolerance: float) -> float:
    """Return how far two surfaces are apart [m]: by box, area, center and second moments.

    If these agree, points of each surface are measured to the other: a mesh and its mirror image
    may agree in all of them.
    """
    size = max(one.size, two.size, 1e-9)
    area = abs(one.area - two.area) / max(one.area, two.area) * size
    distance = float(
        max(
            np.abs(one.low - two.low).max(),
            np.abs(one.high - two.high).max(),
            np.abs(one.center - two.center).max(),
            np.abs(one.second - two.second).max() / size,
            area / 100,
        )
    )
    if distance > tolerance:
        return distance
    corners = one.compute_corners(), two.compute_corners()
    return max(distance, measure_deviation(*corners, tolerance))
