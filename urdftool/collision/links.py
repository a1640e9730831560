"""Selection of the links that get new collision geometry, and of its source meshes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ConfigError, MeshError, UrdftoolError
from ..geometry.link_extent import get_shape_points
from ..model.elements import Collision, Link, Mesh, Robot, UnknownShape, Visual
from ..model.pose import Pose, make_pose
from ..suggestions import require_word, suggest_name
from .compute import PlacedMesh, Task
from .settings import METHODS, QUALITIES, SOURCES, Settings

Shape = Visual | Collision

TOGETHER = ("auto", "cuts")
"""Methods that simplify the meshes of a link together; the others give a result for each mesh."""

_DIGITS = 9  # of the relative pose of meshes, so that equal links are computed once; chosen

_NUMBERS = ("max-error", "threshold", "time-limit")
_COUNTS = ("max-hulls", "max-vertices", "max-triangles", "count")


@dataclass(frozen=True, eq=False)
class Use:
    """A shape for a new collision: a mesh with its task, or a primitive that is kept."""

    shape: Shape
    task: Task | None


@dataclass(eq=False)
class LinkPlan:
    """Plan for the collisions of a link.

    Attributes:
        index: Index of the link in the robot.
        link: The link.
        source: ``"visual"`` or ``"collision"``, the source of its shapes.
        uses: Shapes of the new collisions.
        replaced: Indices of the link's collisions that are removed.
    """

    index: int
    link: Link
    source: str
    uses: list[Use]
    replaced: list[int] = field(default_factory=list)


@dataclass(frozen=True)
class CollisionOptions:
    """Options for simplifying the collisions of a robot.

    Attributes:
        settings: Settings of every link.
        source: ``"visual"``, ``"collision"``, or None for visuals, or collisions if there are none.
        only: Links to process; all if empty.
        skip: Links to leave unchanged.
        keep_primitives: Whether to keep collisions that are primitives.
        per_mesh: Whether each mesh has pieces of its own with every method.
        table: The ``collision`` table of the configuration.
        path: File of that table.
    """

    settings: Settings = field(default_factory=Settings)
    source: str | None = None
    only: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    keep_primitives: bool = True
    per_mesh: bool = False
    table: Mapping[str, Any] = field(default_factory=dict)
    path: str | None = None
    given: tuple[str, ...] = ()
    """Settings given on the command line, which override the configuration."""

    def __post_init__(self) -> None:
        """Raise ConfigError if the source is unknown."""
        if self.source is not None:
            require_word("source", self.source, SOURCES)


def plan(robot: Robot, options: CollisionOptions) -> tuple[list[LinkPlan], list[UrdftoolError]]:
    """Plan the new collisions of a robot.

    Returns:
        The plans, and an error for each mesh that cannot be used.

    Raises:
        ConfigError: A named link or a setting does not exist.
    """
    plans: list[LinkPlan] = []
    problems: list[UrdftoolError] = []
    for index, link, settings in list_selected(robot, options):
        found = _link_plan(index, link, options)
        if found is None:
            continue
        source, shapes, replaced = found
        uses = []
        for shape in shapes:
            try:
                uses.append(Use(shape, _make_task(robot, shape, settings)))
            except UrdftoolError as error:
                problems.append(error)
        if settings.method in TOGETHER and not options.per_mesh:
            uses = _unite_meshes(uses)
        plans.append(LinkPlan(index, link, source, list(_divide_count(robot, uses)), replaced))
    return plans, problems


def list_selected(robot: Robot, options: CollisionOptions) -> Iterator[tuple[int, Link, Settings]]:
    """Yield the links that are not left out, each with its index and its settings.

    Raises:
        ConfigError: A named link or a setting does not exist.
    """
    _check_names(robot, (*options.only, *options.skip))
    for index, link in enumerate(robot.links):
        settings, skipped = get_settings(link.name, options)
        is_named = not options.only or link.name in options.only
        if is_named and link.name not in options.skip and not skipped:
            yield index, link, settings


def _unite_meshes(uses: list[Use]) -> list[Use]:
    """Return the shapes of a link, its meshes in one task, at the place of the first mesh."""
    meshes = [use for use in uses if use.task is not None]
    if len(meshes) < 2:
        return uses
    first = meshes[0]
    assert first.task is not None
    inverse = make_pose(first.shape.origin).invert()
    others = tuple(
        PlacedMesh(
            use.task.path, use.task.scale, _round_pose(inverse @ make_pose(use.shape.origin))
        )
        for use in meshes[1:]
        if use.task is not None
    )
    united = replace(first, task=replace(first.task, others=others))
    return [united if use is first else use for use in uses if use is first or use.task is None]


def _round_pose(pose: Pose) -> Pose:
    x, y, z = ([round(value, _DIGITS) for value in row] for row in pose.rotation)
    a, b, c = (round(value, _DIGITS) for value in pose.translation)
    return Pose(((x[0], x[1], x[2]), (y[0], y[1], y[2]), (z[0], z[1], z[2])), (a, b, c))


def _divide_count(robot: Robot, uses: Sequence[Use]) -> Iterator[Use]:
    """Yield the shapes of a link, the number of its spheres divided by the sizes of its meshes.

    Each mesh has one sphere at least. The rest go one by one to the mesh with the largest size for
    each of its spheres.
    """
    meshes = [use for use in uses if use.task is not None]
    count = next((use.task.settings.spheres for use in meshes if use.task is not None), None)
    if count is None or len(meshes) < 2:
        yield from uses
        return
    sizes = {use: _measure_size(robot, use.shape) for use in meshes}
    shares = dict.fromkeys(meshes, 1)
    for _ in range(count - len(meshes)):
        shares[max(meshes, key=lambda use: sizes[use] / shares[use])] += 1
    for use in uses:
        if use.task is None:
            yield use
        else:
            settings = replace(use.task.settings, count=shares[use])
            yield replace(use, task=replace(use.task, settings=settings))


def _measure_size(robot: Robot, shape: Shape) -> float:
    """Return the diagonal [m] of the bounding box of a mesh; 0 if it cannot be read."""
    points = get_shape_points(robot, shape)
    return 0.0 if points is None else float(np.linalg.norm(np.ptp(points, axis=0)))


def _link_plan(
    index: int, link: Link, options: CollisionOptions
) -> tuple[str, Sequence[Shape], list[int]] | None:
    """Return source, shapes and replaced collisions; None if the link stays unchanged."""
    meshes = [n for n, shape in enumerate(link.collisions) if isinstance(shape.geometry, Mesh)]
    others = [n for n in range(len(link.collisions)) if n not in meshes]
    has_visual = any(isinstance(shape.geometry, Mesh) for shape in link.visuals)
    source = options.source or ("visual" if has_visual else "collision")
    if options.keep_primitives and others and not meshes:
        return None
    if source == "visual":
        if not has_visual:
            return None
        shapes: Sequence[Shape] = [s for s in link.visuals if _is_known(s)]
        replaced = meshes if options.keep_primitives else list(range(len(link.collisions)))
        return source, shapes, replaced
    if not meshes:
        return None
    return source, [link.collisions[n] for n in meshes], meshes


def _is_known(shape: Shape) -> bool:
    return shape.geometry is not None and not isinstance(shape.geometry, UnknownShape)


def _make_task(robot: Robot, shape: Shape, settings: Settings) -> Task | None:
    mesh = shape.geometry
    if not isinstance(mesh, Mesh):
        return None
    place = mesh.locate_attribute("filename")
    if not mesh.filename:
        raise MeshError("the mesh has no filename", at=place)
    assert robot.source is not None
    try:
        path = robot.source.resolve(mesh.filename)
    except UrdftoolError as error:
        raise MeshError(error.message, at=place, notes=error.notes) from error
    if not os.path.isfile(path):
        raise MeshError(f"there is no mesh file {path}", at=place)
    if not all(mesh.scale):
        raise MeshError(
            "the scale of the mesh has a factor of zero; all three must differ from zero",
            at=mesh.locate_attribute("scale"),
        )
    return Task(Path(path), mesh.scale, settings, robot.source.gltf_up)


def _check_names(robot: Robot, names: Iterable[str]) -> None:
    """Raise ConfigError for names that are not links of the robot."""
    for name in names:
        if name not in robot.link:
            hint = suggest_name(name, robot.link, 0.6)
            raise ConfigError(f"the robot has no link '{name}'{hint}")


def get_settings(name: str, options: CollisionOptions) -> tuple[Settings, bool]:
    """Return the settings of a link, and whether it is skipped.

    Raises:
        ConfigError: A setting of the configuration does not exist, or has no such value.
    """
    table: dict[str, Any] = {}
    for key, value in options.table.items():
        if key != "links":
            table[key] = value
    links = options.table.get("links", {})
    if not isinstance(links, dict):
        raise ConfigError(
            "collision.links requires tables such as [collision.links.base_link]", path=options.path
        )
    own: dict[str, Any] = {}
    for pattern, values in links.items():
        if not isinstance(values, dict):
            raise ConfigError(f"collision.links.{pattern} must be a table", path=options.path)
        if fnmatchcase(name, pattern):
            own.update(values)
    skipped = own.pop("skip", False) is True
    general = {
        k: v for k, v in _read_settings(table, options.path).items() if k not in options.given
    }
    changes = {**general, **(own := _read_settings(own, options.path))}
    if "max_error" in options.given and "quality" not in own:
        changes.setdefault("max_error", options.settings.max_error)
    return options.settings.replace_some(changes), skipped


def _read_settings(table: Mapping[str, Any], path: str | None) -> dict[str, Any]:
    settings: dict[str, Any] = {}
    for key, value in table.items():
        if key == "method":
            if value not in METHODS:
                raise ConfigError(
                    f"collision.method is '{value}'; there are {', '.join(METHODS)}", path=path
                )
        elif key == "quality":
            if value not in QUALITIES:
                known = ", ".join(QUALITIES)
                raise ConfigError(f"collision.quality is '{value}', not one of {known}", path=path)
        elif key == "cover":
            if not isinstance(value, bool):
                raise ConfigError("collision.cover must be true or false", path=path)
        elif key in _NUMBERS or key in _COUNTS:
            whole = key in _COUNTS
            if isinstance(value, bool) or not isinstance(value, int if whole else (int, float)):
                raise ConfigError(f"collision.{key} must be a number", path=path)
            if value <= 0 or (key == "max-vertices" and value < 4):
                raise ConfigError(f"collision.{key} is {value}, which is too small", path=path)
        else:
            known = ", ".join(("method", "quality", *_NUMBERS, *_COUNTS, "cover", "links"))
            raise ConfigError(f"no option is called collision.{key}; there are {known}", path=path)
        settings[key.replace("-", "_")] = value
    return settings
