"""What of a robot can touch what: convex pieces of its links, and who is whose neighbour."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...geometry.penetration import Convex, convex_of, overlap
from ...model.elements import Joint, Link, Mesh, Robot, Vector
from ...model.kinematics import MOVABLE, limits_of, link_poses, with_mimics
from ...model.pose import IDENTITY, Pose, pose_of
from ..mesh.outlines import outline_of, reaches

HOLLOW = 0.01
"""Overlap [m] of hulls of meshes that is let pass: what is hollow is full there. Of small parts it
is a tenth of their radius."""


class Pieces:
    """The collisions of a robot as convex pieces, where all joints rest.

    A joint rests at zero, or in the middle of its range where zero is outside. A mesh counts as its
    hull. Links that are fixed to each other are one body; bodies that a joint joins are neighbours.
    Of a robot with several roots the largest tree counts.

    Attributes:
        bodies: The pieces of each body with their links, in the frame of the root.
        unread: Meshes that could not be read.
    """

    def __init__(self, robot: Robot) -> None:
        """Place the pieces; meshes are read here."""
        self.robot = robot
        self.unread: list[str] = []
        self.rest = with_mimics(
            robot, {j.name: middle for j in robot.joints if (middle := _rest(j))}
        )
        self.poses = _of_one_tree(robot, link_poses(robot, self.rest))
        self.body_of = robot.tree.bodies
        self.bodies: dict[str, list[tuple[Link, Convex]]] = {}
        for name, pose in self.poses.items():
            link = robot.link[name]
            for piece in self._of(link):
                body = self.body_of.get(name, name)
                self.bodies.setdefault(body, []).append((link, piece.moved(pose)))
        self.spheres = {name: _sphere(found) for name, found in self.bodies.items()}
        self.neighbours = {frozenset((self._above(body), body)) for body in self.bodies}

    def _above(self, body: str) -> str:
        """The next body above that can touch anything: a frame between two keeps nothing apart."""
        joint, seen = self.robot.tree.parent_joint(body), {body}
        while joint is not None:
            body = self.body_of.get(joint.parent, joint.parent)
            if body in self.bodies or body in seen:
                return body
            seen.add(body)
            joint = self.robot.tree.parent_joint(body)
        return body

    def _of(self, link: Link) -> Iterator[Convex]:
        for collision in link.collisions:
            pose = pose_of(collision.origin)
            if not isinstance(collision.geometry, Mesh):
                piece = convex_of(collision.geometry, pose)
                if piece is not None:
                    yield piece
                continue
            use = reaches(self.robot).use_of(collision)
            if use is None or reaches(self.robot).shape(collision) is None:
                self.unread.append(collision.geometry.filename)
                continue
            found = outline_of(use)
            if found is not None:
                yield _hull(found.points, use.mesh.scale, pose)

    def deepest(
        self, one: str, other: str, moved: Pose = IDENTITY, least: float = 0.001
    ) -> tuple[Link, Link, float] | None:
        """The two links of two bodies that overlap most, the first body being moved; or None."""
        found: tuple[Link, Link, float] | None = None
        for link, piece in self.bodies.get(one, ()):
            at = moved.transform(piece.pose.translation)
            near = [
                (against, fixed)
                for against, fixed in self.bodies.get(other, ())
                if math.dist(at, fixed.pose.translation) < piece.radius + fixed.radius
            ]
            placed = piece if moved is IDENTITY or not near else piece.moved(moved)
            for against, fixed in near:
                enough = least
                if not (placed.filled and fixed.filled):
                    enough = max(least, min(HOLLOW, 0.1 * min(placed.radius, fixed.radius)))
                if found is not None:
                    enough = max(enough, found[2])
                depth = overlap(placed, fixed, enough)
                if depth > enough:
                    found = link, against, depth
        return found

    def followers(self, leader: Joint) -> set[str]:
        """The bodies that joints move which mimic one, directly or not."""
        names = {leader.name}
        found: set[str] = set()
        more = True
        while more:
            more = False
            for joint in self.robot.joints:
                if joint.mimic and joint.mimic.joint in names and joint.name not in names:
                    names.add(joint.name)
                    below = (joint.child, *self.robot.tree.descendants(joint.child))
                    found.update(self.body_of.get(name, name) for name in below)
                    more = True
        return found

    def near(self, one: str, other: str) -> bool:
        """Whether spheres around two bodies meet."""
        (a, r), (b, q) = self.spheres[one], self.spheres[other]
        return math.dist(a, b) < r + q

    def strangers(self, most: int) -> tuple[list[tuple[str, str]], bool]:
        """Pairs of bodies that no joint joins and that may meet, in the order of the tree.

        By sweeping along the axis on which they stand furthest apart, so that a thousand links are
        not half a million pairs.

        Args:
            most: How many pairs are looked for.

        Returns:
            The pairs, and whether they are all there are.
        """
        number = {name: n for n, name in enumerate(self.bodies)}
        middles = [middle for middle, _ in self.spheres.values()]
        spans = [max(column) - min(column) for column in zip(*middles, strict=True)]
        axis = spans.index(max(spans)) if spans else 0
        ends = {
            name: (middle[axis] - radius, middle[axis] + radius)
            for name, (middle, radius) in self.spheres.items()
        }
        found: list[tuple[str, str]] = []
        open_: list[str] = []
        for name in sorted(number, key=lambda name: ends[name][0]):
            start = ends[name][0]
            open_ = [other for other in open_ if ends[other][1] > start]
            for other in open_:
                if self.near(name, other) and frozenset((name, other)) not in self.neighbours:
                    found.append((name, other) if number[name] < number[other] else (other, name))
            open_.append(name)
            if len(found) > most:
                break
        found.sort(key=lambda pair: (number[pair[0]], number[pair[1]]))
        return found[:most], len(found) <= most


def _of_one_tree(robot: Robot, poses: dict[str, Pose]) -> dict[str, Pose]:
    """Keep the links of the largest tree: where another stands relative to it is not known."""
    roots = robot.tree.roots
    if len(roots) < 2:
        return poses
    trees = [{root.name, *robot.tree.descendants(root.name)} for root in roots]
    largest = max(trees, key=len)
    return {name: pose for name, pose in poses.items() if name in largest}


def _sphere(found: list[tuple[Link, Convex]]) -> tuple[Vector, float]:
    """A sphere around the pieces of a body."""
    places = [piece.pose.translation for _, piece in found]
    x, y, z = (sum(values) / len(places) for values in zip(*places, strict=True))
    middle = x, y, z
    return middle, max(math.dist(middle, p.pose.translation) + p.radius for _, p in found)


def _hull(points: list[Vector], scale: Vector, pose: Pose) -> Convex:
    """The hull of a mesh as a convex piece in the frame of its link."""
    from ...geometry.convex_points import support_function_of

    a, b, c = scale
    middle, radius, reach = support_function_of([(a * x, b * y, c * z) for x, y, z in points])
    return Convex(pose @ Pose(translation=middle), reach, radius, False)


def _rest(joint: Joint) -> float:
    """Where a joint rests [rad, m]: at zero if it can."""
    if joint.type not in MOVABLE or joint.mimic is not None:
        return 0.0
    lower, upper = limits_of(joint)
    return 0.0 if lower <= 0.0 <= upper or lower > upper else (lower + upper) / 2


def pieces(robot: Robot) -> Pieces:
    """The pieces of a robot; the same for all rules that ask."""
    return robot.memo.get("pieces", lambda: Pieces(robot))
