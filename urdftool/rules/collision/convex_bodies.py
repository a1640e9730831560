"""Represent the links of a robot as convex pieces, with the pairs of bodies that may touch."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from ...geometry.penetration import CORNER_DIRECTIONS, Convex, compute_overlap, make_convex
from ...model.elements import Joint, Link, Mesh, Robot, Vector
from ...model.kinematics import MOVABLE, add_mimic_positions, get_limits, link_poses
from ...model.pose import IDENTITY, Pose, make_pose, rotate, transpose
from ..mesh.link_extents import get_convex_points, get_extents

HOLLOW = 0.01
"""Tolerated overlap of convex hulls of meshes [m], because hulls fill hollow parts; for small
parts it is a tenth of their radius."""


class ConvexBodies:
    """The collisions of a robot as convex pieces, with all joints at rest.

    A joint rests at zero, or in the middle of its range if zero is outside, as in MoveIt; with
    ``at_zero`` it is at zero, as simulators start it. A mesh counts as its convex hull. Links that
    are fixed to each other are one body; bodies that share a joint are neighbors. For a robot with
    several roots the largest tree counts.

    Attributes:
        bodies: The pieces of each body with their links, in the root frame.
        unread: Meshes that could not be read.
        centered: Positions of joints that rest in the middle of their range [rad or m].
    """

    def __init__(self, robot: Robot, at_zero: bool = False) -> None:
        """Place the pieces; this reads the meshes."""
        self.robot = robot
        self.unread: list[str] = []
        joints = () if at_zero else robot.joints
        self.centered = {j.name: middle for j in joints if (middle := _compute_rest_position(j))}
        self.rest = {} if at_zero else add_mimic_positions(robot, self.centered)
        self.poses = _select_largest_tree(robot, link_poses(robot, self.rest))
        self.body_of = robot.tree.bodies
        self.bodies: dict[str, list[tuple[Link, Convex]]] = {}
        for name, pose in self.poses.items():
            link = robot.link[name]
            for piece in self._get_pieces(link):
                body = self.body_of.get(name, name)
                self.bodies.setdefault(body, []).append((link, piece.transform(pose)))
        self.spheres = {name: _compute_sphere(found) for name, found in self.bodies.items()}
        self.neighbors = {frozenset((self._find_body_above(body), body)) for body in self.bodies}

    def _find_body_above(self, body: str) -> str:
        """Find the next body above that has collision geometry."""
        joint, seen = self.robot.tree.get_parent_joint(body), {body}
        while joint is not None:
            body = self.body_of.get(joint.parent, joint.parent)
            if body in self.bodies or body in seen:
                return body
            seen.add(body)
            joint = self.robot.tree.get_parent_joint(body)
        return body

    def _get_pieces(self, link: Link) -> Iterator[Convex]:
        for collision in link.collisions:
            pose = make_pose(collision.origin)
            if not isinstance(collision.geometry, Mesh):
                piece = make_convex(collision.geometry, pose)
                if piece is not None:
                    yield piece
                continue
            use = get_extents(self.robot).get_use(collision)
            if use is None or get_extents(self.robot).get_shape_box(collision) is None:
                self.unread.append(collision.geometry.filename)
                continue
            found = get_convex_points(use)
            if found is not None:
                yield _compute_hull(found.points, use.mesh.scale, pose)

    def get_pieces_of(self, link: Link) -> list[Convex]:
        """Get the pieces of a link, in the root frame."""
        body = self.bodies.get(self.body_of.get(link.name, link.name), ())
        return [piece for owner, piece in body if owner is link]

    def find_deepest_overlap(
        self,
        one: str,
        other: str,
        moved: Pose = IDENTITY,
        least: float = 0.001,
        counts: Callable[[Link, Link], bool] | None = None,
    ) -> tuple[Link, Link, float] | None:
        """Find the links of two bodies that overlap most, with the first body moved; or None.

        Args:
            one: A body.
            other: Another body.
            moved: Displacement of the first body.
            least: Overlap that is tolerated [m].
            counts: Whether an overlap of the convex pieces of two links counts; not asked for
                primitives.
        """
        found: tuple[Link, Link, float] | None = None
        for link, piece in self.bodies.get(one, ()):
            at = moved.transform(piece.pose.translation)
            near = [
                (against, fixed)
                for against, fixed in self.bodies.get(other, ())
                if math.dist(at, fixed.pose.translation) < piece.radius + fixed.radius
            ]
            placed = piece if moved is IDENTITY or not near else piece.transform(moved)
            for against, fixed in near:
                enough = least
                if not (placed.filled and fixed.filled):
                    enough = max(least, min(HOLLOW, 0.1 * min(placed.radius, fixed.radius)))
                if found is not None:
                    enough = max(enough, found[2])
                depth = compute_overlap(placed, fixed, enough)
                if depth > enough and (
                    counts is None or (placed.filled and fixed.filled) or counts(link, against)
                ):
                    found = link, against, depth
        return found

    def find_followers(self, leader: Joint) -> set[str]:
        """Find the bodies on joints that mimic a joint, directly or indirectly."""
        names = {leader.name}
        found: set[str] = set()
        more = True
        while more:
            more = False
            for joint in self.robot.joints:
                if joint.mimic and joint.mimic.joint in names and joint.name not in names:
                    names.add(joint.name)
                    below = (joint.child, *self.robot.tree.list_descendants(joint.child))
                    found.update(self.body_of.get(name, name) for name in below)
                    more = True
        return found

    def is_near(self, one: str, other: str) -> bool:
        """Tell whether the bounding spheres of two bodies overlap."""
        (a, r), (b, q) = self.spheres[one], self.spheres[other]
        return math.dist(a, b) < r + q

    def find_candidate_pairs(self, most: int) -> tuple[list[tuple[str, str]], bool]:
        """List pairs of bodies without a common joint that may touch, in the order of the tree.

        It sweeps along the axis with the largest distances, so that a thousand links do not give
        half a million pairs.

        Args:
            most: Largest number of pairs.

        Returns:
            The pairs, and whether the list is complete.
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
                if self.is_near(name, other) and frozenset((name, other)) not in self.neighbors:
                    found.append((name, other) if number[name] < number[other] else (other, name))
            open_.append(name)
            if len(found) > most:
                break
        found.sort(key=lambda pair: (number[pair[0]], number[pair[1]]))
        return found[:most], len(found) <= most


def _select_largest_tree(robot: Robot, poses: dict[str, Pose]) -> dict[str, Pose]:
    """Keep the links of the largest tree; the relative poses of trees are unknown."""
    roots = robot.tree.roots
    if len(roots) < 2:
        return poses
    trees = [{root.name, *robot.tree.list_descendants(root.name)} for root in roots]
    largest = max(trees, key=len)
    return {name: pose for name, pose in poses.items() if name in largest}


def _compute_sphere(found: list[tuple[Link, Convex]]) -> tuple[Vector, float]:
    """Compute a sphere around the pieces of a body."""
    places = [piece.pose.translation for _, piece in found]
    x, y, z = (sum(values) / len(places) for values in zip(*places, strict=True))
    middle = x, y, z
    return middle, max(math.dist(middle, p.pose.translation) + p.radius for _, p in found)


def _compute_hull(points: list[Vector], scale: Vector, pose: Pose) -> Convex:
    """Compute the convex hull of a mesh as a convex piece in the frame of its link."""
    from ...geometry.convex_points import support_function_of

    a, b, c = scale
    middle, radius, reach = support_function_of([(a * x, b * y, c * z) for x, y, z in points])
    return Convex(pose @ Pose(translation=middle), reach, radius, False)


def _compute_rest_position(joint: Joint) -> float:
    """Compute the rest position of a joint [rad, m]: zero if its limits allow it."""
    if joint.type not in MOVABLE or joint.mimic is not None:
        return 0.0
    lower, upper = get_limits(joint)
    return 0.0 if lower <= 0.0 <= upper or lower > upper else (lower + upper) / 2


def get_convex_bodies(robot: Robot) -> ConvexBodies:
    """Get the pieces of a robot, shared by all rules."""
    return robot.memo.get("pieces", lambda: ConvexBodies(robot))


def get_bodies_at_zero(robot: Robot) -> ConvexBodies:
    """Get the pieces of a robot with all joints at zero, also where that is outside a range."""
    if not get_convex_bodies(robot).centered:
        return get_convex_bodies(robot)
    return robot.memo.get("pieces at zero", lambda: ConvexBodies(robot, at_zero=True))


def compute_depth(around: Convex, at: tuple[float, float, float]) -> float:
    """Compute the depth of a point in a shape: 1 at the center, 0 on the surface, negative outside.

    It is in half widths of the shape.
    """
    x, y, z = (a - b for a, b in zip(at, around.pose.translation, strict=True))
    local = rotate(transpose(around.pose.rotation), (x, y, z))
    least = 1.0
    for a, b, c in CORNER_DIRECTIONS:
        ahead = around.reach(a, b, c)
        half = (ahead + around.reach(-a, -b, -c)) / 2
        if half > 0:
            least = min(least, (ahead - a * local[0] - b * local[1] - c * local[2]) / half)
        if least < 0:
            break
    return least
