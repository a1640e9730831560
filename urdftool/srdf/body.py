"""Bodies: links that are fixed to each other, with their shapes in one frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..geometry.mesh import Array
from ..model.elements import Robot
from ..model.pose import IDENTITY, Pose, make_pose
from .cover import Cover, Piece, make_cover
from .shapes import LinkShape, make_collider


@dataclass(frozen=True, eq=False)
class Body:
    """Links that are fixed to each other.

    Attributes:
        top: Name of the topmost link, whose frame the body has.
        shapes: Shapes of its links.
        poses: Pose of each of these links in the frame of the body: rotation and translation [m].
    """

    top: str
    shapes: tuple[LinkShape, ...]
    poses: tuple[tuple[Array, Array], ...]

    @cached_property
    def cover(self) -> Cover:
        """Return the convex pieces of all links."""
        pieces = [
            (Piece(piece.points @ rotation.T + translation, piece.faces, piece.inflation), index)
            for index, (shape, (rotation, translation)) in enumerate(
                zip(self.shapes, self.poses, strict=True)
            )
            for piece in shape.pieces
        ]
        return make_cover(pieces)

    @cached_property
    def colliders(self) -> list[list[tuple[Any, Array, Array]]]:
        """Return for each link the geometries of FCL, with their poses in the body."""
        return [
            [
                (geometry, turn @ rotation, turn @ translation + shift)
                for geometry, rotation, translation in map(make_collider, shape.solids)
            ]
            for shape, (turn, shift) in zip(self.shapes, self.poses, strict=True)
        ]


def make_bodies(robot: Robot, shapes: Mapping[str, LinkShape]) -> list[Body]:
    """Group links with shapes into bodies, in the order of the file."""
    bodies = []
    for top, names in robot.tree.body_links.items():
        members = [name for name in names if name in shapes and not shapes[name].problem]
        if members:
            poses = [_locate(robot, top, name) for name in members]
            bodies.append(Body(top, tuple(shapes[name] for name in members), tuple(poses)))
    return bodies


def _locate(robot: Robot, top: str, name: str) -> tuple[Array, Array]:
    """Return the pose of a link in the frame of the topmost link of its body."""
    pose: Pose = IDENTITY
    while name != top:
        joint = robot.tree.get_parent_joint(name)
        assert joint is not None
        pose = make_pose(joint.origin) @ pose
        name = joint.parent
    return np.array(pose.rotation, float), np.array(pose.translation, float)


class Contacts:
    """Tests of contact between two bodies by FCL, with surfaces of meshes and solid primitives."""

    def __init__(self, a: Body, b: Body) -> None:
        """Store the bodies."""
        self.bodies = a, b

    def find_contact(self, pair: tuple[int, int], poses: Sequence[tuple[Array, Array]]) -> bool:
        """Tell whether a link of A and one of B touch.

        Args:
            pair: Index of both links.
            poses: Rotation and translation [m] of A and of B in one frame.
        """
        import fcl

        request, result = fcl.CollisionRequest(), fcl.CollisionResult()
        return any(
            fcl.collide(one, other, request, result) for one, other in self._list(pair, poses)
        )

    def measure(self, pair: tuple[int, int], poses: Sequence[tuple[Array, Array]]) -> float:
        """Return the distance of two links [m]; at most 0 if they touch."""
        import fcl

        request = fcl.DistanceRequest()
        return min(
            float(fcl.distance(one, other, request, fcl.DistanceResult()))
            for one, other in self._list(pair, poses)
        )

    def _list(
        self, pair: tuple[int, int], poses: Sequence[tuple[Array, Array]]
    ) -> list[tuple[Any, Any]]:
        import fcl

        placed = [
            [
                fcl.CollisionObject(geometry, fcl.Transform(turn @ rotation, turn @ spot + shift))
                for geometry, rotation, spot in body.colliders[index]
            ]
            for body, index, (turn, shift) in zip(self.bodies, pair, poses, strict=True)
        ]
        return [(one, other) for one in placed[0] for other in placed[1]]
