"""Differences of links: mass properties, visual geometry and collision geometry."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ..mechanics.tensor import SymmetricTensor, rotate_tensor
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Inertial,
    Link,
    Material,
    Mesh,
    Plane,
    Robot,
    Sphere,
    Visual,
)
from ..model.materials import resolve_material
from ..model.pose import Pose, make_pose, make_restored_pose, rpy_from_rotation
from ..model.shapes import get_shape_name
from .change import Change
from .tolerance import are_close, close, compute_distance, format_motion, is_same_pose

Shape = Visual | Collision


def link_changes(
    a: Link, b: Link, tolerance: float, robots: tuple[Robot, Robot]
) -> Iterator[Change]:
    """Yield the differences of a link.

    Args:
        a: The link in the first robot.
        b: The link in the second.
        tolerance: Tolerance as in ``closeness.TOLERANCE``.
        robots: Both robots, for named materials.
    """
    yield from _compare_inertials(a, b, tolerance)
    yield from _compare_shapes("visual", a.visuals, b.visuals, b, tolerance, robots)
    yield from _compare_shapes("collision", a.collisions, b.collisions, b, tolerance, robots)


def _compare_inertials(a: Link, b: Link, tolerance: float) -> Iterator[Change]:
    one, two, name = a.inertial, b.inertial, b.name
    if one is None or two is None:
        if one is not two:
            place = b.place if two is None else two.place
            yield Change(
                "link", name, "inertial", _get_mass(one), _get_mass(two), "kg", place=place
            )
        return
    place = two.place
    if not close(one.mass, two.mass, tolerance):
        remark = _format_percent(one.mass, two.mass)
        yield Change("link", name, "mass", one.mass, two.mass, "kg", remark, place)
    before, after = make_pose(one.origin).translation, make_pose(two.origin).translation
    if compute_distance(before, after) > tolerance:
        remark = format_motion(Pose(translation=before), Pose(translation=after))
        yield Change("link", name, "center of mass", before, after, "m", remark, place)
    if not are_close(_compute_tensor(one), _compute_tensor(two), tolerance):
        yield Change(
            "link", name, "inertia", _compute_tensor(one), _compute_tensor(two), "kg·m²", "", place
        )


def _get_mass(inertial: Inertial | None) -> float | None:
    return None if inertial is None else inertial.mass or 0.0


def _compute_tensor(inertial: Inertial) -> SymmetricTensor | None:
    """Return ``ixx, ixy, ixz, iyy, iyz, izz`` about the center of mass, in link axes [kg·m²]."""
    i = inertial.inertia
    if i is None:
        return None
    rotation = make_pose(inertial.origin).rotation
    return rotate_tensor((i.ixx, i.ixy, i.ixz, i.iyy, i.iyz, i.izz), rotation)


def _format_percent(a: float | None, b: float | None) -> str:
    return f"{100 * (b - a) / a:+.3g} %" if a and b is not None else ""


def _compare_shapes(
    kind: str,
    a: Sequence[Visual] | Sequence[Collision],
    b: Sequence[Visual] | Sequence[Collision],
    two: Link,
    tolerance: float,
    robots: tuple[Robot, Robot],
) -> Iterator[Change]:
    """Match visuals or collisions (equal, same name, same type, then by order) and compare them."""
    left: list[Shape] = list(a)
    right: list[Shape] = list(b)
    pairs: list[tuple[Shape, Shape]] = []

    def equal(x: Shape, y: Shape) -> bool:
        return next(_compare_shape(kind, "", x, y, two, tolerance, robots), None) is None

    for same in (equal, _has_same_name, _has_same_type, _is_any):
        for x in list(left):
            match = next((y for y in right if same(x, y)), None)
            if match is not None:
                left = [shape for shape in left if shape is not x]
                right = [shape for shape in right if shape is not match]
                pairs.append((x, match))
    several = len(a) > 1 or len(b) > 1
    for x, y in pairs:
        number = next(i for i, shape in enumerate(b, 1) if shape is y)
        yield from _compare_shape(
            kind, f" {number}" if several else "", x, y, two, tolerance, robots
        )
    for x in left:
        yield Change("link", two.name, f"{kind} removed", describe_shape(x.geometry), place=x.place)
    for y in right:
        yield Change(
            "link", two.name, f"{kind} added", after=describe_shape(y.geometry), place=y.place
        )


def _has_same_name(a: Shape, b: Shape) -> bool:
    return a.name is not None and a.name == b.name


def _has_same_type(a: Shape, b: Shape) -> bool:
    return type(a.geometry) is type(b.geometry)


def _is_any(a: Shape, b: Shape) -> bool:
    return True


def _compare_shape(
    kind: str,
    number: str,
    a: Shape,
    b: Shape,
    link: Link,
    tolerance: float,
    robots: tuple[Robot, Robot],
) -> Iterator[Change]:
    before, after = describe_shape(a.geometry), describe_shape(b.geometry)
    same = before.keys() == after.keys() and all(
        are_close(before[key], after[key], tolerance)
        if isinstance(before[key], tuple) and isinstance(after[key], tuple)
        else before[key] == after[key]
        for key in before
    )
    if not same:
        yield Change("link", link.name, f"{kind}{number} geometry", before, after, place=b.place)
    one, two = make_restored_pose(a.origin), make_restored_pose(b.origin)
    if not is_same_pose(one, two, tolerance):
        what = f"{kind}{number} origin"
        facts = describe_pose(one), describe_pose(two)
        yield Change("link", link.name, what, *facts, "", format_motion(one, two), b.place)
    if isinstance(a, Visual) and isinstance(b, Visual):
        old, new = _get_look(robots[0], a.material), _get_look(robots[1], b.material)
        if old != new:
            yield Change("link", link.name, f"{kind}{number} material", old, new, place=b.place)


def describe_shape(geometry: Geometry | None) -> dict[str, Any]:
    """Return geometry as data: its type, and its lengths [m] or its file."""
    if geometry is None:
        return {"shape": None}
    facts: dict[str, Any] = {"shape": get_shape_name(geometry)}
    if isinstance(geometry, Box):
        facts["size"] = geometry.size
    elif isinstance(geometry, Ellipsoid):
        facts["radii"] = geometry.radii
    elif isinstance(geometry, Plane):
        facts["size"] = geometry.size
    elif isinstance(geometry, Cylinder | Capsule | Cone):
        facts |= {"radius": (geometry.radius,), "length": (geometry.length,)}
    elif isinstance(geometry, Sphere):
        facts["radius"] = (geometry.radius,)
    elif isinstance(geometry, Mesh):
        facts |= {"filename": geometry.filename, "scale": geometry.scale}
    return facts


def describe_pose(pose: Pose) -> dict[str, Any]:
    """Return a pose as data: ``xyz`` [m] and ``rpy`` [rad]."""
    return {"xyz": pose.translation, "rpy": rpy_from_rotation(pose.rotation)}


def _get_look(robot: Robot, own: Material | None) -> dict[str, Any] | None:
    """Return color and texture of a visual, resolving a named material."""
    material = resolve_material(robot, own) or own
    if material is None:
        return None
    return {"rgba": material.color, "texture": material.texture}
