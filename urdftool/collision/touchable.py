"""Which of a surface can be touched: what a flood of the space around it reaches.

Motors in a housing, ribs in a shell and the inner side of a thin wall never touch anything, and no
collision geometry needs them. The space is cut into cells; those that the surface passes through,
thickened by one cell so that no seam leaks, hold the flood back. Gaps and holes narrower than
about three cells are closed with that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..meshes.mesh import Points
from .distance import areas_of, spread

CELLS = 100
"""Cells along the longest side of the surface's box."""

_MARKS = 12  # points a cell's face of surface, so that hardly a cell is missed
_MOST_MARKS = 4_000_000
_RIM = 3


@dataclass(frozen=True, eq=False)
class Flood:
    """The cells around a surface.

    Attributes:
        low: The corner [m] of the first cell.
        side: Edge of a cell [m].
        reached: Cells within two of one that the flood reached.
        volume: What the flood did not reach [m³]; cells of the surface count half.
        outside: Cells that the flood reached itself; beside the surface it keeps one away.
    """

    low: Points
    side: float
    reached: npt.NDArray[np.bool_]
    volume: float
    outside: npt.NDArray[np.bool_]

    def cells(self, points: Points) -> npt.NDArray[np.int64]:
        """The cell that each point is in, or the nearest to it."""
        cells = np.floor((points - self.low) / self.side).astype(np.int64)
        return np.clip(cells, 0, np.array(self.reached.shape) - 1)

    def touches(self, points: Points) -> npt.NDArray[np.bool_]:
        """Whether each point of the surface can be touched."""
        cells = self.cells(points)
        return np.asarray(self.reached[cells[:, 0], cells[:, 1], cells[:, 2]])


def flood(corners: Points) -> Flood:
    """Flood the space around triangles [m], shape (m, 3, 3)."""
    from scipy import ndimage

    points = corners.reshape(-1, 3)
    extent = np.ptp(points, axis=0)
    side = float(extent.max()) / CELLS
    low = points.min(axis=0) - _RIM * side
    shape = np.ceil(extent / side).astype(np.int64) + 2 * _RIM + 1
    count = int(min(_MOST_MARKS, _MARKS * areas_of(corners).sum() / side**2 + 1000))
    wall = np.zeros(tuple(shape), dtype=bool)
    for some in (points, spread(corners, count).points):
        cells = np.floor((some - low) / side).astype(np.int64)
        wall[cells[:, 0], cells[:, 1], cells[:, 2]] = True
    thick = ndimage.binary_dilation(wall)
    labels, _ = ndimage.label(~thick)
    outside = labels == labels[0, 0, 0]
    grown = ndimage.binary_dilation(outside) & ~wall
    inner = ~(grown | wall)
    volume = (float(np.count_nonzero(inner)) + 0.5 * float(np.count_nonzero(wall))) * side**3
    near = ndimage.binary_dilation(outside, np.ones((3, 3, 3), dtype=bool), iterations=2)
    return Flood(low, side, near, volume, outside)
