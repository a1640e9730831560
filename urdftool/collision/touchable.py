"""Exterior of a surface: the part that a flood of the space around it reaches.

Motors in a housing, ribs in a shell and the inner side of a thin wall never make contact, so
collision geometry may ignore them. Space is divided into cells; those that the surface crosses,
thickened by one cell against leaks, stop the flood. This also closes gaps and holes narrower than
about three cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Points
from .distance import areas_of, spread
from .vec3 import bounds

CELLS = 100
"""Cells along the longest side of the surface's bounding box."""

_MARKS = 12  # samples per cell face of surface area, so that hardly any cell is missed
_MOST_MARKS = 4_000_000
_RIM = 3


@dataclass(frozen=True, eq=False)
class Flood:
    """Cells around a surface.

    Attributes:
        low: Corner [m] of the first cell.
        side: Edge of a cell [m].
        reached: Cells within two cells of one that the flood reached.
        volume: Unreached volume [m³]; cells of the surface count half.
    """

    low: Points
    side: float
    reached: npt.NDArray[np.bool_]
    volume: float

    def _places(self, points: Points) -> tuple[npt.NDArray[np.int64], ...]:
        found = _cells(points, self.low, self.side)
        for at, count in zip(found, self.reached.shape, strict=True):
            np.clip(at, 0, count - 1, out=at)
        return found

    def touches(self, points: Points) -> npt.NDArray[np.bool_]:
        """Tell whether each point of the surface is exterior."""
        return np.asarray(self.reached[self._places(points)])


def flood(corners: Points) -> Flood:
    """Flood the space around triangles [m], shape (m, 3, 3)."""
    from scipy import ndimage

    points = corners.reshape(-1, 3)
    lowest, highest = bounds(points)
    extent = highest - lowest
    side = float(extent.max()) / CELLS
    low = lowest - _RIM * side
    shape = np.ceil(extent / side).astype(np.int64) + 2 * _RIM + 1
    count = int(min(_MOST_MARKS, _MARKS * areas_of(corners).sum() / side**2 + 1000))
    wall = np.zeros(tuple(shape), dtype=bool)
    for some in (points, spread(corners, count).points):
        wall[_cells(some, low, side)] = True
    thick = _grown(wall)
    labels, _ = ndimage.label(~thick)
    outside = labels == labels[0, 0, 0]
    grown = _grown(outside) & ~wall
    inner = ~(grown | wall)
    volume = (float(np.count_nonzero(inner)) + 0.5 * float(np.count_nonzero(wall))) * side**3
    return Flood(low, side, widened(outside, 2), volume)


def _cells(points: Points, low: Points, side: float) -> tuple[npt.NDArray[np.int64], ...]:
    """Return the indices of each point's cell, axis by axis."""
    return tuple(
        np.floor((points[:, axis] - low[axis]) / side).astype(np.int64) for axis in range(3)
    )


def _grown(cells: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Add the six neighbors of each cell."""
    made: npt.NDArray[np.bool_] = cells.copy()
    for axis in range(3):
        _spread_along(axis, cells, made, 1)
    return made


def widened(cells: npt.NDArray[np.bool_], by: int) -> npt.NDArray[np.bool_]:
    """Add all cells within ``by`` cells of one along each axis."""
    made: npt.NDArray[np.bool_] = cells.copy()
    for axis in range(3):
        before = made.copy()
        for step in range(1, by + 1):
            _spread_along(axis, before, made, step)
    return made


def _spread_along(
    axis: int, cells: npt.NDArray[np.bool_], made: npt.NDArray[np.bool_], step: int
) -> None:
    source, target = np.moveaxis(cells, axis, 0), np.moveaxis(made, axis, 0)
    target[step:] |= source[:-step]
    target[:-step] |= source[step:]
