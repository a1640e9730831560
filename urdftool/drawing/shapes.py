"""The triangles of a robot with their colours, link by link."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ..errors import MeshError, UrdftoolError
from ..meshes.mesh import Faces, Mesh, Part, Points
from ..meshes.tessellate import tessellate
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Material,
    Robot,
    Sphere,
    Vector,
    Visual,
)
from ..model.elements import Mesh as MeshGeometry
from ..model.pose import Pose, pose_of
from .materials import PLAIN, Materials, Rgba, clean, from_linear
from .normals import corner_normals
from .raster import Floats, Indices
from .texture import Texels, read_texture

SHOWS = ("visual", "collision", "both")

OVERLAY: Rgba = (0.98, 0.47, 0.13, 0.38)
"""Colour of collisions that are drawn over visuals."""

TOUCHED: Rgba = (0.93, 0.62, 0.38, 1.0)
"""Colour of collisions that are drawn alone."""

AROUND = 64
"""Corners of a circle."""

Progress = Callable[[int, int, str], None]


@dataclass(frozen=True, eq=False)
class Shapes:
    """Triangles of links, each in the frame of its link.

    Attributes:
        links: Names of the links, in the order of the file.
        corners: Corners [m], shape (m, 3, 3).
        normals: Unit normals at the corners, shape (m, 3, 3).
        colors: Red, green, blue and opacity in 0 … 1, as files have them, shape (m, 4).
        uv: Where each corner lies in its image, shape (m, 3, 2); from its lower left corner.
        image: Row of ``images``, -1 for none, shape (m,).
        link: Row of ``links``, shape (m,).
        images: The images that are used.
        problems: What could not be loaded, each with its place in the description.
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
        """How many triangles there are."""
        return len(self.corners)

    def painted(self, colors: Floats) -> Shapes:
        """The same triangles in other colours, shape (m, 4), and without images."""
        none = np.full(len(self), -1, dtype=np.int64)
        return Shapes(
            self.links, self.corners, self.normals, colors, self.uv, none, self.link, (),
            self.problems,
        )  # fmt: skip

    def posed(self, poses: Mapping[str, Pose]) -> tuple[Floats, Floats, npt.NDArray[np.bool_]]:
        """Corners and normals in the world, and which triangles are to be seen there.

        Those of links without a pose, or with one that has a number that is not finite, are not.
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
            if not (np.isfinite(rotation).all() and np.isfinite(shift).all()):
                continue
            corners[some] = self.corners[some] @ rotation.T + shift
            normals[some] = self.normals[some] @ rotation.T
            there[some] = True
        return corners, normals, there


def bare_shapes(groups: Iterable[tuple[Points, Faces, Rgba]], link: str = "") -> Shapes:
    """Triangles that are of no robot, as those of one link.

    Args:
        groups: Vertices [m], shape (n, 3), faces, shape (m, 3), and the colour of each group.
        link: What the link is called.
    """
    corners, normals, colors = [np.zeros((0, 3, 3))], [np.zeros((0, 3, 3))], [np.zeros((0, 4))]
    for vertices, faces, rgba in groups:
        corners.append(vertices[faces])
        normals.append(corner_normals(vertices, faces))
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


@dataclass
class _Surface:
    """Triangles of one shape in the frame of its ``<geometry>``, with what its file says of them.

    ``image`` numbers the images of the gathering; ``colored`` marks triangles whose colour, and
    not only their place, is from the file.
    """

    corners: Points
    normals: Floats
    colors: Floats
    colored: npt.NDArray[np.bool_]
    uv: Floats
    has_uv: npt.NDArray[np.bool_]
    image: Indices


@dataclass
class _Gathering:
    robot: Robot
    materials: Materials
    images: list[Texels] = field(default_factory=list)
    problems: dict[str, UrdftoolError] = field(default_factory=dict)
    image_rows: dict[object, int] = field(default_factory=dict)
    surfaces: dict[tuple[str, Vector], _Surface | MeshError] = field(default_factory=dict)

    def image(self, source: object, at: MeshGeometry | Material) -> int:
        """The row of an image; -1 where it cannot be read, which is noted."""
        if source not in self.image_rows:
            self.image_rows[source] = -1
            try:
                self.images.append(read_texture(source))  # type: ignore[arg-type]
                self.image_rows[source] = len(self.images) - 1
            except MeshError as error:
                self.note(f"texture of {_named(at)}: {error}", at)
        return self.image_rows[source]

    def note(self, message: str, at: MeshGeometry | Material | Visual | Collision) -> None:
        """Keep a problem, once for each place."""
        error = MeshError(message, at=at.place)
        self.problems.setdefault(str(error), error)


def robot_shapes(
    robot: Robot, *, show: str = "visual", progress: Progress = lambda *_: None
) -> Shapes:
    """What is to be seen of a robot.

    Colours are as RViz has them: what a mesh file says of its own parts comes first, then the
    visual's material; of several materials of one name the first counts.

    Args:
        robot: The robot, read from a description, which finds its packages.
        show: ``"visual"``, ``"collision"``, or ``"both"``, the collisions see-through.
        progress: Told of each mesh before it is read: its number, how many, its URI.

    Raises:
        ValueError: ``show`` is none of the three.
    """
    if show not in SHOWS:
        raise ValueError(f"show is one of {', '.join(SHOWS)}, not {show!r}")
    gathering = _Gathering(robot, Materials(robot))
    wanted = list(_wanted(robot, show))
    uris = dict.fromkeys(
        shape.geometry.filename for _, shape in wanted if isinstance(shape.geometry, MeshGeometry)
    )
    numbers = {uri: number for number, uri in enumerate(uris, 1)}
    told: set[str] = set()
    pieces: list[tuple[int, _Surface]] = []
    for row, shape in wanted:
        geometry = shape.geometry
        if isinstance(geometry, MeshGeometry) and geometry.filename not in told:
            told.add(geometry.filename)
            progress(numbers[geometry.filename], len(numbers), geometry.filename)
        surface = _surface(gathering, shape)
        if surface is None:
            continue
        placed = _placed(surface, pose_of(shape.origin))
        if not np.isfinite(placed.corners).all():
            gathering.note("the shape has a number that is not finite; it is not drawn", shape)
            continue
        pieces.append((row, _dressed(gathering, placed, shape, show)))
    return _joined(gathering, pieces)


def _wanted(robot: Robot, show: str) -> Iterator[tuple[int, Visual | Collision]]:
    for row, link in enumerate(robot.links):
        if show != "collision":
            yield from ((row, visual) for visual in link.visuals)
        if show != "visual":
            yield from ((row, collision) for collision in link.collisions)


def _surface(gathering: _Gathering, shape: Visual | Collision) -> _Surface | None:
    geometry = shape.geometry
    if isinstance(geometry, MeshGeometry):
        try:
            return _mesh_surface(gathering, geometry)
        except UrdftoolError as error:
            gathering.note(f"mesh '{geometry.filename}': {error.message}", geometry)
            return None
    sized = _sized(geometry)
    if sized is None:
        return None
    kind, size = sized
    if not np.isfinite(size).all():
        gathering.note(f"the {kind} has a size that is not finite; it is not drawn", shape)
        return None
    vertices, faces = tessellate(kind, size, AROUND)
    return _bare(vertices, faces)


def _sized(geometry: Geometry | None) -> tuple[str, Vector] | None:
    """The kind and lengths of a primitive."""
    if isinstance(geometry, Box):
        return "box", geometry.size
    if isinstance(geometry, Cylinder):
        return "cylinder", (geometry.radius, geometry.length, 0.0)
    if isinstance(geometry, Capsule):
        return "capsule", (geometry.radius, geometry.length, 0.0)
    if isinstance(geometry, Sphere):
        return "sphere", (geometry.radius, 0.0, 0.0)
    return None


def _bare(vertices: Points, faces: Faces) -> _Surface:
    count = len(faces)
    return _Surface(
        vertices[faces],
        corner_normals(vertices, faces),
        np.tile(np.array(PLAIN), (count, 1)),
        np.zeros(count, dtype=bool),
        np.zeros((count, 3, 2)),
        np.zeros(count, dtype=bool),
        np.full(count, -1, dtype=np.int64),
    )


def _mesh_surface(gathering: _Gathering, geometry: MeshGeometry) -> _Surface:
    """A mesh file at a scale, read once.

    Raises:
        UrdftoolError: It is not found, or cannot be read.
    """
    from ..meshes.load import load_mesh

    key = (geometry.filename, geometry.scale)
    if key not in gathering.surfaces:
        source = gathering.robot.source
        if source is None:
            raise MeshError("a robot that was not read from a file has no meshes")
        try:
            mesh = load_mesh(source.resolve(geometry.filename), geometry.scale)
        except UrdftoolError as error:
            found = MeshError(error.message)
            gathering.surfaces[key] = found
            raise found from error
        surface = _bare(mesh.vertices, mesh.faces)
        for part in mesh.parts:
            _look(gathering, geometry, surface, mesh, part)
        gathering.surfaces[key] = surface
    surface_or_error = gathering.surfaces[key]
    if isinstance(surface_or_error, MeshError):
        raise surface_or_error
    return surface_or_error


def _look(
    gathering: _Gathering, geometry: MeshGeometry, surface: _Surface, mesh: Mesh, part: Part
) -> None:
    """Give a part the colour and image that its file says."""
    some = slice(part.first, part.first + part.count)
    image = part.texture if part.image is None else part.image
    row = -1 if image is None else gathering.image(image, geometry)
    linear = mesh.format in ("gltf", "glb")  # its factors are of linear light
    rgba = from_linear(part.rgba) if part.rgba is not None and linear else part.rgba
    if part.uv is not None:
        surface.uv[some], surface.has_uv[some] = part.uv, True
    if row >= 0:
        # of an image only glTF says that the colour is multiplied with it
        opacity = 1.0 if part.rgba is None else part.rgba[3]
        color = clean(rgba if rgba is not None and linear else (1.0, 1.0, 1.0, opacity))
        if part.uv is None:
            color = _mean(gathering.images[row])
            row = -1
        surface.image[some], surface.colors[some] = row, color
        surface.colored[some] = True
    elif rgba is not None:
        surface.colors[some], surface.colored[some] = clean(rgba), True


def _mean(texels: Texels) -> Rgba:
    red, green, blue, alpha = (float(v) for v in texels.reshape(-1, 4).mean(axis=0) / 255)
    return red, green, blue, alpha


def _placed(surface: _Surface, pose: Pose) -> _Surface:
    rotation, shift = np.array(pose.rotation), np.array(pose.translation)
    return _Surface(
        surface.corners @ rotation.T + shift,
        surface.normals @ rotation.T,
        surface.colors,
        surface.colored,
        surface.uv,
        surface.has_uv,
        surface.image,
    )


def _dressed(
    gathering: _Gathering, surface: _Surface, shape: Visual | Collision, show: str
) -> _Surface:
    """The surface in the colours of its visual or collision."""
    count = len(surface.corners)
    if isinstance(shape, Collision):
        color = OVERLAY if show == "both" else TOUCHED
        surface.colors = np.tile(np.array(color), (count, 1))
        surface.image = np.full(count, -1, dtype=np.int64)
        return surface
    material = gathering.materials.of(shape)
    bare = ~surface.colored
    if material is None or not bare.any():
        return surface
    surface.colors = surface.colors.copy()
    surface.image = surface.image.copy()
    row = _material_image(gathering, material)
    if material.color is not None:
        surface.colors[bare] = clean(material.color)
    if row >= 0:
        mapped = bare & surface.has_uv
        surface.colors[bare] = _mean(gathering.images[row])
        surface.colors[mapped] = 1.0
        surface.image[mapped] = row
    return surface


def _material_image(gathering: _Gathering, material: Material) -> int:
    if not material.texture or gathering.robot.source is None:
        return -1
    try:
        path = gathering.robot.source.resolve(material.texture)
    except UrdftoolError as error:
        gathering.note(f"texture of {_named(material)}: {error.message}", material)
        return -1
    return gathering.image(path, material)


def _named(part: MeshGeometry | Material) -> str:
    if isinstance(part, MeshGeometry):
        return f"mesh '{part.filename}'"
    return f"material '{part.name}'"


def _joined(gathering: _Gathering, pieces: list[tuple[int, _Surface]]) -> Shapes:
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
