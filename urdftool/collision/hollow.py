"""A hollow that is open to the outside, and that a collision geometry fills.

The inside of a cup, or of a housing that is drawn without its end, can be touched, so that what
fills it is far off both there and across the mouth; convex pieces fill it nevertheless. How good
they are elsewhere is another number, which is measured here.

The space that is outside the visual and within the pieces is looked at in the cells of the flood.
Thin layers of it are pieces that bulge. What is left is a hollow where its walls are much larger
than its mouth; anything else is a corner that pieces cut short.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt

from ..meshes.mesh import Points
from .measure import Target, compare, depths
from .piece import Piece
from .touchable import Flood

_THIN = 2.0  # cells within which every place of a layer is near its sides
_ROUND = 1.5  # cells that the corners of a hollow are farther from its core than that
_WALL = 3.0  # cells from a hollow to the surface around it
_MOUTH = 2.0  # cells from a hollow to the face of a piece across its mouth
_WALLS = 2.0  # area of the walls, over that of the mouth, from which on it is a hollow
_SMALL = 0.005  # share of what can be touched, up to which a space is a groove or a screw's hole
_MOST = 0.5  # share of the excess that a hollow may leave where it is what explains it

Numbers = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Hollow:
    """What a filled hollow explains of an error.

    Attributes:
        depth: How far [m] its walls are from its mouth at most; the deepest, where there are
            several.
        error: The error beside it: the largest distance of what is not its walls or its mouth,
            relative to the size; at the rim the two are told apart to within a cell of the flood.
    """

    depth: float
    error: float

    def as_dict(self) -> dict[str, float]:
        """Plain numbers."""
        return asdict(self)


def filled_hollow(target: Target, pieces: Sequence[Piece], max_error: float) -> Hollow | None:
    """The hollow that explains most of what an error is beyond its limit, if there is any.

    Args:
        target: The visual.
        pieces: The collision geometry; concave ones are taken to fill nothing.
        max_error: The limit, relative to the size.
    """
    solid = [piece for piece in pieces if piece.kind != "mesh"]
    space = _cells_within(target.flood, solid)
    found = _Hollows(target.flood, space)
    if not found.count:
        return None
    compared = compare(target, pieces)
    inner = found.near(target.touchable, _WALL)
    out = depths(target.touchable, pieces)
    inner[out > target.flood.side] = 0  # a thin wall is on the pieces, not in them
    mouth = found.near(compared.points, _MOUTH)
    across = np.where(compared.back > _ROUND * target.flood.side, mouth, 0)
    areas: Points = np.bincount(across, compared.areas, found.count + 1).astype(np.float64)
    kept = _hollows(target, inner, areas)
    if not len(kept):
        return None
    walls, mouths = np.isin(inner, kept) & (out < 0), np.isin(mouth, kept)
    left = max(
        float(compared.forth[~walls].max(initial=0.0)),
        float(compared.back[~mouths].max(initial=0.0)),
    )
    error, whole = left / target.size, compared.hausdorff / target.size
    if error - max_error > _MOST * (whole - max_error):
        return None
    depth = max(
        _depth(target.touchable[inner == label], compared.points[across == label]) for label in kept
    )
    return Hollow(depth, error)


class _Hollows:
    """Connected spaces that are wider than a layer."""

    def __init__(self, flood: Flood, space: npt.NDArray[np.bool_]) -> None:
        from scipy import ndimage

        self.flood = flood
        core = ndimage.distance_transform_edt(space) > _THIN
        labels, self.count = ndimage.label(core)
        if self.count:
            off, places = ndimage.distance_transform_edt(~core, return_indices=True)
            of_core = labels[tuple(places)]
            within = space & (off <= _THIN + _ROUND)
            off, places = ndimage.distance_transform_edt(~within, return_indices=True)
            self.off, self.labels = off, of_core[tuple(places)]

    def near(self, points: Points, cells: float) -> Numbers:
        """The number, from 1, of the hollow that each point is within some cells of, or 0."""
        i, j, k = self.flood.cells(points).T
        found: Numbers = np.where(self.off[i, j, k] <= cells, self.labels[i, j, k], 0)
        return found


def _cells_within(flood: Flood, pieces: Sequence[Piece]) -> npt.NDArray[np.bool_]:
    """Flooded cells whose middle is in a piece."""
    within = np.zeros_like(flood.outside)
    for piece in pieces:
        low, high = flood.cells(piece.bounds)
        box = tuple(slice(a, b + 1) for a, b in zip(low, high, strict=True))
        cells = np.argwhere(flood.outside[box] & ~within[box]) + low
        middles = flood.low + (cells + 0.5) * flood.side
        inside = depths(middles, [piece]) < 0
        within[tuple(cells[inside].T)] = True
    return within


def _hollows(target: Target, inner: Numbers, mouths: Points) -> Numbers:
    """Numbers of the spaces whose walls are much larger than their mouths."""
    even = len(target.even)
    walls = np.bincount(inner[:even], minlength=len(mouths)) * (target.area / even)
    good = (walls > _WALLS * mouths) & (mouths > 0) & (walls > _SMALL * target.area)
    good[0] = False
    return np.flatnonzero(good)


def _depth(walls: Points, mouth: Points) -> float:
    from scipy.spatial import cKDTree

    far, _ = cKDTree(mouth).query(walls)
    return float(np.max(far))
