"""What touches and what is seen, in MuJoCo's model and in the description: boxes and colours."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...errors import UrdftoolError
from ...meshes.load import load_named
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Link,
    Mesh,
    Robot,
    Sphere,
    UnknownShape,
    Visual,
)
from ..check import Check
from ..mechanics import Array, Mechanics, origin_matrix
from .announced import CUT, LOOKS, SHAPES, TORN, Said
from .compiled import Compiled
from .convert import Image, part_image

SIMPLE, MESH = 1e-9, 1e-6
SINGLE = 2.0**-23
"""What MuJoCo's numbers of a mesh's points are rounded by, relative to its size."""

Bounds = tuple[Array, Array]


def collision_check(
    robot: Robot,
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    said: Said,
) -> Check:
    """Each collision's box in the root's frame, at zero and at one other configuration."""
    check = Check("collision", "number, kind and box of every shape", MESH)
    for positions in configurations[:2]:
        frames = mechanics.frames(positions)
        compiled.pose(positions)
        for link in robot.links:
            geoms = list(_geoms(compiled, link, 3))
            known = said.of((*SHAPES, *CUT), *_about(link)) or said.any(*TORN)
            if len(geoms) != len(link.collisions):
                text = f"link '{link.name}': {len(geoms)} collisions of {len(link.collisions)}"
                check.compare(math.inf, text, known=known)
                continue
            for shape, geom in zip(link.collisions, geoms, strict=True):
                expected = _bounds(robot, shape, frames.get(link.name, np.eye(4)))
                if expected is None:
                    continue
                simple = not isinstance(shape.geometry, Mesh)
                factor = MESH / SIMPLE if simple else _rounded(expected)  # to that of the row
                difference = _apart(expected, _geom_bounds(compiled, geom)) * factor
                check.compare(difference, f"a collision of link '{link.name}'", known=known)
    return check


def visual_check(
    robot: Robot,
    mechanics: Mechanics,
    compiled: Compiled,
    configurations: list[dict[str, float]],
    said: Said,
) -> Check:
    """The box of all that is seen of a link, and its colours."""
    check = Check("visual", "box and colours of every link", MESH)
    frames = mechanics.frames(configurations[0])
    compiled.pose(configurations[0])
    for link in robot.links:
        known = said.of(SHAPES, *_about(link)) or said.any(*TORN)
        geoms = list(_geoms(compiled, link, 2))
        frame = frames.get(link.name, np.eye(4))
        boxes = [box for v in link.visuals if (box := _bounds(robot, v, frame)) is not None]
        if bool(boxes) != bool(geoms):
            text = f"link '{link.name}': {len(geoms)} visuals of {len(boxes)}"
            check.compare(math.inf, text, known=known)
        elif boxes:
            found = _union([_geom_bounds(compiled, geom) for geom in geoms])
            difference = _apart(_union(boxes), found) * _rounded(_union(boxes))
            check.compare(difference, f"visuals of link '{link.name}'", known=known)
        expected = sorted(_colors(robot, link))
        seen = sorted(_rgba(compiled, geom) for geom in geoms)
        if expected and len(expected) == len(seen):
            apart = float(abs(np.array(expected) - np.array(seen)).max())
            painted = known or said.of(LOOKS, *_about(link))
            check.compare(apart, f"colours of link '{link.name}'", known=painted)
    return check


def _geoms(compiled: Compiled, link: Link, group: int) -> Iterator[int]:
    """The geoms of a link in a group, in the order of the file."""
    body = compiled.body(link.name)
    for geom in range(compiled.model.ngeom):
        if compiled.model.geom_bodyid[geom] == body and compiled.model.geom_group[geom] == group:
            yield geom


def _apart(one: Bounds, other: Bounds) -> float:
    return float(max(abs(one[0] - other[0]).max(), abs(one[1] - other[1]).max()))


def _rounded(box: Bounds) -> float:
    """What a difference counts of a mesh that is too large for single precision; else 1."""
    return min(1.0, MESH / (SINGLE * float(np.max(box[1] - box[0])) or MESH))


def _union(boxes: list[Bounds]) -> Bounds:
    return np.min([box[0] for box in boxes], axis=0), np.max([box[1] for box in boxes], axis=0)


def _bounds(robot: Robot, shape: Visual | Collision, frame: Array) -> Bounds | None:
    """The box of a shape of the description; None where it has no size or cannot be read."""
    pose = frame @ origin_matrix(shape.origin)
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        if robot.source is None:
            return None
        try:
            points = load_named(robot.source, geometry.filename, geometry.scale)
        except UrdftoolError:
            return None
        used = points.vertices[np.unique(points.faces)]
        placed = used @ pose[:3, :3].T + pose[:3, 3]
        return placed.min(axis=0), placed.max(axis=0)
    half = _half(geometry, pose[:3, :3]) if geometry is not None else None
    return None if half is None else (pose[:3, 3] - half, pose[:3, 3] + half)


def _half(geometry: Geometry, turn: Array) -> Array | None:
    """Half the edges of the box around a simple shape, along the axes it is turned into."""
    if isinstance(geometry, Box):
        return abs(turn) @ np.array(geometry.size) / 2 if min(geometry.size) > 0 else None
    if isinstance(geometry, UnknownShape):
        return None
    if isinstance(geometry, Sphere):
        return np.full(3, geometry.radius) if geometry.radius > 0 else None
    if isinstance(geometry, Cylinder | Capsule):
        return _round_half(
            isinstance(geometry, Capsule), geometry.radius, geometry.length / 2, turn
        )
    return None


def _round_half(capsule: bool, radius: float, half: float, turn: Array) -> Array | None:
    if radius <= 0 or half < 0 or (half == 0 and not capsule):
        return None
    across = np.ones(3) if capsule else np.hypot(turn[:, 0], turn[:, 1])
    reach: Array = abs(turn[:, 2]) * half + radius * across
    return reach


def _geom_bounds(compiled: Compiled, geom: int) -> Bounds:
    """The box of a geom in the root's frame."""
    model, frame = compiled.model, compiled.geom_frame(geom)
    kind = compiled.mujoco.mjtGeom(model.geom_type[geom]).name.removeprefix("mjGEOM_").lower()
    size, turn, middle = model.geom_size[geom], frame[:3, :3], frame[:3, 3]
    if kind == "mesh":
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        points = model.mesh_vert[first : first + count].astype(float) @ turn.T + middle
        return points.min(axis=0), points.max(axis=0)
    if kind == "box":
        half = abs(turn) @ size
    elif kind == "sphere":
        half = np.full(3, size[0])
    elif kind in ("cylinder", "capsule"):
        rounded = _round_half(kind == "capsule", float(size[0]), float(size[1]), turn)
        half = np.zeros(3) if rounded is None else rounded
    else:
        half = np.sqrt(((turn * size) ** 2).sum(axis=1))
    return middle - half, middle + half


def _about(link: Link) -> set[str]:
    """The names under which a loss may be of a link: its own, its materials', its meshes'."""
    names = {link.name}
    names |= {visual.material.name for visual in link.visuals if visual.material is not None}
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    for shape in shapes:
        if isinstance(shape.geometry, Mesh):
            names.add(shape.geometry.filename.rpartition("/")[2])
    return names


def _rgba(compiled: Compiled, geom: int) -> tuple[float, ...]:
    material = compiled.model.geom_matid[geom]
    source = compiled.model.mat_rgba[material] if material >= 0 else compiled.model.geom_rgba[geom]
    return tuple(float(part) for part in source)


def _seen(look: tuple[tuple[float, ...] | None, Image | None]) -> tuple[float, ...] | None:
    """The colour of a part: white below an image that is there."""
    rgba, image = look
    there = os.path.isfile(image) if isinstance(image, Path) else image is not None
    return (1.0, 1.0, 1.0, 1.0) if there else rgba


def _colors(robot: Robot, link: Link) -> Iterator[tuple[float, ...]]:
    """The colours of a link's visuals by the description or its meshes; none if one has none."""
    colors: list[tuple[float, ...]] = []
    defined = {m.name: m for m in reversed(robot.materials) if m.color or m.texture}
    for visual in link.visuals:
        material = visual.material
        if material is not None and not (material.color or material.texture):
            material = defined.get(material.name)
        own = material.color if material is not None and not material.texture else None
        parts: list[tuple[float, ...] | None] = [own]
        if isinstance(visual.geometry, Mesh) and robot.source is not None:
            try:
                mesh = load_named(robot.source, visual.geometry.filename)
            except UrdftoolError:
                return
            looks = dict.fromkeys((part.rgba, part_image(part)) for part in mesh.parts)
            parts = [own if rgba is None else rgba for rgba in map(_seen, looks)]
        if None in parts or _bounds(robot, visual, np.eye(4)) is None:
            return
        colors += [part for part in parts if part is not None]
    yield from colors
