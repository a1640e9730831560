"""Whether the collision of a link is where the file puts the rest of the link.

Links that a joint joins are in each other by design, often wholly: by how much tells nothing. What
tells is whether it is the link that is there. Its visual, its mass and its frame say where a link
is; a collision that is in the neighbour and away from them was misplaced.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..model.elements import Collision, Link, Mesh, Robot, Visual
from ..model.pose import Pose, pose_of
from .extent import box_of, is_beside, is_off_mass, looks_of, points_of
from .moment import Moment
from .overlap import primitive_triangles
from .recording import Array
from .remembered import mesh_points, remembered
from .shapes import Shape, is_without_extent
from .solid import Solids, hulls

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

FIT = 0.2
"""How much more of a collision is where its link is seen, if it is moved to the middle of that."""

FREE = 0.15
"""How much of a collision is where nothing is seen, of its link or the other, to be misplaced."""

ROUGH = 0.05
"""How much more of its neighbour a collision may share that is moved to where it belongs."""

SHARE = 0.1
"""How much of the smaller of two neighbours is in both, for one to be misplaced."""


def strayed(robot: Robot, moment: Moment, link: str, other: int) -> str | None:
    """Why the collision of a link is misplaced that is in a neighbour's; None if it is not.

    Args:
        robot: The robot, which finds its meshes.
        moment: Where its bodies are.
        link: A link.
        other: Number of the body that a joint joins to its own.
    """
    part = robot.link[link]
    box, shown_box = box_of(robot, part.collisions), box_of(robot, looks_of(part))
    if box is None:
        return None
    if shown_box is not None and (moved := _copy_moved(box, shown_box)):
        return f"the collision of '{link}' is as large as what is seen of it, and {moved:.3g} m off"
    bodies = moment.bodies.bodies
    own = moment.body_of(link)
    around = _is_housing(box, shown_box, moment, link, other)
    if around and bodies[other].parent == own:
        return None
    there = moment.link_pose(link).inverse() @ moment.pose(other)
    at = {name: there @ place for name, place in bodies[other].places.items()}
    touches = _touching(robot, moment, own, link)
    theirs = _union(_touching(robot, moment, other, name).moved(at[name]) for name in at)
    smaller = min(touches.volume, theirs.volume)
    if not smaller:
        return None

    def share() -> float:  # the same for both of two bodies of a link each
        key = ("share", frozenset((link, *at)))
        return moment.once(key, lambda: touches.shared(theirs)) / smaller

    seen = _seen(robot, moment, link)
    shown = _union(_seen(robot, moment, name).moved(at[name]) for name in at)
    if shown_box is not None:
        off = (shown_box[0] + shown_box[1] - box[0] - box[1]) / 2
        if _may_fit_better(touches, box, off) and share() > SHARE:
            more = _fits_better(touches, off, seen, theirs)
            if more > FIT and (
                _is_nearer_mass(part, box, off)
                or touches.shared(seen | shown) < (1 - FREE) * touches.volume
            ):
                return (
                    f"moved by {np.linalg.norm(off):.3g} m, onto the middle of what is seen of it, "
                    f"{more:.0%} more of the collision of '{link}' would be in that"
                )
    if around:
        return None
    if is_beside(robot, link) and share() > SHARE:
        what = "what is seen of it" if shown_box is not None else "its mass"
        return f"the collision of '{link}' lies beside {what}"
    low, high = box
    if not part.visuals and not part.mass:
        away = float(np.linalg.norm(np.maximum(0.0, np.maximum(low, -high))))
        if away > float((high - low).max()):
            return f"the collision of '{link}' is {away:.3g} m away from its own frame"
        return None
    if not seen:
        return None
    unlike = moment.once(("unlike", link), lambda: _are_unlike(touches, seen))
    if not (unlike or is_off_mass(robot, link)) or share() <= GAIN:
        return None
    gain = share() - seen.shared(theirs) / smaller
    if gain > GAIN:
        gain = min(gain, share() - seen.shared(shown) / smaller)
    if gain <= GAIN:
        return None
    if unlike:
        return (
            f"the collision of '{link}' is moved from what is seen of it, and {gain:.0%} more of "
            "the two is in each other"
        )
    return f"the collision of '{link}' lies beside its mass"


def _are_unlike(touches: Solids, seen: Solids) -> bool:
    """Whether less is in both than would be, if one were the other."""
    return touches.shared(seen) < UNLIKE * min(touches.volume, seen.volume)


def _copy_moved(box: tuple[Array, Array], shown: tuple[Array, Array]) -> float:
    """How far a collision is from a visual of the same size [m]; 0 where it is not, or is near."""
    size, size_seen = box[1] - box[0], shown[1] - shown[0]
    largest = float(size_seen.max())
    if (np.abs(size - size_seen) > ALIKE * largest).any():
        return 0.0
    off = np.abs(box[0] + box[1] - shown[0] - shown[1]) / 2
    far = off > np.maximum(OFF * size_seen, OFF / 2 * largest)
    return float(np.linalg.norm(off)) if far.any() else 0.0


def _may_fit_better(touches: Solids, box: tuple[Array, Array], off: Array) -> bool:
    """Whether a collision can get so much further into its visual at all, when it is moved."""
    size = box[1] - box[0]
    swept = float(np.abs(off) @ (np.prod(size) / np.maximum(size, 1e-12)))
    return swept > FIT * touches.volume


def _fits_better(touches: Solids, off: Array, seen: Solids, theirs: Solids) -> float:
    """How much more of a collision is in its visual when it is moved, as a part of it.

    Args:
        touches: The collision.
        off: How it is moved [m].
        seen: The visual.
        theirs: What touches of the neighbour, of which it may share no more when it is moved.
    """
    moved = touches.moved(Pose(translation=(float(off[0]), float(off[1]), float(off[2]))))
    more = (moved.shared(seen) - touches.shared(seen)) / touches.volume
    if more <= FIT or moved.shared(theirs) > (1 + ROUGH) * touches.shared(theirs):
        return 0.0
    return more


def _is_nearer_mass(part: Link, box: tuple[Array, Array], off: Array) -> bool:
    """Whether a collision that is moved is nearer to the centre of its link's mass."""
    if not part.mass or part.inertial is None:
        return False
    centre = np.array(part.inertial.origin.xyz if part.inertial.origin else (0.0, 0.0, 0.0))
    away = centre - (box[0] + box[1]) / 2
    return bool(np.linalg.norm(away - off) < np.linalg.norm(away))


def _is_housing(
    box: tuple[Array, Array],
    shown: tuple[Array, Array] | None,
    moment: Moment,
    link: str,
    other: int,
) -> bool:
    """Whether a collision is put around the joint between a link and a neighbour, as motors are.

    Args:
        box: Around the collision, in the link's frame.
        shown: Around what is seen of the link.
        moment: Where the bodies are.
        link: The link.
        other: Number of the neighbour's body.
    """
    bodies = moment.bodies.bodies
    own = moment.body_of(link)
    place = bodies[own].places[link].inverse()
    centre, size = (box[0] + box[1]) / 2, float((box[1] - box[0]).max())
    if bodies[other].parent == own:  # the joint is the neighbour's
        joint = np.array((place @ bodies[other].origin).translation)
    elif shown is None or (box[1] - box[0]).max() < COMPACT * (shown[1] - shown[0]).max():
        joint = np.array(place.translation)
    else:  # a part as long as what is seen of it is no housing of its own joint
        return False
    return float(np.linalg.norm(centre - joint)) < HOUSING * size


def _union(some: Iterable[Solids]) -> Solids:
    found = [solids for solids in some if solids]
    if len(found) == 1:
        return found[0]
    return Solids(part for solids in found for part in solids.parts)


def _touching(robot: Robot, moment: Moment, body: int, link: str) -> Solids:
    """The convex pieces of a link that touch, as engines have them, in its frame."""

    def make() -> Solids:
        shapes = [shape for shape in moment.bodies.bodies[body].shapes if shape.link == link]
        collisions = [c for c in robot.link[link].collisions if not is_without_extent(c)]
        return _union(
            _solids(robot, shape, collision).moved(pose_of(collision.origin))
            for shape, collision in zip(shapes, collisions, strict=True)
        )

    return moment.once(("touching", link), make)


def _solids(robot: Robot, shape: Shape, collision: Collision) -> Solids:
    """The convex pieces of a collision in its own frame."""
    geometry = collision.geometry
    if isinstance(geometry, Mesh):
        counts = tuple(map(len, shape.pieces))  # what is tried on bodies may have other pieces
        key = ("solids", geometry.filename, geometry.scale, counts)
        return remembered(robot, key, lambda: hulls(shape.pieces))
    return hulls([primitive_triangles(collision).reshape(-1, 3)])


def _seen(robot: Robot, moment: Moment, link: str) -> Solids:
    """The hulls of what is seen of a link, in its frame."""
    return moment.once(
        ("seen", link), lambda: _union(_look(robot, look) for look in looks_of(robot.link[link]))
    )


def _look(robot: Robot, look: Visual) -> Solids:
    geometry, pose = look.geometry, pose_of(look.origin)
    if isinstance(geometry, Mesh):
        points = mesh_points(robot, geometry)
        if points is None:
            return Solids([])
        key = ("look", geometry.filename, geometry.scale)
        return remembered(robot, key, lambda: hulls([points])).moved(pose)
    corners = points_of(robot, look)
    return Solids([]) if corners is None else hulls([corners])
