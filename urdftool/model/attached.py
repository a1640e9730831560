"""Links that fixed joints connect to one rigid body, with their relative poses.

A rigid body may be written as one link or as several: a hub with its tire, a housing whose mass is
in a separate link. A rule that compares two properties of a body therefore needs all links that are
rigidly attached, ancestors and descendants.
"""

from __future__ import annotations

from collections.abc import Iterator

from ..errors import ModelError
from .elements import Link, Robot
from .pose import IDENTITY, Pose, make_pose
from .world import WORLD

MAX_PAIRS = 250_000
"""Number of pairs of links with a relative pose in one robot: bodies of 500 links. Chosen."""


class TooManyAttached(ModelError):  # noqa: N818 -- reads as what happened
    """Error for rigid bodies of so many links that not all relative poses are computed."""


Attached = list[tuple[Link, Pose]]
"""Links with the pose of each in the frame of the first [m]."""


def find_attached_links(robot: Robot, link: Link) -> Attached:
    """Return the links of a rigid body, starting with one of them; computed once for each link.

    Fixed joints are followed to parents and children. The link ``world`` is not part of a body;
    bodies fixed to it are not parts of each other.

    Returns:
        The link itself with the identity, then each rigidly attached link with its pose in the
        frame of ``link``.

    Raises:
        TooManyAttached: More than :data:`MAX_PAIRS` would be returned for the links of the robot.
    """
    return robot.memo.get(_Known, _Known).get(robot, link)


class _Known:
    """Attached links of the links of a robot."""

    def __init__(self) -> None:
        self._found: dict[int, Attached] = {}
        self._pairs = 0

    def get(self, robot: Robot, link: Link) -> Attached:
        if id(link) not in self._found:
            found: Attached = []
            for one in _walk_attached(robot, link):
                self._pairs += 1
                if self._pairs > MAX_PAIRS:
                    raise TooManyAttached(
                        f"the rigid body of link '{link.name}' has too many links: fixed joints "
                        f"connect more than {MAX_PAIRS} pairs of links; merge links"
                    )
                found.append(one)
            self._found[id(link)] = found
        return self._found[id(link)]


def _walk_attached(robot: Robot, link: Link) -> Iterator[tuple[Link, Pose]]:
    found: Attached = [(link, IDENTITY)]
    tree, seen = robot.tree, {link.name}
    for member, pose in found:  # the loop appends to this list
        yield member, pose
        if link.name == WORLD:
            return
        above = tree.get_parent_joint(member.name)
        joints = [(joint, joint.child) for joint in tree.get_child_joints(member.name)]
        joints += [(above, above.parent)] if above is not None else []
        for joint, name in joints:
            if joint.is_fixed and name in robot.link and name not in seen and name != WORLD:
                seen.add(name)
                at = make_pose(joint.origin)
                found.append((robot.link[name], pose @ (at.invert() if joint is above else at)))


def is_fixed_to_world(robot: Robot, link: Link) -> bool:
    """Tell whether fixed joints connect a link to the link ``world``."""
    known: dict[str, bool] = robot.memo.get(is_fixed_to_world, lambda: {WORLD: True})
    name, path = link.name, {link.name}
    while name not in known:
        joint = robot.tree.get_parent_joint(name)
        if joint is None or not joint.is_fixed or joint.parent in path:
            known[name] = False
        else:
            name = joint.parent
            path.add(name)
    known.update(dict.fromkeys(path, known[name]))
    return known[name]
