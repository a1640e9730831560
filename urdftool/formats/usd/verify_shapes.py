"""Comparison of the shapes of a stage with those of its source."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from ...compare.check import Check
from ...errors import UrdftoolError
from ...geometry.load import load_named
from ...mechanics.reference import get_origin_matrix
from ...model.elements import Collision, Ellipsoid, Geometry, Link, Mesh, Plane, Robot, Visual
from ...model.shapes import get_shape_name
from .verify_pair import Pair

Array = npt.NDArray[np.float64]

TOLERANCE = 2e-6
"""Relative: sizes of primitives are doubles, points of meshes 32-bit floats."""

_LOST = ("lossy-shape", "lossy-ellipsoid", "mesh-not-found", "corrupt-mesh", "bad-scale")


def compare_shapes(pair: Pair) -> list[Check]:
    """Compare type, size and pose of all shapes, and the colors of primitives."""
    checks = []
    for kind in ("visuals", "collisions"):
        check = Check(kind, "types, sizes and poses; of meshes area and second moments", TOLERANCE)
        for link, other in pair.links:
            codes = (*_LOST, *["lossy-convex"] * (kind == "collisions"))
            known = pair.losses.has_for(codes, link.name)
            _compare(check, pair, link, getattr(link, kind), getattr(other, kind), known)
        checks.append(check)
    colors = Check("colors", "of primitive shapes", 1e-5)
    for link, other in pair.links:
        theirs = [v for v in other.visuals if _is_primitive(v.geometry)]
        ours = [v for v in link.visuals if _is_primitive(v.geometry)]
        for one, two in zip(ours, theirs, strict=False):
            _compare_color(colors, pair, link, one, two)
    return [*checks, colors]


def _compare(
    check: Check,
    pair: Pair,
    link: Link,
    ours: list[Visual] | list[Collision],
    theirs: list[Visual] | list[Collision],
    known: bool,
) -> None:
    mine = [s for s in ours if _is_primitive(s.geometry)]
    other = [s for s in theirs if _is_primitive(s.geometry)]
    name = f"link '{link.name}'"
    check.compare(float(len(mine) != len(other)), f"number of shapes of {name}", known=known)
    for one, two in zip(mine, other, strict=False):
        label = f"{get_shape_name(one.geometry)} of {name}" if one.geometry else name
        check.compare(_compute_distance(one, two), label, known=known)
    have, got = _measure_meshes(pair.source, ours), _measure_meshes(pair.made, theirs)
    if have is None or got is None:
        check.compare(float((have is None) != (got is None)), f"meshes of {name}", known=known)
        return
    size = np.maximum(np.abs(have), float(np.abs(have).max()) * 1e-3 + 1e-12)
    difference = float((np.abs(have - got) / size).max())
    check.compare(difference if difference > 1e-4 else 0.0, f"meshes of {name}", known=known)


def _is_primitive(geometry: Geometry | None) -> bool:
    return geometry is not None and not isinstance(geometry, (Mesh, Ellipsoid))


def _get_numbers(geometry: Geometry | None) -> Iterator[float]:
    if isinstance(geometry, Plane):
        return
    for name in ("size", "radius", "length"):
        value = getattr(geometry, name, ())
        yield from value if isinstance(value, tuple) else (value,)


def _compute_distance(one: Visual | Collision, other: Visual | Collision) -> float:
    if type(one.geometry) is not type(other.geometry):
        return 1.0
    ours, theirs = (
        np.array([*_get_numbers(one.geometry)]),
        np.array([*_get_numbers(other.geometry)]),
    )
    difference = np.abs(get_origin_matrix(one.origin) - get_origin_matrix(other.origin)).max()
    if len(ours):
        difference = max(difference, (np.abs(ours - theirs) / np.maximum(ours, 1e-9)).max())
    return float(difference)


def _measure_meshes(robot: Robot, shapes: list[Visual] | list[Collision]) -> Array | None:
    """Return area [m²], its centroid and second moments of all meshes; None without a mesh."""
    found = []
    for shape in shapes:
        if not isinstance(shape.geometry, Mesh):
            continue
        corners = _load_corners(robot, shape.geometry)
        if corners is not None:
            frame = get_origin_matrix(shape.origin)
            found.append(corners @ frame[:3, :3].T + frame[:3, 3])
    if not found:
        return None
    corners = np.concatenate(found)
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    middles = corners.mean(axis=1)
    total = max(float(areas.sum()), 1e-30)
    center = areas @ middles / total
    spread = middles - center
    second = np.sqrt(np.abs(areas @ (spread * spread) / total))
    return np.array([np.sqrt(total), *center, *second])


def _load_corners(robot: Robot, mesh: Mesh) -> Array | None:
    if robot.source is None:
        return None
    try:
        loaded = load_named(robot.source, mesh.filename, mesh.scale)
    except UrdftoolError:
        return None
    return loaded.vertices[loaded.faces]


def _compare_color(check: Check, pair: Pair, link: Link, one: Visual, other: Visual) -> None:
    named = {m.name: m for m in pair.source.materials}
    material = one.material
    if material is not None and material.color is None:
        material = named.get(material.name, material)
    color = material.color if material is not None else None
    if color is None:
        return
    theirs = other.material.color if other.material is not None else None
    clipped = np.clip(np.array(color), 0.0, 1.0)
    difference = 1.0 if theirs is None else float(np.abs(clipped - np.array(theirs)).max())
    check.compare(difference, f"link '{link.name}'")
