"""Visibility of triangles, and rendering of hidden ones through what hides them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ..model.pose import Pose
from .camera import Camera, View
from .clip import compute_near_plane, project_triangles
from .load_geometry import LARGEST
from .picture import draw
from .png_file import Image
from .points import transform_points
from .raster import Floats, find_front
from .shapes import Shapes

Mask = npt.NDArray[np.bool_]

POINTS = 12_000
"""Number of sampled points for comparing views; each represents an equal area. Chosen, no
source."""

_GRID = (72, 60)  # pixels of the compared pictures
_THROUGH = 0.55  # weight of the hidden surface in a blended pixel; chosen
_NEAR = 0.01  # points this close in depth, relative to the scene's, are of one surface; chosen


class Cloud:
    """Points sampled from the triangles of a robot, each in the frame of its link.

    Attributes:
        links: Names of the links.
        link: Row of ``links`` of each point, shape (n,).
        points: Positions [m], shape (n, 3).
    """

    def __init__(self, shapes: Shapes) -> None:
        """Sample points from triangles by area, with a fixed seed."""
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

    def transform(self, poses: Mapping[str, Pose]) -> Floats:
        """Transform the points to the world, shape (n, 3); NaN if a link has no pose."""
        placed = np.full_like(self.points, np.nan)
        for row in np.unique(self.link):
            pose = poses.get(self.links[row])
            if pose is not None:
                some = self.link == row
                turn, shift = np.array(pose.rotation), np.array(pose.translation)
                placed[some] = transform_points(self.points[some], turn, shift)
        return placed


def choose_best_camera(
    cloud: Cloud,
    poses: Sequence[Mapping[str, Pose]],
    moved: Collection[str],
    cameras: Iterable[Camera],
) -> Camera:
    """Choose the camera whose pictures show most of the moved links.

    The first camera is preferred unless another shows over 1.5 times as many pixels.
    """
    moves = np.isin(cloud.link, [row for row, name in enumerate(cloud.links) if name in moved])
    points = []
    for some in poses:
        placed = cloud.transform(some)
        there = np.isfinite(placed).all(axis=1) & (np.abs(placed) < LARGEST).all(axis=1)
        points.append((placed[there], moves[there]))
    everything = np.concatenate([placed for placed, _ in points])
    first, *others = cameras
    if not len(everything) or not moves.any():
        return first
    best, most = first, 1.5 * _count_visible(points, first.view(everything, _GRID))
    for camera in others:
        count = _count_visible(points, camera.view(everything, _GRID))
        if count > most:
            best, most = camera, count
    return best


def _count_visible(points: Sequence[tuple[Floats, Mask]], view: View) -> int:
    """Count the pixels that show moved points, in the picture with the fewest."""
    counts = []
    for placed, moves in points:
        seen = view.transform(placed)
        depth = -seen[:, 2]
        ahead = depth > 0
        pixels = view.project(placed[ahead]).astype(np.int64)
        inside = ((pixels >= 0) & (pixels < np.array(view.size))).all(axis=1)
        cells = pixels[inside, 0] + pixels[inside, 1] * view.size[0]
        depth, moving = depth[ahead][inside], moves[ahead][inside]
        front_depth = np.full(view.size[0] * view.size[1], np.inf)
        np.minimum.at(front_depth, cells, depth)
        slack = _NEAR * float(np.ptp(depth)) if len(depth) else 0.0
        shown = moving & (depth <= front_depth[cells] + slack)
        counts.append(len(np.unique(cells[shown])))
    return min(counts)


def mask_hidden_pixels(shapes: Shapes, poses: Mapping[str, Pose], moved: Mask, view: View) -> Mask:
    """Mask the pixels where other triangles hide moved ones, shape (height, width)."""
    corners, _, there = shapes.transform(poses)
    rows = np.flatnonzero(there)
    hidden = np.zeros(view.size[0] * view.size[1], dtype=bool)
    if moved[rows].any():
        seen = view.transform(corners[rows])
        flat, owner = project_triangles(seen, view.reach, view.size, compute_near_plane(seen))
        moves = moved[rows][owner]
        first, _ = find_front(flat, view.size)
        behind, _ = find_front(flat[moves], view.size)
        hidden = (behind >= 0) & ~moves[first]
    return hidden.reshape(view.size[1], view.size[0])


def draw_through(
    shapes: Shapes, poses: Mapping[str, Pose], moved: Mask, *, view: View, ground: float
) -> Image:
    """Draw a picture of shapes in which moved triangles are visible through what hides them."""
    image = draw(shapes, poses, camera=view, ground=ground)
    hidden = mask_hidden_pixels(shapes, poses, moved, view)
    if hidden.any():
        links = {shapes.links[row] for row in np.unique(shapes.link[moved])}
        alone = {name: pose for name, pose in poses.items() if name in links}
        behind = draw(shapes, alone, camera=view, ground=False)
        mixed = (1 - _THROUGH) * image[hidden] + _THROUGH * behind[hidden]
        image[hidden] = np.rint(mixed).astype(image.dtype)
    return image
