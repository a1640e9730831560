"""Comparison of the collisions and visuals of bodies."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from ..mechanics.reference import Array, get_origin_matrix
from ..model.appearance import find_unknown_script
from ..model.drawn import list_drawn_once
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Material,
    Mesh,
    Plane,
    Robot,
    Sphere,
    UnknownShape,
    Visual,
)
from ..model.gltf_axes import is_gltf
from ..model.materials import UNCOLORED, find_gazebo_material, find_shown_material
from ..model.shapes import get_shape_name
from .bodies import Bodies, Body
from .difference import Comparison, Difference
from .frames import format_vector, invert, measure_largest
from .looks import compare_looks, is_colored_by_file, skip_file_colors
from .mesh_measure import Measure, measure_distance
from .pair import Match, Pair, add_presence, locate
from .placed import Placed, describe, describe_what, get_size, measure_corner_distance
from .settings import compare_surfaces
from .uncompared import MESHES, UNREAD, Uncompared
from .unknown_shapes import explain_unknown, has_equal_content

Rgba = tuple[float, ...]

_PLACE = 9
"""Decimals of the distance [m] of shapes at one place; chosen, above rounding errors of poses."""


_ROUNDED = 1.001
"""Factor for rounding errors of centers; chosen, far above them."""


@dataclass
class _Comparing:
    """The shapes of two bodies that have no counterpart yet; ``every`` also has repeated ones."""

    pair: Pair
    row: str
    comparison: Comparison
    one: list[Placed]
    two: list[Placed]
    every: tuple[list[Placed], list[Placed]]

    @property
    def tolerance(self) -> float:
        """Return the tolerance of the row [m]."""
        return self.comparison.tolerances.get(self.row, 0.0)


def compare_shapes(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Compare collisions and visuals of two bodies, as sets."""
    for row, kind in (("collisions", "collision"), ("visuals", "visual")):
        depending = {"visuals": ("colors", "looks", "textures"), "collisions": ("surface",)}[row]
        if comparison.tolerances.keys().isdisjoint((row, *depending)):
            continue
        one = _list_shapes(pair.a, match.one, kind, np.eye(4))
        two = _list_shapes(pair.b, match.two, kind, match.frame)
        every = (
            _list_shapes(pair.a, match.one, kind, np.eye(4), repeated=True),
            _list_shapes(pair.b, match.two, kind, match.frame, repeated=True),
        )
        state = _Comparing(pair, row, comparison, one, two, every)
        _match_equal(state)
        _match_capsules(state)
        _match_unions(state, match)
        _match_others(state, kind, match)


def _list_shapes(
    bodies: Bodies, body: Body, kind: str, frame: Array, *, repeated: bool = False
) -> list[Placed]:
    found = []
    for name, pose in body.members.items():
        link = bodies.robot.link[name]
        drawn = link.visuals if repeated else list_drawn_once(bodies.robot, link)
        shapes = link.collisions if kind == "collision" else drawn
        for shape in shapes:
            if shape.geometry is not None:
                at = frame @ pose @ get_origin_matrix(shape.origin)
                found.append(Placed(link, shape, shape.geometry, at))
    return found


def _match_equal(state: _Comparing) -> None:
    """Remove the shapes that are equal in both bodies, the nearest of equal looks first."""
    tolerance = state.tolerance
    centers = np.array([shape.pose[:3, 3] for shape in state.two]).reshape(-1, 3)
    pairs = _sort_by_looks(
        state,
        [
            (distance, i, j)
            for i, x in enumerate(state.one)
            for j in _list_near(x, centers, tolerance)
            if (distance := _measure(state, x, state.two[j])) <= tolerance
        ],
    )
    left, right = set(range(len(state.one))), set(range(len(state.two)))
    for distance, i, j in pairs:
        if i in left and j in right:
            left.remove(i)
            right.remove(j)
            _add(state, state.one[i], state.two[j], min(distance, state.tolerance), "")
            _record_unread(state, state.one[i], state.two[j])
            _compare_colors(state, state.one[i], state.two[j])
            _compare_surfaces(state, state.one[i], state.two[j])
    extra = set(left)
    for _, i, j in pairs:  # drawn twice at one place: from two files in one of the robots
        if (i in left) != (j in right) and isinstance(state.one[i].shape, Visual):
            left.discard(i)
            right.discard(j)
            _compare_colors(state, *_find_repeated(state, i, j, is_first=i in extra))
    state.one = [state.one[i] for i in sorted(left)]
    state.two = [state.two[j] for j in sorted(right)]


def _list_near(shape: Placed, centers: Array, tolerance: float) -> list[int]:
    """Return the numbers of shapes whose distance from one may be within a tolerance [m].

    Centers of solids are not farther apart than the solids; meshes have any center.

    Args:
        shape: The shape.
        centers: Origins of the others [m], n × 3.
        tolerance: The tolerance [m].
    """
    if isinstance(shape.geometry, Mesh):
        return list(range(len(centers)))
    distances = abs(centers - shape.pose[:3, 3]).max(axis=1)
    return [int(j) for j in np.flatnonzero(distances <= tolerance * _ROUNDED)]


def _find_repeated(state: _Comparing, i: int, j: int, *, is_first: bool) -> tuple[Placed, Placed]:
    """Return a visual that one robot draws more often, and the most similar one of the other."""
    pair = state.one[i], state.two[j]
    others = [
        (pair[0], other) if is_first else (other, pair[1]) for other in state.every[int(is_first)]
    ]
    equal = [two for two in others if _measure(state, *two) <= state.tolerance]
    return min((pair, *equal), key=lambda two: _count_differences(state, *two))


def _sort_by_looks(
    state: _Comparing, pairs: list[tuple[float, int, int]]
) -> list[tuple[float, int, int]]:
    """Return pairs of shapes, the nearest first, of those at one place the most similar first.

    Args:
        state: The shapes.
        pairs: Distance [m] and numbers of two shapes of each pair.
    """
    counts = Counter((side, n) for _, i, j in pairs for side, n in enumerate((i, j)))

    def rank(entry: tuple[float, int, int]) -> tuple[float, int, float, int, int]:
        distance, i, j = entry
        is_only = counts[0, i] == counts[1, j] == 1
        other = 0 if is_only else _count_differences(state, state.one[i], state.two[j])
        return round(distance, _PLACE), other, distance, i, j

    return sorted(pairs, key=rank)


def _count_differences(state: _Comparing, x: Placed, y: Placed) -> int:
    """Count the properties of two shapes of equal geometry that differ, their names last."""
    trial = replace(state, comparison=Comparison(state.comparison.rows))
    _compare_colors(trial, x, y)
    _compare_surfaces(trial, x, y)
    return 2 * len(trial.comparison.differences) + (x.shape.name != y.shape.name)


def _measure(state: _Comparing, x: Placed, y: Placed) -> float:
    """Return how far two shapes are apart [m]; infinite for different types."""
    if type(x.geometry) is not type(y.geometry):
        return np.inf
    if isinstance(x.geometry, Mesh) and isinstance(y.geometry, Mesh):
        return _measure_meshes(state, x, y)
    if not has_equal_content(state.pair, state.row, (x.geometry, y.geometry), state.tolerance):
        return np.inf
    size, size2 = (get_size(p.geometry) for p in (x, y))
    if size is None or size2 is None:
        same = get_shape_name(x.geometry) == get_shape_name(y.geometry)
        return measure_largest(invert(x.pose) @ y.pose) if same else np.inf
    distance = float(np.linalg.norm(x.pose[:3, 3] - y.pose[:3, 3]))
    if isinstance(x.geometry, Box):
        return measure_corner_distance((size, x.pose), (size2, y.pose))
    if isinstance(x.geometry, Sphere | Ellipsoid):
        turned, turned2 = (
            p.pose[:3, :3] @ np.diag(s) @ p.pose[:3, :3].T for p, s in ((x, size), (y, size2))
        )
        return max(distance, float(np.abs(turned - turned2).max()))
    axes = [x.pose[:3, 2] - y.pose[:3, 2]]
    if not isinstance(x.geometry, Cone | Plane):  # both ends are equal
        axes.append(x.pose[:3, 2] + y.pose[:3, 2])
    along = min(float(np.linalg.norm(axis)) for axis in axes) * float(max(*size, *size2))
    return max(distance, along, float(np.abs(np.array(size) - np.array(size2)).max()))


def _measure_meshes(state: _Comparing, x: Placed, y: Placed) -> float:
    one, two = _as_mesh(x), _as_mesh(y)
    meshes, robots = state.pair.meshes, (state.pair.a.robot, state.pair.b.robot)
    files = meshes.find(robots[0], one), meshes.find(robots[1], two)
    same_axes = not is_gltf(x.shape) or _get_up(robots[0]) == _get_up(robots[1])
    is_scaled = one.scale != two.scale or not same_axes
    if files[0] is not None and files[1] is not None and not is_scaled:
        if meshes.get_digest(files[0]) == meshes.get_digest(files[1]):
            distance = measure_largest(invert(x.pose) @ y.pose)
            if distance <= state.tolerance:
                return distance
    measures = _measure_union(state, [x], [y])
    if measures is None:
        same = one.filename.rpartition("/")[2] == two.filename.rpartition("/")[2]
        same = same and np.allclose(one.scale, two.scale)
        return measure_largest(invert(x.pose) @ y.pose) if same else np.inf
    return _round_off(measures, state.tolerance)


def _record_unread(state: _Comparing, x: Placed, y: Placed) -> None:
    """Record the meshes of two equal shapes that were not read, but for one that exists."""
    robots, meshes = (state.pair.a.robot, state.pair.b.robot), state.pair.meshes
    one, two = x.geometry, y.geometry
    if isinstance(one, UnknownShape) and isinstance(two, UnknownShape):
        name = f"<{one.tag}> of link '{x.link.name}'"
        if reason := explain_unknown(state.pair, (one, two)):
            state.comparison.record_uncompared(Uncompared(state.row, UNREAD, name, reason))
    if not isinstance(one, Mesh) or not isinstance(two, Mesh):
        return
    same_axes = _get_up(robots[0]) == _get_up(robots[1])
    exists = meshes.find(robots[0], one) is not None
    if exists and same_axes and meshes.is_one_file(robots, (one, two)):
        return
    for robot, mesh in zip(robots, (one, two), strict=True):
        reason = meshes.explain_unread(robot, mesh)
        if reason:
            part = Uncompared(state.row, MESHES, meshes.name_file(robot, mesh), reason)
            state.comparison.record_uncompared(part)


def _get_up(robot: Robot) -> str | None:
    """Return the axis that readers of a robot make the upward axis of glTF."""
    return None if robot.source is None else robot.source.gltf_up


def _as_mesh(placed: Placed) -> Mesh:
    assert isinstance(placed.geometry, Mesh)
    return placed.geometry


def _measure_union(
    state: _Comparing, one: list[Placed], two: list[Placed]
) -> tuple[Measure, Measure] | None:
    pair = state.pair
    found = (
        pair.meshes.measure(pair.a.robot, [(_as_mesh(p), p.pose) for p in one]),
        pair.meshes.measure(pair.b.robot, [(_as_mesh(p), p.pose) for p in two]),
    )
    return None if found[0] is None or found[1] is None else (found[0], found[1])


def _round_off(measures: tuple[Measure, Measure], tolerance: float) -> float:
    """Return the distance of two surfaces less the rounding error of 32-bit files [m]."""
    rounding = 2e-6 * max(measure.size for measure in measures)
    return max(0.0, measure_distance(*measures, tolerance + rounding) - rounding)


def _match_unions(state: _Comparing, match: Match) -> None:
    """Remove the remaining meshes of a link, or of both bodies, if their union is equal.

    Converters split a file by material, or join files.
    """
    for x, y in state.pair.match_members(match.one, match.two):
        _match_union(
            state,
            [p for p in state.one if p.link.name == x],
            [p for p in state.two if p.link.name == y],
        )
    _match_union(state, state.one, state.two)


def _match_union(state: _Comparing, one: list[Placed], two: list[Placed]) -> None:
    """Remove the meshes among some shapes if their union is equal."""
    one, two = ([p for p in side if isinstance(p.geometry, Mesh)] for side in (one, two))
    if not one or not two or len(one) == len(two) == 1:
        return
    measures = _measure_union(state, one, two)
    distance = np.inf if measures is None else _round_off(measures, state.tolerance)
    if distance > state.tolerance:
        return
    _add(state, one[0], two[0], distance, "")
    _compare_surfaces(state, one[0], two[0])
    state.one = [p for p in state.one if not _contains(one, p)]
    state.two = [p for p in state.two if not _contains(two, p)]


def _match_capsules(state: _Comparing) -> None:
    """Remove capsules that are a cylinder with two spheres in the other body, as in URDF."""
    for side, other in ((state.one, state.two), (state.two, state.one)):
        for capsule in [p for p in side if isinstance(p.geometry, Capsule)]:
            own = _get_counterpart(state, capsule, is_first=side is state.one)
            parts = _find_capsule(state, capsule, sorted(other, key=lambda p: p.link.name != own))
            if not parts:
                continue
            pair = (capsule, parts[0]) if side is state.one else (parts[0], capsule)
            _add(state, *pair, 0.0, "")
            _compare_colors(state, *pair)
            _compare_surfaces(state, *pair)
            side[:] = [p for p in side if p is not capsule]
            other[:] = [p for p in other if not _contains(parts, p)]


def _get_counterpart(state: _Comparing, placed: Placed, *, is_first: bool) -> str:
    """Return the name of the link of a shape in the other robot."""
    links, name = state.pair.links, placed.link.name
    if not is_first:
        links = {new: old for old, new in links.items()}
    return links.get(name, name)


def _find_capsule(state: _Comparing, capsule: Placed, shapes: list[Placed]) -> list[Placed]:
    """Return the cylinder and the two spheres that form a capsule; empty if one is missing."""
    whole = capsule.geometry
    assert isinstance(whole, Capsule)
    found: list[Placed] = []
    ball = Sphere(whole.provenance, whole.radius)
    pieces: list[Placed] = [
        capsule._replace(geometry=Cylinder(ball.provenance, whole.radius, whole.length))
    ]
    for end in (-whole.length / 2, whole.length / 2):
        pose = capsule.pose.copy()
        pose[:3, 3] += end * pose[:3, 2]
        pieces.append(capsule._replace(geometry=ball, pose=pose))
    for part in pieces:
        for shape in shapes:
            if not _contains(found, shape) and _measure(state, part, shape) <= state.tolerance:
                found.append(shape)
                break
    return found if len(found) == len(pieces) else []


def _match_others(state: _Comparing, kind: str, match: Match) -> None:
    """Record the remaining shapes: as changed if a link has the same number of them in both."""
    names = dict(state.pair.match_members(match.one, match.two))
    links = {p.link.name for p in state.one}
    for name in sorted(links):
        one = [p for p in state.one if p.link.name == name]
        two = [p for p in state.two if p.link.name == names.get(name)]
        if len(one) == len(two) or (len(state.one) == len(state.two) == 1):
            two = two or state.two
            for x, y in zip(one, two, strict=False):
                _add(state, x, y, _measure(state, x, y), "")
            state.one = [p for p in state.one if not _contains(one, p)]
            state.two = [p for p in state.two if not _contains(two, p)]
    tops = state.pair.a.robot.link[match.one.name], state.pair.b.robot.link[match.two.name]
    back = {new: old for old, new in names.items()}
    for side, shapes in enumerate((state.one, state.two)):
        for p in shapes:
            add_presence(
                state.comparison,
                state.row,
                "link",
                describe_what(kind, p),
                side,
                p.shape,
                p.link.name,
                describe(p),
                other=tops[1 - side],
                counterpart=(names, back)[side].get(p.link.name, ""),
            )


def _contains(shapes: list[Placed], shape: Placed) -> bool:
    return any(other is shape for other in shapes)


def _add(state: _Comparing, x: Placed, y: Placed, amount: float, note: str) -> None:
    kind = "collision" if state.row == "collisions" else "visual"
    if amount > state.tolerance and np.isfinite(amount):
        note = f"{amount * 1000:.4g} mm apart"
    difference = Difference(
        state.row,
        "link",
        (x.link.name, y.link.name),
        describe_what(kind, x),
        (describe(x, y), describe(y, x)),
        "m",
        amount,
        (locate(x.shape, x.link), locate(y.shape, y.link)),
        note,
    )
    state.comparison.add(difference)


def _compare_surfaces(state: _Comparing, x: Placed, y: Placed) -> None:
    """Compare friction and contact of two collisions."""
    if isinstance(x.shape, Collision) and isinstance(y.shape, Collision):
        surfaces = x.shape.surface, y.shape.surface
        names, parts = (x.link.name, y.link.name), (x.shape, y.shape)
        compare_surfaces(state.pair, state.comparison, names, surfaces, parts)


def _compare_colors(state: _Comparing, x: Placed, y: Placed) -> None:
    if state.row != "visuals":
        return
    has_color = _compare_color(state, x, y)
    if isinstance(x.shape, Visual) and isinstance(y.shape, Visual):
        links, shapes = (x.link, y.link), (x.shape, y.shape)
        compare_looks(state.pair, state.comparison, links, shapes, has_color=has_color)


def _compare_color(state: _Comparing, x: Placed, y: Placed) -> bool:
    """Compare the colors of two visuals; return whether both have one."""
    robots = state.pair.a.robot, state.pair.b.robot
    if "sdf" in state.pair.formats and any(_has_script(placed) for placed in (x, y)):
        return False
    if is_colored_by_file(state.pair, (x.geometry, y.geometry)):
        skip_file_colors(state.pair, state.comparison, "colors", (x.geometry, y.geometry))
        return False
    shown = [
        _find_material(state.pair, robot, placed)
        for robot, placed in zip(robots, (x, y), strict=True)
    ]
    if any(one is not None and one.texture for one in shown):
        return False
    colors = [None if one is None else one.color for one in shown]
    plain = [
        one is None or one == UNCOLORED.get(robot.format)
        for robot, one in zip(robots, colors, strict=True)
    ]
    if None in colors and all(plain):
        return False
    amount, texts = _measure_colors(*colors)
    state.comparison.add(
        Difference(
            "colors",
            "link",
            (x.link.name, y.link.name),
            f"color of {describe_what('visual', x)}",
            texts,
            "",
            amount,
            (locate(x.shape, x.link), locate(y.shape, y.link)),
        )
    )
    return True


def _measure_colors(one: Rgba | None, two: Rgba | None) -> tuple[float, tuple[str, str]]:
    """Return the largest difference of two colors, infinite if one is none, and both as text.

    An alpha above 1 is opaque.
    """
    texts = ["none" if rgba is None else format_vector(np.array(rgba)) for rgba in (one, two)]
    if one is None or two is None:
        return float("inf"), (texts[0], texts[1])
    opaque = [np.minimum(rgba, (np.inf, np.inf, np.inf, 1.0)) for rgba in (one, two)]
    return float(np.abs(opaque[0] - opaque[1]).max()), (texts[0], texts[1])


def _find_material(pair: Pair, robot: Robot, placed: Placed) -> Material | None:
    """Return the color or image of a visual: that of Gazebo first if one robot is an SDF."""
    visual = placed.shape
    if not isinstance(visual, Visual):
        return None
    found = find_gazebo_material(placed.link, visual) if "sdf" in pair.formats else None
    return found or find_shown_material(robot, placed.link, visual)


def _has_script(placed: Placed) -> bool:
    """Tell whether a script that only Gazebo Classic has says the color of a visual."""
    return isinstance(placed.shape, Visual) and bool(find_unknown_script(placed.link, placed.shape))
