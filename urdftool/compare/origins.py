"""Origins of joints and poses of frames, relative to links that may have moved themselves."""

from __future__ import annotations

from ..mechanics.reference import Array
from ..model.elements import Joint
from .difference import Difference
from .frames import describe_motion, describe_pose, invert, measure_largest, measure_pose
from .pair import Match, Pair, locate


def find_least_offset(pair: Pair, match: Match, one: Array, two: Array) -> Array:
    """Return the offset of a frame, in the body or relative to the link that leaves the least.

    A link that moved with the frame is a difference of its own.
    """
    offsets = [invert(one) @ match.frame @ two]
    for x, y in pair.match_members(match.one, match.two):
        if x != match.one.name or y != match.two.name:
            local = match.one.members[x] @ invert(match.two.members[y])
            offsets.append(invert(one) @ local @ two)
    return min(offsets, key=measure_largest)


def get_member_poses(match: Match, x: str, y: str) -> tuple[Array, Array]:
    """Return the poses of a link of both bodies in the first, 4 × 4.

    A reader that puts link frames at joints moves that of a topmost link. Where the link is below a
    fixed joint in the other robot, the frame that the source writes is compared.
    """
    one, two = match.one.members[x], match.two.members[y]
    is_top = x == match.one.name, y == match.two.name
    if is_top == (False, True) and match.two.written is not None:
        two = match.two.written
    if is_top == (True, False) and match.one.written is not None:
        one = match.one.written
    return one, match.frame @ two


def choose_parent_frame(pair: Pair, x: Joint, y: Joint, frame: Array) -> Array:
    """Return the pose of the second parent body in the first for the origin of a joint.

    It is that of the parent links if they have the same name and the origins are closer then: a
    link that moved in its body is a difference of its own.
    """
    one = pair.a.by_name[pair.a.body_of[x.parent]]
    two = pair.b.by_name[pair.b.body_of[y.parent]]
    both_on_top = x.parent == one.name and y.parent == two.name
    if both_on_top or not has_same_parent(pair, x, y):
        return frame
    local = compute_parent_frame(pair, x, y)
    poses = pair.a.compute_joint_pose(x), pair.b.compute_joint_pose(y)
    sizes = [measure_largest(invert(poses[0]) @ f @ poses[1]) for f in (frame, local)]
    return local if sizes[1] < sizes[0] - 1e-9 else frame


def has_same_parent(pair: Pair, x: Joint, y: Joint) -> bool:
    """Tell whether the parent links of two joints have the same name."""
    return pair.links.get(x.parent, x.parent) == y.parent


def compute_parent_frame(pair: Pair, x: Joint, y: Joint) -> Array:
    """Compute the pose of the second parent body in the first if the parent links coincide."""
    one = pair.a.by_name[pair.a.body_of[x.parent]]
    two = pair.b.by_name[pair.b.body_of[y.parent]]
    pose: Array = one.members[x.parent] @ invert(two.members[y.parent])
    return pose


def describe_origin(pair: Pair, x: Joint, y: Joint, offset: Array, frame: Array) -> Difference:
    """Return the difference of the origins of a joint."""
    poses = pair.a.compute_joint_pose(x), frame @ pair.b.compute_joint_pose(y)
    distance, angle = measure_pose(offset)
    return Difference(
        "frames",
        "joint",
        (x.name, y.name),
        "origin",
        (describe_pose(poses[0]), describe_pose(poses[1])),
        "m, rad",
        max(distance, angle),
        (locate(x.origin, x), locate(y.origin, y)),
        describe_motion(offset),
    )
