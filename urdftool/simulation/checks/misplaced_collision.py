"""Find collision geometry that is not where the file puts the rest of its link.

Links that share a joint overlap by design, often completely, so the depth is no criterion. Visual,
center of mass and frame of a link show where the link is; collision geometry that overlaps the
neighbor and is away from them is misplaced.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...model.elements import Collision, Link, Mesh, Robot, Visual
from ...model.pose import Pose, make_pose
from ..extent import compute_bounding_box, get_shape_corners
from ..mesh_cache import compute_once, get_outermost_points
from ..overlap import tessellate_primitive_triangles
from ..recording import Array
from ..shapes import Shape, is_without_extent
from ..solids import Solids, compute_hulls, find_outermost
from ..state import StateSnapshot
from .thresholds import Thresholds


def explain_misplaced_collision(
    robot: Robot, snapshot: StateSnapshot, link: str, other: int
) -> str | None:
    """Explain why collision geometry that overlaps a neighbor's is misplaced; None if it is not."""
    part, bounds = robot.link[link], snapshot.thresholds
    box, shown_box = (
        compute_bounding_box(robot, part.collisions),
        compute_bounding_box(robot, list_visuals_with_known_pose(part)),
    )
    if box is None:
        return None
    if shown_box is not None and (moved := _copy_moved(box, shown_box, bounds)):
        return f"collision of '{link}' has the size of its visual but is offset by {moved:.3g} m"
    bodies = snapshot.bodies.bodies
    own = snapshot.get_body(link)
    around = _is_housing(box, shown_box, snapshot, link, other)
    if around and bodies[other].parent == own:
        return None
    there = snapshot.link_pose(link).invert() @ snapshot.get_pose(other)
    at = {name: there @ place for name, place in bodies[other].places.items()}
    touches = _build_collision_solids(robot, snapshot, own, link)
    theirs = _make_union(
        _build_collision_solids(robot, snapshot, other, name).transform(at[name]) for name in at
    )
    smaller = min(touches.volume, theirs.volume)
    if not smaller:
        return None

    def share() -> float:  # symmetric, if both bodies have one link
        key = ("share", frozenset((link, *at)))
        return snapshot.get_or_compute(key, lambda: touches.compute_shared_volume(theirs)) / smaller

    seen = _build_visual_solids(robot, snapshot, link)
    shown = _make_union(
        _build_visual_solids(robot, snapshot, name).transform(at[name]) for name in at
    )
    if shown_box is not None:
        off = (shown_box[0] + shown_box[1] - box[0] - box[1]) / 2
        if _may_fit_better(touches, box, off, bounds) and share() > bounds.neighbor_overlap:
            more = _measure_better_fit(touches, off, seen, theirs, bounds)
            if more > bounds.better_fit and (
                _is_nearer_mass(part, box, off)
                or touches.compute_shared_volume(seen | shown)
                < (1 - bounds.outside_visuals) * touches.volume
            ):
                return (
                    f"collision of '{link}' is offset from its visual by about "
                    f"{np.linalg.norm(off):.3g} m (centering it would increase the overlap by "
                    f"{more:.0%})"
                )
    if around:
        return None
    if is_offset_from_visual(robot, link, bounds.box_overlap) and share() > bounds.neighbor_overlap:
        if shown_box is not None:
            return f"collision of '{link}' does not overlap its visual"
        return f"collision of '{link}' does not contain its center of mass"
    low, high = box
    if not part.visuals and not part.mass:
        away = float(np.linalg.norm(np.maximum(0.0, np.maximum(low, -high))))
        if away > float((high - low).max()):
            return f"collision of '{link}' is {away:.3g} m away from the frame of the link"
        return None
    if not seen:
        return None
    unlike = snapshot.get_or_compute(("unlike", link), lambda: _are_unlike(touches, seen, bounds))
    if not (unlike or is_offset_from_com(robot, link)) or share() <= bounds.neighbor_gain:
        return None
    gain = share() - seen.compute_shared_volume(theirs) / smaller
    if gain > bounds.neighbor_gain:
        gain = min(gain, share() - seen.compute_shared_volume(shown) / smaller)
    if gain <= bounds.neighbor_gain:
        return None
    if unlike:
        return (
            f"collision of '{link}' is offset from its visual, which increases its overlap with "
            f"the neighboring link by {gain:.0%}"
        )
    return f"collision of '{link}' does not contain its center of mass"


def _are_unlike(touches: Solids, seen: Solids, bounds: Thresholds) -> bool:
    """Tell whether collision and visual overlap less than a correctly placed pair does."""
    return touches.compute_shared_volume(seen) < bounds.unlike_overlap * min(
        touches.volume, seen.volume
    )


def _copy_moved(box: tuple[Array, Array], shown: tuple[Array, Array], bounds: Thresholds) -> float:
    """Measure the offset of a collision from a visual of equal size [m]; 0 if near, or unequal."""
    size, size_seen = box[1] - box[0], shown[1] - shown[0]
    largest = float(size_seen.max())
    if (np.abs(size - size_seen) > bounds.copy_size * largest).any():
        return 0.0
    off = np.abs(box[0] + box[1] - shown[0] - shown[1]) / 2
    far = off > bounds.copy_offset * np.maximum(size_seen, largest / 2)
    return float(np.linalg.norm(off)) if far.any() else 0.0


def _may_fit_better(
    touches: Solids, box: tuple[Array, Array], off: Array, bounds: Thresholds
) -> bool:
    """Return whether, by bounding boxes, centering a collision can increase the overlap enough."""
    size = box[1] - box[0]
    swept = float(np.abs(off) @ (np.prod(size) / np.maximum(size, 1e-12)))
    return swept > bounds.better_fit * touches.volume


def _measure_better_fit(
    touches: Solids, off: Array, seen: Solids, theirs: Solids, bounds: Thresholds
) -> float:
    """Measure by which part of its volume the overlap of a collision and its visual grows if moved.

    It is 0 if the overlap with the neighbor grows.
    """
    moved = touches.transform(Pose(translation=(float(off[0]), float(off[1]), float(off[2]))))
    more = (
        moved.compute_shared_volume(seen) - touches.compute_shared_volume(seen)
    ) / touches.volume
    grown = (1 + bounds.neighbor_growth) * touches.compute_shared_volume(theirs)
    if more <= bounds.better_fit or moved.compute_shared_volume(theirs) > grown:
        return 0.0
    return more


def _is_nearer_mass(part: Link, box: tuple[Array, Array], off: Array) -> bool:
    """Tell whether a moved collision is nearer to the center of mass of its link."""
    if not part.mass or part.inertial is None:
        return False
    center = np.array(part.inertial.origin.xyz if part.inertial.origin else (0.0, 0.0, 0.0))
    away = center - (box[0] + box[1]) / 2
    return bool(np.linalg.norm(away - off) < np.linalg.norm(away))


def _is_housing(
    box: tuple[Array, Array],
    shown: tuple[Array, Array] | None,
    snapshot: StateSnapshot,
    link: str,
    other: int,
) -> bool:
    """Tell whether a collision surrounds the joint of a link and a neighbor: a motor housing."""
    bodies = snapshot.bodies.bodies
    own = snapshot.get_body(link)
    place = bodies[own].places[link].invert()
    center, size = (box[0] + box[1]) / 2, float((box[1] - box[0]).max())
    if bodies[other].parent == own:  # the joint of the neighbor
        joint = np.array((place @ bodies[other].origin).translation)
    elif (
        shown is None
        or (box[1] - box[0]).max() < snapshot.thresholds.housing_size * (shown[1] - shown[0]).max()
    ):
        joint = np.array(place.translation)
    else:  # collision as long as the visual is not a housing of the link's own joint
        return False
    return float(np.linalg.norm(center - joint)) < snapshot.thresholds.housing_offset * size


def _make_union(some: Iterable[Solids]) -> Solids:
    found = [solids for solids in some if solids]
    if len(found) == 1:
        return found[0]
    return Solids(part for solids in found for part in solids.parts)


def _build_collision_solids(robot: Robot, snapshot: StateSnapshot, body: int, link: str) -> Solids:
    """Build the convex pieces of a link's collision geometry in its frame, as engines have them."""

    def make() -> Solids:
        shapes = [shape for shape in snapshot.bodies.bodies[body].shapes if shape.link == link]
        collisions = [c for c in robot.link[link].collisions if not is_without_extent(c)]
        return _make_union(
            _build_collision_solid(robot, shape, collision).transform(make_pose(collision.origin))
            for shape, collision in zip(shapes, collisions, strict=True)
        )

    return snapshot.get_or_compute(("touching", link), make)


def _build_collision_solid(robot: Robot, shape: Shape, collision: Collision) -> Solids:
    """Build the convex pieces of a collision in its own frame."""
    geometry = collision.geometry
    if isinstance(geometry, Mesh):
        counts = tuple(map(len, shape.pieces))  # a candidate may have other pieces
        key = ("solids", geometry.filename, geometry.scale, counts)
        return compute_hulls(compute_once(robot, key, lambda: find_outermost(shape.pieces)))
    return compute_hulls([tessellate_primitive_triangles(collision).reshape(-1, 3)])


def _build_visual_solids(robot: Robot, snapshot: StateSnapshot, link: str) -> Solids:
    """Build the hulls of a link's visuals in its frame."""
    return snapshot.get_or_compute(
        ("seen", link),
        lambda: _make_union(
            _make_visual_solid(robot, look)
            for look in list_visuals_with_known_pose(robot.link[link])
        ),
    )


def _make_visual_solid(robot: Robot, look: Visual) -> Solids:
    geometry, pose = look.geometry, make_pose(look.origin)
    if isinstance(geometry, Mesh):
        points = get_outermost_points(robot, geometry)
        if points is None:
            return Solids([])
        key = ("look", geometry.filename, geometry.scale)
        outermost = compute_once(robot, key, lambda: find_outermost([points]))
        return compute_hulls(outermost).transform(pose)
    corners = get_shape_corners(robot, look)
    return Solids([]) if corners is None else compute_hulls([corners])


def is_offset_from_visual(robot: Robot, name: str, overlap: float) -> bool:
    """Tell whether the collision geometry of a link is offset from its visuals, or else its mass.

    Args:
        robot: The robot.
        name: Name of the link.
        overlap: Least part of the smaller bounding box that is in the other, along each axis.
    """
    link = robot.link[name]
    touches, seen = (
        compute_bounding_box(robot, group)
        for group in (link.collisions, list_visuals_with_known_pose(link))
    )
    if touches is None:
        return False
    if seen is None:
        return is_offset_from_com(robot, name)
    shared = np.minimum(touches[1], seen[1]) - np.maximum(touches[0], seen[0])
    smaller = np.minimum(touches[1] - touches[0], seen[1] - seen[0])
    return bool((shared < overlap * smaller - 1e-6).any())


def list_visuals_with_known_pose(link: Link) -> list[Visual]:
    """List the visuals of a link without glTF, for which readers use different up axes."""
    return [
        visual
        for visual in link.visuals
        if not (
            isinstance(visual.geometry, Mesh)
            and visual.geometry.filename.lower().endswith((".glb", ".gltf"))
        )
    ]


def is_offset_from_com(robot: Robot, name: str) -> bool:
    """Tell whether the center of mass is over half a box outside the collision's bounding box."""
    link = robot.link[name]
    touches = compute_bounding_box(robot, link.collisions)
    if touches is None or not link.mass or link.inertial is None:
        return False
    center = np.array(link.inertial.origin.xyz if link.inertial.origin else (0.0, 0.0, 0.0))
    slack = (touches[1] - touches[0]) / 2
    return bool((center < touches[0] - slack).any() or (center > touches[1] + slack).any())
