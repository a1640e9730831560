"""Colored triangles of a robot, by link."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..errors import UrdftoolError
from ..geometry.mesh import Faces, Points
from ..model.elements import Collision, Robot, Visual
from ..model.elements import Mesh as MeshGeometry
from ..model.pose import Pose
from .detail import Detail
from .load_geometry import LARGEST, Gathering, Surface, read_surface
from .materials import Rgba, Tints
from .normals import compute_corner_normals
from .points import transform_points
from .raster import Floats, Indices
from .texture import Texels

SHOWS = ("visual", "collision", "both")

Progress = Callable[[int, int, str], None]


@dataclass(frozen=True, eq=False)
class Shapes:
    """Triangles of links, each in the frame of its link.

    Attributes:
        links: Names of the links, in the order of the file.
        corners: Corners [m], shape (m, 3, 3).
        normals: Unit normals at the corners, shape (m, 3, 3).
        colors: Red, green, blue and opacity in 0 … 1, as in the files, shape (m, 4).
        uv: Texture coordinates of the corners, from the image's lower left, shape (m, 3, 2).
        image: Row of ``images``, -1 for none, shape (m,).
        link: Row of ``links``, shape (m,).
        images: Images in use.
        problems: Geometry and images that could not be loaded, with their places.
    """

    links: tuple[str, ...]
    corners: Floats
    normals: Floats
    colors: Floats
    uv: Floats
    image: Indices
    link: Indices
    images: tuple[Texels, ...] = ()
    problems: tuple[UrdftoolError, ...] = ()

    def __len__(self) -> int:
        """Return the number of triangles."""
        return len(self.corners)

    def with_colors(self, colors: Floats) -> Shapes:
        """Return the same triangles in other colors, shape (m, 4), without images."""
        none = np.full(len(self), -1, dtype=np.int64)
        return Shapes(
            self.links, self.corners, self.normals, colors, self.uv, none, self.link, (),
            self.problems,
        )  # fmt: skip

    def transform(self, poses: Mapping[str, Pose]) -> tuple[Floats, Floats, npt.NDArray[np.bool_]]:
        """Transform corners and normals to the world, and return a mask of the visible triangles.

        Triangles of links without a pose, or with one that is infinite or too far away, are masked.
        """
        corners, normals = np.zeros_like(self.corners), np.zeros_like(self.normals)
        there = np.zeros(len(self), dtype=bool)
        bounds = np.searchsorted(self.link, np.arange(len(self.links) + 1))
        for row, name in enumerate(self.links):
            some = slice(int(bounds[row]), int(bounds[row + 1]))
            pose = poses.get(name)
            if pose is None or some.start == some.stop:
                continue
            rotation, shift = np.array(pose.rotation), np.array(pose.translation)
            if not (np.isfinite(rotation).all() and (np.abs(shift) < LARGEST).all()):
                continue
            corners[some] = transform_points(self.corners[some], rotation, shift)
            normals[some] = transform_points(self.normals[some], rotation)
            there[some] = True
        return corners, normals, there


def make_bare_shapes(groups: Iterable[tuple[Points, Faces, Rgba]], link: str = "") -> Shapes:
    """Create shapes of one link from triangles.

    Args:
        groups: Vertices [m], shape (n, 3), faces, shape (m, 3), and color of each group.
        link: Name of the link.
    """
    corners, normals, colors = [np.zeros((0, 3, 3))], [np.zeros((0, 3, 3))], [np.zeros((0, 4))]
    for vertices, faces, rgba in groups:
        corners.append(vertices[faces])
        normals.append(compute_corner_normals(vertices, faces))
        colors.append(np.tile(np.array(rgba), (len(faces), 1)))
    count = sum(map(len, corners))
    return Shapes(
        (link,),
        np.concatenate(corners),
        np.concatenate(normals),
        np.concatenate(colors),
        np.zeros((count, 3, 2)),
        np.full(count, -1, dtype=np.int64),
        np.zeros(count, dtype=np.int64),
    )


def read_robot_shapes(
    robot: Robot,
    *,
    show: str = "visual",
    progress: Progress = lambda *_: None,
    pixels: int | None = None,
) -> Shapes:
    """Read the visual or collision geometry of a robot.

    Colors follow RViz: those of a mesh file's parts take precedence over the visual's material; the
    first material of a name counts.

    Args:
        robot: The robot, with the description that resolves its URIs.
        show: ``"visual"``, ``"collision"``, or ``"both"`` with transparent collisions.
        progress: Called before each mesh is read, with its number, the number of meshes and its
            URI.
        pixels: Larger one of width and height of a picture that shows the whole robot; heavy meshes
            are then read with less detail, off by at most 1.8 pixels. None reads them as they are.

    Raises:
        ValueError: ``show`` is not one of the three.
    """
    if show not in SHOWS:
        raise ValueError(f"show must be one of {', '.join(SHOWS)}, not {show!r}")
    gathering = Gathering(robot, Tints(robot))
    selected = list(_list_selected(robot, show))
    if pixels is not None and robot.source is not None:
        gathering.read = Detail(robot, selected, pixels).read
    uris = dict.fromkeys(
        shape.geometry.filename for _, shape in selected if isinstance(shape.geometry, MeshGeometry)
    )
    numbers = {uri: number for number, uri in enumerate(uris, 1)}
    reported: set[str] = set()
    pieces: list[tuple[int, Surface]] = []
    for row, shape in selected:
        geometry = shape.geometry
        if isinstance(geometry, MeshGeometry) and geometry.filename not in reported:
            reported.add(geometry.filename)
            progress(numbers[geometry.filename], len(numbers), geometry.filename)
        surface = read_surface(gathering, shape, over=show == "both")
        if surface is not None:
            pieces.append((row, surface))
    return _concatenate(gathering, pieces)


def _list_selected(robot: Robot, show: str) -> Iterator[tuple[int, Visual | Collision]]:
    for row, link in enumerate(robot.links):
        if show != "collision":
            yield from ((row, visual) for visual in link.visuals)
        if show != "visual":
            yield from ((row, collision) for collision in link.collisions)


def _concatenate(gathering: Gathering, pieces: list[tuple[int, Surface]]) -> Shapes:
    names = tuple(link.name for link in gathering.robot.links)

    def together(kind: str, shape: tuple[int, ...]) -> Floats:
        parts = [getattr(surface, kind) for _, surface in pieces]
        return np.concatenate(parts) if parts else np.zeros((0, *shape))

    link = [np.full(len(surface.corners), row) for row, surface in pieces]
    return Shapes(
        names,
        together("corners", (3, 3)),
        together("normals", (3, 3)),
        together("colors", (4,)),
        together("uv", (3, 2)),
        together("image", ()).astype(np.int64),
        np.concatenate(link).astype(np.int64) if link else np.zeros(0, dtype=np.int64),
        tuple(gathering.images),
        tuple(gathering.problems.values()),
    )
