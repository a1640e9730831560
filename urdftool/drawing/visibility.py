"""What of some triangles is visible, and drawing them through what hides them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ..model.pose import Pose
from .camera import Camera, View
from .clip import clipped, nearest
from .gather import LARGEST
from .picture import draw
from .png_file import Image
from .points import turned
from .raster import Floats, front
from .shapes import Shapes

Mask = npt.NDArray[np.bool_]

POINTS = 12_000
"""Points on the triangles by which views are compared; each stands for an equal area."""

_GRID = (72, 60)  # pixels of the pictures that are compared
_THROUGH = 0.55  # of a hidden pixel's color is that of what is hidden
_NEAR = 0.01  # of the scene's depth: points of one surface are this close to each other


class Cloud:
    """Points spread over the triangles of a robot, each in the frame of its link.

    Attributes:
        links: Names of the links.
        link: Row of ``links`` of each point, shape (n,).
        points: Where each is [m], shape (n, 3).
    """

    def __init__(self, shapes: Shapes) -> None:
        """Spread points over triangles by their area, the same each time."""
        self.links = shapes.links
        edges = shapes.corners[:, 1:] - shapes.corners[:, :1]
        areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        total = float(areas.sum()) if len(areas) else 0.0
        chance = np.random.default_rng(0)
        chosen = np.zeros(0, dtype=np.int64)
        if 0 < total < np.inf:
            chosen = np.sort(chance.choice(len(areas), size=POINTS, p=areas / total))
        u, v = np.sort(chance.random((2, len(chosen))), axis=0)
        weights = np.column_stack([u, v - u, 1 - v])
        self.points: Floats = np.einsum("ij,ijk->ik", weights, shapes.corners[chosen])
        self.link = shapes.link[chosen]

    def at(self, poses: Mapping[str, Pose]) -> Floats:
        """The points in the world, not a number where a link has no pose, shape (n, 3)."""
        placed = np.full_like(self.points, np.nan)
        for row in np.unique(self.link):
            pose = poses.get(self.links[row])
            if pose is not None:
                some = self.link == row
                turn, shift = np.array(pose.rotation), np.array(pose.translation)
                placed[some] = turned(self.points[some], turn, shift)
        return placed


def best_camera(
    cloud: Cloud,
    poses: Sequence[Mapping[str, Pose]],
    moved: Collection[str],
    cameras: Iterable[Camera],
) -> Camera:
    """The camera in whose pictures most of the moved links is visible.

    The first camera is taken unless another shows clearly more.

    Args:
        cloud: Points on the robot.
        poses: Of the links, of each picture.
        moved: The links that move.
        cameras: At least one.
    """
    moves = np.isin(cloud.link, [row for row, name in enumerate(cloud.links) if name in moved])
    points = []
    for some in poses:
        placed = cloud.at(some)
        there = np.isfinite(placed).all(axis=1) & (np.abs(placed) < LARGEST).all(axis=1)
        points.append((placed[there], moves[there]))
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


def hidden_pixels(shapes: Shapes, poses: Mapping[str, Pose], moved: Mask, view: View) -> Mask:
    """The pixels at which others are in front of moved triangles, shape (height, width)."""
    corners, _, there = shapes.posed(poses)
    rows = np.flatnonzero(there)
    hidden = np.zeros(view.size[0] * view.size[1], dtype=bool)
    if moved[rows].any():
        seen = view.seen(corners[rows])
        flat, owner = clipped(seen, view.reach, view.size, nearest(seen))
        moves = moved[rows][owner]
        first, _ = front(flat, view.size)
        behind, _ = front(flat[moves], view.size)
        hidden = (behind >= 0) & ~moves[first]
    return hidden.reshape(view.size[1], view.size[0])


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
    hidden = hidden_pixels(shapes, poses, moved, view)
    if hidden.any():
        links = {shapes.links[row] for row in np.unique(shapes.link[moved])}
        alone = {name: pose for name, pose in poses.items() if name in links}
        behind = draw(shapes, alone, camera=view, ground=False)
        mixed = (1 - _THROUGH) * image[hidden] + _THROUGH * behind[hidden]
        image[hidden] = np.rint(mixed).astype(image.dtype)
    return image
