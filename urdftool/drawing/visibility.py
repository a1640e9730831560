"""What of some triangles is visible, and drawing them through what hides them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ..model.pose import Pose
from .camera import Camera, View
from .clip import clipped, nearest
from .picture import draw
from .png_file import Image
from .raster import Floats, front
from .shapes import Shapes

Mask = npt.NDArray[np.bool_]

POINTS = 12_000
"""Points on the triangles by which views are compared; each stands for an equal area."""

_GRID = (72, 60)  # pixels of the pictures that are compared
_THROUGH = 0.55  # of a hidden pixel's color is that of what is hidden
_NEAR = 0.01  # of the scene's depth: points of one surface are this close to each other


class Cloud:
    """Points spread over the triangles of a robot.

    Attributes:
        shapes: Its triangles.
        triangle: The triangle of each point, shape (n,).
    """

    def __init__(self, shapes: Shapes) -> None:
        """Spread points over triangles by their area, the same each time."""
        self.shapes = shapes
        edges = shapes.corners[:, 1:] - shapes.corners[:, :1]
        areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        total = float(areas.sum()) if len(areas) else 0.0
        if not 0 < total < np.inf:
            self.triangle = np.zeros(0, dtype=np.int64)
            self._weights = np.zeros((0, 3))
            return
        chance = np.random.default_rng(0)
        spread = chance.choice(len(areas), size=POINTS, p=areas / total)
        self.triangle = np.sort(np.concatenate([spread, np.arange(len(areas))[:POINTS]]))
        u, v = np.sort(chance.random((2, len(self.triangle))), axis=0)
        self._weights = np.column_stack([u, v - u, 1 - v])

    def at(self, corners: Floats) -> Floats:
        """The points for corners of the triangles somewhere, shape (n, 3)."""
        found: Floats = np.einsum("ij,ijk->ik", self._weights, corners[self.triangle])
        return found


def best_camera(
    cloud: Cloud, poses: Sequence[Mapping[str, Pose]], moved: Mask, cameras: Iterable[Camera]
) -> Camera:
    """The camera in whose pictures most of the moved triangles is visible.

    The first camera is taken unless another shows clearly more.

    Args:
        cloud: Points on the robot.
        poses: Of the links, of each picture.
        moved: Which triangles move, shape (m,).
        cameras: At least one.
    """
    points, moves = [], moved[cloud.triangle]
    for some in poses:
        corners, _, there = cloud.shapes.posed(some)
        placed = cloud.at(corners)
        points.append((placed[there[cloud.triangle]], moves[there[cloud.triangle]]))
    everything = np.concatenate([placed for placed, _ in points])
    first, *others = cameras
    if not len(everything) or not moves.any():
        return first
    best, most = first, 1.5 * _visible(points, first.view(everything, _GRID))
    for camera in others:
        count = _visible(points, camera.view(everything, _GRID))
        if count > most:
            best, most = camera, count
    return best


def _visible(points: Sequence[tuple[Floats, Mask]], view: View) -> int:
    """How many pixels of a view show moved points, of the picture with the fewest of them."""
    counts = []
    for placed, moves in points:
        seen = view.seen(placed)
        depth = -seen[:, 2]
        ahead = depth > 0
        pixels = view.pixels(placed[ahead]).astype(np.int64)
        inside = ((pixels >= 0) & (pixels < np.array(view.size))).all(axis=1)
        cells = pixels[inside, 0] + pixels[inside, 1] * view.size[0]
        depth, moving = depth[ahead][inside], moves[ahead][inside]
        front_depth = np.full(view.size[0] * view.size[1], np.inf)
        np.minimum.at(front_depth, cells, depth)
        slack = _NEAR * float(np.ptp(depth)) if len(depth) else 0.0
        shown = moving & (depth <= front_depth[cells] + slack)
        counts.append(len(np.unique(cells[shown])))
    return min(counts)


def owners(shapes: Shapes, poses: Mapping[str, Pose], view: View) -> npt.NDArray[np.int64]:
    """The triangle that is in front at each pixel, -1 where there is none, (height, width)."""
    corners, _, there = shapes.posed(poses)
    rows = np.flatnonzero(there)
    found = np.full(view.size[0] * view.size[1], -1, dtype=np.int64)
    if len(rows):
        seen = view.seen(corners[rows])
        flat, owner = clipped(seen, view.reach, view.size, nearest(seen))
        first, _ = front(flat, view.size)
        some = first >= 0
        found[some] = rows[owner[first[some]]]
    return found.reshape(view.size[1], view.size[0])


def draw_through(
    shapes: Shapes, poses: Mapping[str, Pose], moved: Mask, *, view: View, ground: float
) -> Image:
    """A picture of shapes in which moved triangles shine through what hides them.

    Args:
        shapes: All of them.
        poses: Of the links.
        moved: Which triangles shine through, shape (m,).
        view: The camera in its place.
        ground: Height of the floor [m].
    """
    image = draw(shapes, poses, camera=view, ground=ground)
    links = {shapes.links[row] for row in np.unique(shapes.link[moved])}
    alone = {name: pose for name, pose in poses.items() if name in links}
    covered = owners(shapes, alone, view) >= 0
    hiding = owners(shapes, poses, view)
    hidden = covered & (hiding >= 0) & ~moved[hiding]
    if hidden.any():
        behind = draw(shapes, alone, camera=view, ground=False)
        mixed = (1 - _THROUGH) * image[hidden] + _THROUGH * behind[hidden]
        image[hidden] = np.rint(mixed).astype(image.dtype)
    return image
