"""Detail of meshes that a picture of a robot shows."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ..errors import UrdftoolError
from ..geometry.mesh import Mesh, Points
from ..geometry.thin import ThinMeshes
from ..model.elements import Collision, Robot, Visual
from ..model.elements import Mesh as MeshGeometry
from ..model.kinematics import link_poses
from ..model.pose import IDENTITY, Pose, make_pose
from ..storage import DiskCache, cache_folder

_CELLS_PER_PIXEL = 1  # at least: the number of cells along a mesh is a power of two


class Detail:
    """Meshes of a robot, off by at most 1.8 pixels of a picture that shows all of it.

    That is the diagonal of a cell; most vertices are off by less than half a pixel.
    """

    def __init__(
        self, robot: Robot, shapes: Iterable[tuple[int, Visual | Collision]], pixels: int
    ) -> None:
        """Find the size of a pixel."""
        self.robot = robot
        self.meshes = ThinMeshes(DiskCache(cache_folder("meshes")))
        self.cell = self._measure_extent(shapes) / (pixels * _CELLS_PER_PIXEL)

    def read(self, geometry: MeshGeometry) -> Mesh:
        """Read a mesh.

        Raises:
            UrdftoolError: The file is not found or cannot be read.
        """
        source = self.robot.source
        assert source is not None
        path = Path(source.resolve(geometry.filename))
        if not self.cell > 0 or not path.is_file():
            from ..geometry.load import load_mesh

            return load_mesh(path, geometry.scale, gltf_up=source.gltf_up)
        return self.meshes.read(path, geometry.scale, source.gltf_up, self.cell)

    def _measure_extent(self, shapes: Iterable[tuple[int, Visual | Collision]]) -> float:
        """Return the diagonal [m] of the bounding box of the meshes; 0 if it is unknown."""
        source = self.robot.source
        if source is None:
            return 0.0
        poses = link_poses(self.robot)
        corners = []
        for row, shape in shapes:
            geometry = shape.geometry
            if not isinstance(geometry, MeshGeometry):
                continue
            try:
                path = Path(source.resolve(geometry.filename))
                low, high = self.meshes.read_bounds(path, geometry.scale, source.gltf_up)
            except (UrdftoolError, OSError):
                continue
            box = np.array(
                [
                    [x, y, z]
                    for x in (low[0], high[0])
                    for y in (low[1], high[1])
                    for z in (low[2], high[2])
                ]
            )
            pose = poses.get(self.robot.links[row].name, IDENTITY)
            corners.append(_transform_points(_transform_points(box, make_pose(shape.origin)), pose))
        if not corners:
            return 0.0
        extent = float(np.linalg.norm(np.ptp(np.concatenate(corners), axis=0)))
        return extent if np.isfinite(extent) else 0.0


def _transform_points(points: Points, pose: Pose) -> Points:
    return np.asarray(points @ np.array(pose.rotation).T + np.array(pose.translation))
