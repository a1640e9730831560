"""Find visuals and collisions of a link that are apart, and which of the two is misplaced."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal, NamedTuple

from ...model.attached import find_attached_links
from ...model.bounds import Bounds, compute_size
from ...model.elements import ZERO, Collision, Geometry, Joint, Link, Mesh, Robot, Vector, Visual
from ...model.pose import IDENTITY, Pose, compute_norm, make_pose
from ...model.read import parse_numbers
from ..mesh.link_extents import LinkExtents, ShapeKind, get_extents

_ALIKE = 0.25
"""Relative difference in length at which two shapes still count as one body. Chosen, no source."""

_SMALL = 0.05
"""Diagonal [m] up to which a visual may be twice as far from its collision."""

_CLEAR = 0.25
"""Part of the distance within which the third of three positions agrees with another one."""


_PRIMITIVE = 0.2
"""Part of its diagonal by which a primitive may be offset from one of the same size."""


class Misalignment(NamedTuple):
    """A link whose visual and collision are apart.

    Attributes:
        distance: Distance between their centers [m].
        alike: Whether they have about the same size.
        odd: The misplaced one; empty if unknown.
        why: Reason for that, as a clause.
        xyz: Correct origin of the misplaced one [m]; None if unknown.
        same: Whether both are the same shape, so that they need the same origin.
    """

    distance: float
    alike: bool
    odd: Literal["visual", "collision", ""]
    why: str
    xyz: Vector | None = None
    same: bool = False

    @property
    def remedy(self) -> str:
        """The remedy for the misplaced one."""
        if self.same:
            return f"copy the <origin> of the {self.other}"
        return f'write xyz="{self.xyz_text}"' if self.xyz_text else "check its mesh and <origin>"

    @property
    def xyz_text(self) -> str:
        """``xyz`` as text; empty if it is unknown or the shapes need the same origin."""
        if self.same or self.xyz is None:
            return ""
        return " ".join(f"{round(x, 6) + 0.0:g}" for x in self.xyz)

    @property
    def other(self) -> str:
        """The correctly placed one of visual and collision."""
        return "collision" if self.odd == "visual" else "visual"


def measure_boxes(reach: LinkExtents, link: Link) -> tuple[Bounds, Bounds] | tuple[None, None]:
    """Get the bounding boxes of the visuals and of the collisions of a link.

    Returns:
        None for both if one is missing or unknown, or has a shape without a size.
    """
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    for shape in shapes:
        size = compute_size(shape.geometry)
        if size is not None and min(size) <= 0:
            return None, None
    visual_box, collision_box = (
        reach.get_shapes_box(link.visuals),
        reach.get_shapes_box(link.collisions),
    )
    return (
        (None, None) if visual_box is None or collision_box is None else (visual_box, collision_box)
    )


def compare_places(robot: Robot, link: Link, part: float) -> Misalignment | None:
    """Compare the positions of visual and collision geometry of a link.

    Args:
        robot: The robot.
        link: One of its links.
        part: Tolerated distance of the centers, as a part of the visual's diagonal.

    Returns:
        None if the two are together, or if the visual of an attached or joined link covers the
        collision.
    """
    reach = get_extents(robot)
    visual_box, collision_box = measure_boxes(reach, link)
    if visual_box is None or collision_box is None:
        return None
    distance, diagonal = (
        math.dist(visual_box.center, collision_box.center),
        compute_norm(visual_box.size),
    )
    larger = all(a > 2 * b for a, b in zip(collision_box.size, visual_box.size, strict=True))
    if _is_one_primitive(link):
        part = min(part, _PRIMITIVE)
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    if not all(_has_readable_origin(shape) for shape in shapes):
        return None
    if larger or (visual_box.meets(collision_box) and distance <= part * diagonal):
        return None
    if min(diagonal, 5 * compute_norm(collision_box.size)) <= _SMALL and distance <= 2 * _SMALL:
        return None
    sizes = zip(sorted(visual_box.size), sorted(collision_box.size), strict=True)
    alike = all(abs(a - b) <= _ALIKE * max(a, b) for a, b in sizes)
    is_beside = not alike or _is_primitive_of_mesh(link, visual_box, collision_box)
    if is_beside and any(
        _covers(box, collision_box) for box in _get_visuals_around(robot, reach, link)
    ):
        return None
    odd, why = _find_misplaced(robot, link, visual_box.center, collision_box.center)
    xyz = None
    if alike and odd and len(link.visuals) == len(link.collisions) == 1:
        step = [b - a for a, b in zip(visual_box.center, collision_box.center, strict=True)]
        right, wrong = make_pose(link.visuals[0].origin), make_pose(link.collisions[0].origin)
        if odd == "visual":
            right, wrong = wrong, right
        else:
            step = [-part for part in step]
        x, y, z = (a + b for a, b in zip(wrong.translation, step, strict=True))
        xyz = right.translation if right.rotation == wrong.rotation else (x, y, z)
        if xyz == wrong.translation:
            xyz = None  # both have this origin: the frames of the mesh files differ
    same = xyz is not None and _is_same(link.visuals[0].geometry, link.collisions[0].geometry)
    return Misalignment(distance, alike, odd, why, xyz, same)


def _is_primitive_of_mesh(link: Link, visual_box: Bounds, collision_box: Bounds) -> bool:
    """Tell whether primitives for the meshes of a link touch these.

    Around a joint, such a shape may stand for the housings of both links.
    """
    kinds = {isinstance(shape.geometry, Mesh) for shape in link.collisions}
    return (
        kinds == {False}
        and all(isinstance(shape.geometry, Mesh) for shape in link.visuals)
        and visual_box.meets(collision_box)
    )


def _has_readable_origin(shape: Visual | Collision) -> bool:
    """Tell whether an origin has three numbers; another rule reports others."""
    xml = None if shape.origin is None else shape.origin.xml
    text = None if xml is None else xml.get("xyz")
    return text is None or parse_numbers(text, 3) is not None


def _is_one_primitive(link: Link) -> bool:
    """Tell whether a link has one visual and one collision: primitives of the same size."""
    if len(link.visuals) != 1 or len(link.collisions) != 1:
        return False
    one, other = link.visuals[0].geometry, link.collisions[0].geometry
    return not isinstance(one, Mesh) and _is_same(one, other)


def _is_same(one: Geometry | None, other: Geometry | None) -> bool:
    """Tell whether two shapes are equal: a mesh file at one scale, or a primitive of one size."""
    if isinstance(one, Mesh) and isinstance(other, Mesh):
        return (one.filename, one.scale) == (other.filename, other.scale)
    return (
        compute_size(one) is not None
        and type(one) is type(other)
        and compute_size(one) == compute_size(other)
    )


def join_attached_boxes(
    reach: LinkExtents, link: Link, kind: ShapeKind, own: Bounds, other: Bounds
) -> Bounds | None:
    """Join a link's bounding box with those of attached links in the place of another box.

    Returns:
        The box; None if that of an attached link is unknown.
    """
    for member, at in reach.get_attached(link)[1:]:
        if not (member.visuals if kind == "visuals" else member.collisions):
            continue
        box = reach.get_body_box(link, kind, [(member, at)])
        if box is None:
            return None
        if _covers(other, box) or _covers(box, other):
            own = own.join(box)
    return own


def _covers(box: Bounds | None, other: Bounds) -> bool:
    """Tell whether the center of a box is inside another; assumed if the other is unknown."""
    if box is None:
        return True
    slack = 0.1 * compute_norm(box.size)
    return all(
        low - slack <= middle <= high + slack
        for low, middle, high in zip(box.low, other.center, box.high, strict=True)
    )


def _get_visuals_around(robot: Robot, reach: LinkExtents, link: Link) -> Iterator[Bounds | None]:
    """Get the boxes of the visuals of attached and joined links, in the frame of a link.

    Attached links with collisions of their own are skipped, and so are those with a mesh in
    another unit, which is reported by itself.
    """
    members = find_attached_links(robot, link)
    without = [member for member in members[1:] if not member[0].collisions]
    for other, at in (*without, *_get_joined_links(robot, members)):
        if other.visuals:
            box = reach.get_body_box(link, "visuals", [(other, at)])
            if box is not None or not reach.is_in_another_unit(other.visuals):
                yield box


def _get_joined_links(
    robot: Robot, members: list[tuple[Link, Pose]]
) -> Iterator[tuple[Link, Pose]]:
    """Get the links on moving joints of a body, with all joints at zero."""
    for member, pose in members:
        joints: list[tuple[Joint | None, str, Pose]] = [
            (joint, joint.child, make_pose(joint.origin))
            for joint in robot.tree.get_child_joints(member.name)
        ]
        above = robot.tree.get_parent_joint(member.name)
        if above is not None:
            joints.append((above, above.parent, make_pose(above.origin).invert()))
        for joint, name, step in joints:
            if joint is not None and not joint.is_fixed and name in robot.link:
                for other, at in find_attached_links(robot, robot.link[name]):
                    yield other, pose @ step @ at


def _find_misplaced(
    robot: Robot, link: Link, visual_center: Vector, collision_center: Vector
) -> tuple[Literal["visual", "collision", ""], str]:
    """Find the misplaced one: two of visual, collision and center of mass agree.

    A center of mass without an origin does not decide, because it agrees with each shape without
    an origin. If it does not decide, a shape is misplaced if its origin repeats that of the joint.
    """
    distance = math.dist(visual_center, collision_center)
    com = make_pose(link.inertial.origin).translation if link.inertial is not None else ZERO
    if compute_norm(com) > 1e-9 and link.mass:
        to_visual, to_collision = math.dist(com, visual_center), math.dist(com, collision_center)
        if to_collision <= _CLEAR * distance < to_visual:
            return "visual", "the center of mass is at its collision"
        if to_visual <= _CLEAR * distance < to_collision:
            return "collision", "the center of mass is at its visual"
    visual, collision = (
        _describe_repetition(robot, link, link.visuals),
        _describe_repetition(robot, link, link.collisions),
    )
    if bool(visual) == bool(collision):
        return "", ""
    return "visual" if visual else "collision", visual or collision


def _describe_repetition(robot: Robot, link: Link, shapes: list[Visual] | list[Collision]) -> str:
    """Describe which part of the shapes' origins repeats the joint's origin, as a clause."""
    joint = robot.tree.get_parent_joint(link.name)
    step = make_pose(joint.origin).translation if joint is not None else IDENTITY.translation
    level = compute_norm((*step[:2], 0.0))
    places = [shape.origin.xyz for shape in shapes if shape.origin is not None]
    slack = 1e-9 + 1e-6 * level
    same = [xyz for xyz in places if math.dist(xyz[:2], step[:2]) <= slack]
    if level <= 1e-6 or not same:
        return ""
    if any(abs(xyz[2] - step[2]) <= slack for xyz in same):
        return "its <origin> repeats that of the joint"
    return "x and y of its <origin> repeat those of the joint"
