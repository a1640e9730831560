"""Whether the collision of a link is where the file puts the rest of the link.

Links that a joint joins are in each other by design, often wholly: by how much tells nothing. What
tells is whether it is the link that is there. Its visual, its mass and its frame say where a link
is; a collision that is in the neighbour and away from them was misplaced.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..formats.mjcf.extent import shape_points
from ..model.elements import Robot
from ..model.pose import Pose, pose_of
from .bodies import Body
from .extent import box_of, is_beside, is_off_mass, looks_of
from .overlap import primitive_triangles
from .recording import Array
from .run import Run, body_pose

UNLIKE = 0.45
"""How much of collision and visual is in both at most, for a misplaced one, of the smaller."""

GAIN = 0.2
"""How much more of the smaller neighbour is in both by its collision than as it is seen."""

ALIKE = 0.05
"""By how much a visual may be larger or smaller than a collision that is its copy."""

OFF = 0.25
"""How far a copy may be from its visual along an axis, as a part of its size along it."""

COMPACT = 0.8
"""How large a housing may be, as a part of what is seen of its link."""

HOUSING = 0.25
"""How far from a joint a housing may be put that belongs around it, as a part of its size."""

SHARE = 0.1
"""How much of the smaller of two neighbours is in both, for one to be misplaced."""

STEPS = 13
"""Points along each edge of the box around a part, by which its volume is compared."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A convex part, as the points x with ``normals @ x <= offsets``."""

    normals: Array
    offsets: Array
    corners: Array

    def holds(self, points: Array) -> Array:
        """Which points are in it, shape (n,)."""
        inside: Array = (points @ self.normals.T <= self.offsets + 1e-9).all(axis=1)
        return inside

    def moved(self, pose: Pose) -> Solid:
        """The same in the frame in which ``pose`` is that of its present one."""
        turn, at = np.array(pose.rotation), np.array(pose.translation)
        normals = self.normals @ turn.T
        return Solid(normals, self.offsets + normals @ at, self.corners @ turn.T + at)


def strayed(robot: Robot, run: Run, frame: int, link: str, other: int) -> str | None:
    """Why the collision of a link is misplaced that is in a neighbour's; None if it is not.

    Args:
        robot: The robot, which finds its meshes.
        run: The run.
        frame: Which sample of its recording.
        link: A link.
        other: Number of the body that a joint joins to its own.
    """
    part = robot.link[link]
    box, shown_box = box_of(robot, part.collisions), box_of(robot, looks_of(part))
    if box is None:
        return None
    if shown_box is not None and (moved := _copy_moved(box, shown_box)):
        return f"the collision of '{link}' is as large as what is seen of it, and {moved:.3g} m off"
    bodies = run.bodies.bodies
    own = _body_of(run, link)
    back = (body_pose(run, own, frame) @ bodies[own].places[link]).inverse()
    there = back @ body_pose(run, other, frame)
    at = {name: there @ place for name, place in bodies[other].places.items()}
    touches = list(_touching(robot, bodies[own], link))
    theirs = [s.moved(at[n]) for n in at for s in _touching(robot, bodies[other], n)]
    smaller = min(_volume(touches), _volume(theirs))
    if not smaller or _is_housing(box, shown_box, run, link, other):
        return None
    share = _shared(touches, theirs) / smaller
    if share > SHARE and is_beside(robot, link):
        what = "what is seen of it" if shown_box is not None else "its mass"
        return f"the collision of '{link}' lies beside {what}"
    low, high = box
    if not part.visuals and not part.mass:
        away = float(np.linalg.norm(np.maximum(0.0, np.maximum(low, -high))))
        if away > float((high - low).max()):
            return f"the collision of '{link}' is {away:.3g} m away from its own frame"
        return None
    seen = list(_seen(robot, link))
    shown = [s.moved(at[n]) for n in at for s in _seen(robot, n)]
    if not seen:
        return None
    would = max(_shared(seen, theirs), _shared(seen, shown))
    gain = share - would / smaller
    if gain <= GAIN:
        return None
    if _shared(touches, seen) < UNLIKE * min(_volume(touches), _volume(seen)):
        return (
            f"the collision of '{link}' is moved from what is seen of it, and {gain:.0%} more of "
            "the two is in each other"
        )
    if is_off_mass(robot, link):
        return f"the collision of '{link}' lies beside its mass"
    return None


def _copy_moved(box: tuple[Array, Array], shown: tuple[Array, Array]) -> float:
    """How far a collision is from a visual of the same size [m]; 0 where it is not, or is near."""
    size, size_seen = box[1] - box[0], shown[1] - shown[0]
    largest = float(size_seen.max())
    if (np.abs(size - size_seen) > ALIKE * largest).any():
        return 0.0
    off = np.abs(box[0] + box[1] - shown[0] - shown[1]) / 2
    far = off > np.maximum(OFF * size_seen, OFF / 2 * largest)
    return float(np.linalg.norm(off)) if far.any() else 0.0


def _is_housing(
    box: tuple[Array, Array], shown: tuple[Array, Array] | None, run: Run, link: str, other: int
) -> bool:
    """Whether a collision is put around the joint between a link and a neighbour, as motors are.

    Args:
        box: Around the collision, in the link's frame.
        shown: Around what is seen of the link.
        run: The run.
        link: The link.
        other: Number of the neighbour's body.
    """
    bodies = run.bodies.bodies
    own = _body_of(run, link)
    place = bodies[own].places[link].inverse()
    centre, size = (box[0] + box[1]) / 2, float((box[1] - box[0]).max())
    if bodies[other].parent == own:  # the joint is the neighbour's
        joint = np.array((place @ bodies[other].origin).translation)
    elif shown is None or (box[1] - box[0]).max() < COMPACT * (shown[1] - shown[0]).max():
        joint = np.array(place.translation)
    else:  # a part as long as what is seen of it is no housing of its own joint
        return False
    return float(np.linalg.norm(centre - joint)) < HOUSING * size


def _body_of(run: Run, link: str) -> int:
    return next(number for number, body in enumerate(run.bodies.bodies) if link in body.links)


def _touching(robot: Robot, body: Body, link: str) -> Iterator[Solid]:
    """The convex pieces of a link that touch, as engines have them, in its frame."""
    shapes = [shape for shape in body.shapes if shape.link == link]
    for shape, collision in zip(shapes, robot.link[link].collisions, strict=True):
        pose = pose_of(collision.origin)
        clouds = shape.pieces or (primitive_triangles(collision).reshape(-1, 3),)
        yield from (solid.moved(pose) for solid in _hulls(clouds))


def _seen(robot: Robot, link: str) -> Iterator[Solid]:
    """The hulls of what is seen of a link, in its frame."""
    return _hulls(
        points
        for visual in looks_of(robot.link[link])
        if (points := shape_points(robot, visual)) is not None
    )


def _hulls(clouds: Iterable[Array]) -> Iterator[Solid]:
    from scipy.spatial import ConvexHull, QhullError

    for points in clouds:
        try:
            found = ConvexHull(points)
        except (QhullError, ValueError):  # flat: it has no volume
            continue
        normals, offsets = found.equations[:, :3], -found.equations[:, 3]
        yield Solid(normals, offsets, points[found.vertices])


def _points(solids: list[Solid]) -> tuple[Array, float]:
    """Points spread evenly in some solids, and the volume that each stands for [m³]."""
    corners = np.concatenate([solid.corners for solid in solids])
    low, high = corners.min(axis=0), corners.max(axis=0)
    steps = (np.arange(STEPS) + 0.5) / STEPS
    grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    points = low + grid * (high - low)
    return points[_held(points, solids)], float(np.prod((high - low) / STEPS))


def _volume(solids: list[Solid]) -> float:
    """The volume of the union of some solids [m³]."""
    points, each = _points(solids)
    return len(points) * each


def _shared(some: list[Solid], others: list[Solid]) -> float:
    """The volume that two sets of solids share [m³], by the points of the smaller one."""
    if not (some and others):
        return 0.0
    if _volume(some) > _volume(others):
        some, others = others, some
    points, each = _points(some)
    return float(_held(points, others).sum()) * each


def _held(points: Array, solids: list[Solid]) -> Array:
    inside = np.zeros(len(points), dtype=bool)
    for solid in solids:
        inside |= solid.holds(points)
    return inside
