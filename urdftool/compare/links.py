"""Differences of links as written: mass properties, visual geometry and collision geometry."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ..mechanics.tensor import SymmetricTensor, rotate_tensor
from ..model.elements import Collision, Inertial, Link, Material, Robot, UnknownShape, Visual
from ..model.materials import resolve_material
from ..model.pose import Pose, make_pose, make_restored_pose, rpy_from_rotation
from ..model.shapes import describe_shape
from .difference import Difference, describe_change
from .tolerance import are_close, close, compute_distance, format_motion, is_same, is_same_pose

Shape = Visual | Collision


def compare_links(
    a: Link, b: Link, tolerance: float, robots: tuple[Robot, Robot]
) -> Iterator[Difference]:
    """Yield the differences of a link."""
    yield from _compare_inertials(a, b, tolerance)
    yield from _compare_shapes("visual", a.visuals, b.visuals, b, tolerance, robots)
    yield from _compare_shapes("collision", a.collisions, b.collisions, b, tolerance, robots)


def _compare_inertials(a: Link, b: Link, tolerance: float) -> Iterator[Difference]:
    one, two = a.inertial, b.inertial
    sides = one or a, two or b

    def change(row: str, what: str, x: object, y: object, unit: str, note: str = "") -> Difference:
        return describe_change(row, "link", b.name, what, (x, y), sides, unit, note)

    if one is None or two is None:
        if one is not two:
            yield change("mass", "inertial", _get_mass(one), _get_mass(two), "kg")
        return
    if not close(one.mass, two.mass, tolerance):
        note = _format_percent(one.mass, two.mass)
        yield change("mass", "mass", one.mass, two.mass, "kg", note)
    before, after = make_pose(one.origin).translation, make_pose(two.origin).translation
    if compute_distance(before, after) > tolerance:
        note = format_motion(Pose(translation=before), Pose(translation=after))
        yield change("center of mass", "center of mass", before, after, "m", note)
    x, y = _compute_tensor(one), _compute_tensor(two)
    if not are_close(x, y, tolerance):
        yield change("inertia", "inertia", x, y, "kg·m²")


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
) -> Iterator[Difference]:
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
    row = f"{kind}s"
    for x in left:
        shape, what = describe_shape(x.geometry), f"{kind} removed"
        yield describe_change(row, "link", two.name, what, (shape, None), (x, None))
    for y in right:
        shape, what = describe_shape(y.geometry), f"{kind} added"
        yield describe_change(row, "link", two.name, what, (None, shape), (None, y))


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
) -> Iterator[Difference]:
    row, name, sides = f"{kind}s", link.name, (a, b)
    shapes = describe_shape(a.geometry), describe_shape(b.geometry)
    if not is_same(*shapes, tolerance):
        shown = _drop_equal(*shapes) if isinstance(b.geometry, UnknownShape) else shapes
        yield describe_change(row, "link", name, f"{kind}{number} geometry", shown, sides)
    one, two = make_restored_pose(a.origin), make_restored_pose(b.origin)
    if not is_same_pose(one, two, tolerance):
        poses, note = (collect_pose_values(one), collect_pose_values(two)), format_motion(one, two)
        what = f"{kind}{number} origin"
        yield describe_change(row, "link", name, what, poses, sides, note=note)
    if isinstance(a, Visual) and isinstance(b, Visual):
        looks = _get_look(robots[0], a.material), _get_look(robots[1], b.material)
        if looks[0] != looks[1]:
            yield describe_change("colors", "link", name, f"{kind}{number} material", looks, sides)


def _drop_equal(one: dict[str, Any], two: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return two shapes without the values that both have, such as the points of a polyline."""
    equal = {key for key, value in one.items() if two.get(key) == value} - {"shape"}
    before, after = ({k: v for k, v in of.items() if k not in equal} for of in (one, two))
    return before, after


def collect_pose_values(pose: Pose) -> dict[str, Any]:
    """Return a pose as data: ``xyz`` [m] and ``rpy`` [rad]."""
    return {"xyz": pose.translation, "rpy": rpy_from_rotation(pose.rotation)}


def _get_look(robot: Robot, own: Material | None) -> dict[str, Any] | None:
    """Return color and texture of a visual, resolving a named material."""
    material = resolve_material(robot, own) or own
    if material is None:
        return None
    return {"rgba": material.color, "texture": material.texture}
