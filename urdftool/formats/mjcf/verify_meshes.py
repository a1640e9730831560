"""Meshes of a description, each read once for a comparison."""

from __future__ import annotations

from ...errors import UrdftoolError
from ...geometry.load import load_named
from ...geometry.mesh import Mesh
from ...model.elements import Robot, Vector

WHOLE: Vector = (1.0, 1.0, 1.0)


class SourceMeshes:
    """Cache of the meshes of a robot."""

    def __init__(self, robot: Robot) -> None:
        """Initialize for a robot; meshes are read on demand."""
        self._robot = robot
        self._read: dict[tuple[str, Vector], Mesh | None] = {}

    def read(self, filename: str, scale: Vector = WHOLE) -> Mesh | None:
        """Return a scaled mesh; None if it cannot be read."""
        if (filename, scale) not in self._read:
            self._read[filename, scale] = self._load(filename, scale)
        return self._read[filename, scale]

    def _load(self, filename: str, scale: Vector) -> Mesh | None:
        if self._robot.source is None:
            return None
        try:
            return load_named(self._robot.source, filename, scale)
        except UrdftoolError:
            return None
