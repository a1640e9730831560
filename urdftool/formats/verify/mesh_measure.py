"""Extent, area and center of meshes, to compare files of different formats."""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

import numpy as np

from ...errors import UrdftoolError
from ...geometry.load import load_mesh
from ...model.elements import Mesh, Robot
from ..mechanics import Array

_HEAD = 4096
"""Bytes of an OBJ in which its file of materials is named."""


@dataclass(frozen=True)
class Measure:
    """Surface of one or several meshes, in the frame of a body.

    Attributes:
        low: Lower corner of the bounding box [m].
        high: Upper corner [m].
        area: Area [m²].
        center: Center of the area [m].
        second: Second moments of the area about the center, divided by the area [m²].
    """

    low: Array
    high: Array
    area: float
    center: Array
    second: Array

    @property
    def size(self) -> float:
        """Return the length of the diagonal of the box [m]."""
        return float(np.linalg.norm(self.high - self.low))


@dataclass
class MeshMeasures:
    """Meshes that have been read, by path and scale."""

    _read: dict[tuple[str, tuple[float, float, float]], tuple[Array, Array] | None] = field(
        default_factory=dict
    )
    _digests: dict[str, str] = field(default_factory=dict)

    def find(self, robot: Robot, mesh: Mesh) -> Path | None:
        """Return the file of a mesh; None if it does not exist."""
        try:
            path = (
                Path(mesh.filename) if robot.source is None else robot.source.resolve(mesh.filename)
            )
        except UrdftoolError:
            return None
        return path if path.is_file() else None

    def get_digest(self, path: Path) -> str:
        """Return a digest of the content of a file."""
        if str(path) not in self._digests:
            self._digests[str(path)] = sha256(path.read_bytes()).hexdigest()
        return self._digests[str(path)]

    def has_materials(self, path: Path) -> bool:
        """Tell whether an OBJ names a file of materials at its beginning."""
        with path.open("rb") as file:
            return b"mtllib" in file.read(_HEAD)

    def measure(self, robot: Robot, meshes: list[tuple[Mesh, Array]]) -> Measure | None:
        """Measure the union of meshes at poses; None if one of them cannot be read."""
        parts = []
        for mesh, pose in meshes:
            read = self._load(robot, mesh)
            if read is None:
                return None
            points, triangles = read
            parts.append((_move(points, pose), _move(triangles.reshape(-1, 3), pose)))
        points = np.concatenate([part[0] for part in parts])
        triangles = np.concatenate([part[1] for part in parts]).reshape(-1, 3, 3)
        return _measure(points, triangles)

    def _load(self, robot: Robot, mesh: Mesh) -> tuple[Array, Array] | None:
        """Return points, shape (n, 3), and triangles, shape (m, 3, 3) [m]."""
        path = self.find(robot, mesh)
        if path is None:
            return None
        key = str(path), mesh.scale
        if key not in self._read:
            up = "y" if robot.source is None else robot.source.gltf_up
            try:
                loaded = load_mesh(path, mesh.scale, gltf_up=up or "y")
            except UrdftoolError:
                self._read[key] = None
            else:
                triangles = np.asarray(loaded.vertices[loaded.faces], dtype=np.float64)
                self._read[key] = triangles.reshape(-1, 3), triangles
        return self._read[key]


def _move(points: Array, pose: Array) -> Array:
    moved: Array = points @ pose[:3, :3].T + pose[:3, 3]
    return moved


def _measure(points: Array, triangles: Array) -> Measure:
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    total = float(areas.sum()) or 1e-300
    center = (areas[:, None] * (a + b + c) / 3).sum(axis=0) / total
    second = np.zeros((3, 3))
    for corner in ((a + b) / 2, (b + c) / 2, (c + a) / 2):  # exact for quadratic functions
        arm = corner - center
        second += np.einsum("n,ni,nj->ij", areas / 3, arm, arm)
    return Measure(points.min(axis=0), points.max(axis=0), total, center, second / total)


def measure_distance(one: Measure, two: Measure) -> float:
    """Return how far two surfaces are apart [m]: by box, area, center and second moments."""
    size = max(one.size, two.size, 1e-9)
    area = abs(one.area - two.area) / max(one.area, two.area) * size
    return float(
        max(
            np.abs(one.low - two.low).max(),
            np.abs(one.high - two.high).max(),
            np.abs(one.center - two.center).max(),
            np.abs(one.second - two.second).max() / size,
            area / 100,
        )
    )
