"""Visual and collision of a link that are apart, and which of the two is at the wrong place."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal, NamedTuple

from ...model.attached import attached_links
from ...model.bounds import Bounds, size_of
from ...model.elements import (
    ZERO,
    Collision,
    Geometry,
    Joint,
    Link,
    Mesh,
    Robot,
    Vector,
    Visual,
)
from ...model.pose import IDENTITY, Pose, norm, pose_of
from ...model.read import numbers
from ..mesh.outlines import Reaches, ShapeKind, reaches

_ALIKE = 0.25
"""Part by which the lengths of two shapes may differ that stand for one body."""

_SMALL = 0.05
"""Diagonal of a visual [m] that may be apart from its collision by twice as much."""

_CLEAR = 0.25
"""Part of the distance within which the third of three agrees with one of the other two."""


_PRIMITIVE = 0.2
"""Part of its diagonal by which a primitive may be off one of the same size."""


class Apart(NamedTuple):
    """A link whose visual and collision are apart.

    Attributes:
        distance: Between their middles [m].
        alike: Whether they have about the same size.
        odd: Which of them is at the wrong place; empty where nothing tells.
        why: What tells, as a clause.
        xyz: Where the origin of the odd one would be right [m]; None where that is not known.
        same: Whether both are one and the same shape, so that they have one origin.
    """

    distance: float
    alike: bool
    odd: Literal["visual", "collision", ""]
    why: str
    xyz: Vector | None = None
    same: bool = False

    @property
    def remedy(self) -> str:
        """What to write for the odd one."""
        if self.same:
            return f"give it the <origin> of the {self.other}"
        return f'write xyz="{self.xyz_text}"' if self.xyz_text else "check its <origin>"

    @property
    def xyz_text(self) -> str:
        """``xyz`` as it is written; empty where it is not known or the shapes share an origin."""
        if self.same or self.xyz is None:
            return ""
        return " ".join(f"{round(x, 6) + 0.0:g}" for x in self.xyz)

    @property
    def other(self) -> str:
        """The one of visual and collision that is right."""
        return "collision" if self.odd == "visual" else "visual"


def measured(reach: Reaches, link: Link) -> tuple[Bounds, Bounds] | tuple[None, None]:
    """Return the boxes around the visuals and around the collisions of a link.

    None where either is missing or not known, or has a shape without a size.
    """
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    for shape in shapes:
        size = size_of(shape.geometry)
        if size is not None and min(size) <= 0:
            return None, None
    seen, touches = reach.shapes(link.visuals), reach.shapes(link.collisions)
    return (None, None) if seen is None or touches is None else (seen, touches)


def compare_places(robot: Robot, link: Link, part: float) -> Apart | None:
    """Compare where a link is seen with where it collides.

    Args:
        robot: The robot.
        link: One of its links.
        part: Of the visual's diagonal, by which the middles may be apart.

    Returns:
        None where the two are together, or the collision is covered by the visual of a link that is
        attached or joined to this one.
    """
    reach = reaches(robot)
    seen, touches = measured(reach, link)
    if seen is None or touches is None:
        return None
    distance, diagonal = math.dist(seen.centre, touches.centre), norm(seen.size)
    larger = all(a > 2 * b for a, b in zip(touches.size, seen.size, strict=True))
    if _is_one_primitive(link):
        part = min(part, _PRIMITIVE)
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    if not all(_has_readable_origin(shape) for shape in shapes):
        return None
    if larger or (seen.meets(touches) and distance <= part * diagonal):
        return None
    if min(diagonal, 5 * norm(touches.size)) <= _SMALL and distance <= 2 * _SMALL:
        return None
    sizes = zip(sorted(seen.size), sorted(touches.size), strict=True)
    alike = all(abs(a - b) <= _ALIKE * max(a, b) for a, b in sizes)
    if not alike and any(_covers(box, touches) for box in _visuals_around(robot, reach, link)):
        return None
    odd, why = _odd_one(robot, link, seen.centre, touches.centre)
    xyz = None
    if alike and odd and len(link.visuals) == len(link.collisions) == 1:
        step = [b - a for a, b in zip(seen.centre, touches.centre, strict=True)]
        right, wrong = pose_of(link.visuals[0].origin), pose_of(link.collisions[0].origin)
        if odd == "visual":
            right, wrong = wrong, right
        else:
            step = [-part for part in step]
        x, y, z = (a + b for a, b in zip(wrong.translation, step, strict=True))
        xyz = right.translation if right.rotation == wrong.rotation else (x, y, z)
    same = xyz is not None and _is_same(link.visuals[0].geometry, link.collisions[0].geometry)
    return Apart(distance, alike, odd, why, xyz, same)


def _has_readable_origin(shape: Visual | Collision) -> bool:
    """Whether an origin is three numbers; one that is not stands for zero, with its own finding."""
    text = shape.origin.element.get("xyz") if shape.origin is not None else None
    return text is None or numbers(text, 3) is not None


def _is_one_primitive(link: Link) -> bool:
    """Whether a link has one visual and one collision, which are a primitive of the same size."""
    if len(link.visuals) != 1 or len(link.collisions) != 1:
        return False
    one, other = link.visuals[0].geometry, link.collisions[0].geometry
    return not isinstance(one, Mesh) and _is_same(one, other)


def _is_same(one: Geometry | None, other: Geometry | None) -> bool:
    """Whether two shapes are the same one: a mesh file at one scale, or a primitive of one size."""
    if isinstance(one, Mesh) and isinstance(other, Mesh):
        return (one.filename, one.scale) == (other.filename, other.scale)
    return size_of(one) is not None and type(one) is type(other) and size_of(one) == size_of(other)


def with_attached(
    reach: Reaches, link: Link, kind: ShapeKind, own: Bounds, other: Bounds
) -> Bounds | None:
    """Join a link's box with those of attached links that are at the same place as another box.

    Args:
        reach: The boxes of the robot.
        link: The link.
        kind: Whose boxes are joined, ``visuals`` or ``collisions``.
        own: That of the link itself.
        other: The box with which the result is to be compared.

    Returns:
        The box; None where that of an attached link is not known.
    """
    for member, at in reach.attached(link)[1:]:
        if not (member.visuals if kind == "visuals" else member.collisions):
            continue
        box = reach.body(link, kind, [(member, at)])
        if box is None:
            return None
        if _covers(other, box) or _covers(box, other):
            own = own.joined(box)
    return own


def _covers(box: Bounds | None, other: Bounds) -> bool:
    """Whether the middle of a box lies in another; taken to be so where the other is not known."""
    if box is None:
        return True
    slack = 0.1 * norm(box.size)
    return all(
        low - slack <= middle <= high + slack
        for low, middle, high in zip(box.low, other.centre, box.high, strict=True)
    )


def _visuals_around(robot: Robot, reach: Reaches, link: Link) -> Iterator[Bounds | None]:
    """The boxes around the visuals of links that are attached or joined, in the frame of a link.

    An attached link with a collision of its own needs none of another.
    """
    members = attached_links(robot, link)
    without = [member for member in members[1:] if not member[0].collisions]
    for other, at in (*without, *_joined(robot, members)):
        if other.visuals:
            yield reach.body(link, "visuals", [(other, at)])


def _joined(robot: Robot, members: list[tuple[Link, Pose]]) -> Iterator[tuple[Link, Pose]]:
    """The links that joints which move join to those of a body, all joints being at zero."""
    for member, pose in members:
        joints: list[tuple[Joint | None, str, Pose]] = [
            (joint, joint.child, pose_of(joint.origin))
            for joint in robot.tree.child_joints(member.name)
        ]
        above = robot.tree.parent_joint(member.name)
        if above is not None:
            joints.append((above, above.parent, pose_of(above.origin).inverse()))
        for joint, name, step in joints:
            if joint is not None and not joint.is_fixed and name in robot.link:
                for other, at in attached_links(robot, robot.link[name]):
                    yield other, pose @ step @ at


def _odd_one(
    robot: Robot, link: Link, seen: Vector, touches: Vector
) -> tuple[Literal["visual", "collision", ""], str]:
    """Tell which is at the wrong place: two of visual, collision and center of mass agree.

    A center of mass whose origin is not written agrees with every shape of which the same is true,
    so it does not decide. Where it does not, an origin does that repeats the one of the joint.
    """
    distance = math.dist(seen, touches)
    com = pose_of(link.inertial.origin).translation if link.inertial is not None else ZERO
    if norm(com) > 1e-9 and link.mass:
        to_seen, to_touches = math.dist(com, seen), math.dist(com, touches)
        if to_touches <= _CLEAR * distance < to_seen:
            return "visual", "the center of mass is at its collision"
        if to_seen <= _CLEAR * distance < to_touches:
            return "collision", "the center of mass is at its visual"
    visual, collision = (
        _repeated(robot, link, link.visuals),
        _repeated(robot, link, link.collisions),
    )
    if bool(visual) == bool(collision):
        return "", ""
    return "visual" if visual else "collision", visual or collision


def _repeated(robot: Robot, link: Link, shapes: list[Visual] | list[Collision]) -> str:
    """What of the origins of shapes repeats what already displaces their link, as a clause."""
    joint = robot.tree.parent_joint(link.name)
    step = pose_of(joint.origin).translation if joint is not None else IDENTITY.translation
    level = norm((*step[:2], 0.0))
    places = [shape.origin.xyz for shape in shapes if shape.origin is not None]
    slack = 1e-9 + 1e-6 * level
    same = [xyz for xyz in places if math.dist(xyz[:2], step[:2]) <= slack]
    if level <= 1e-6 or not same:
        return ""
    if any(abs(xyz[2] - step[2]) <= slack for xyz in same):
        return "its <origin> repeats that of the joint"
    return "x and y of its <origin> repeat those of the joint"
