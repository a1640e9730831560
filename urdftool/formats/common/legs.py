"""Legs that bend in a plane: two or three joints with parallel, level axes.

For each angle of the knee, one angle of the hip puts the foot below the hip.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...model.elements import Joint
from ...model.pose import Pose
from ...model.start import compute_allowed_range
from .base_pose import compute_level_poses
from .rigid_tree import RigidTree
from .shape_box import ShapeBoxes
from .standing import find_leg_chains

Array = npt.NDArray[np.float64]

STRETCHED = 0.9
"""Height of the hips relative to stretched legs; between the 0.8 and 0.92 at which quadrupeds of
example-robot-data stood in a trial."""

MARGIN = 0.06
"""Distance from the limits of hip and knee relative to their range; measured in the trial
above."""

PARALLEL = 0.95
"""Minimum cosine of the angle between axes of hip and knee; chosen, no source."""

LEVEL_AXIS = 0.3
"""Maximum vertical component of their unit axes; chosen, no source."""

SHIFT = 0.15
"""Maximum offset of a foot from its hip relative to its depth, to carry the center of mass; chosen,
no source."""

TURN = 2.0
"""Maximum angle of a hip [rad], which is more for a robot that lies; chosen, no source."""

_SAMPLES = 400  # angles of a knee; chosen


@dataclass(frozen=True)
class Leg:
    """A leg that bends in a plane."""

    hip: Joint
    knee: Joint
    ankle: Joint | None
    foot: str

    @property
    def joints(self) -> list[Joint]:
        """Return hip, knee and ankle."""
        return [joint for joint in (self.hip, self.knee, self.ankle) if joint is not None]


def find_legs(tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float]) -> list[Leg]:
    """Find the legs of a robot that bend in a plane, and reach the ground at joint positions."""
    poses = compute_level_poses(tree.robot, positions)
    return [
        leg
        for chain in find_leg_chains(tree, boxes, positions).values()
        if (leg := _make_leg(tree, poses, chain)) is not None
    ]


def _make_leg(tree: RigidTree, poses: Mapping[str, Pose], chain: Sequence[str]) -> Leg | None:
    """Return the leg of a chain; None if not two or three joints of it are parallel and level."""
    groups: list[tuple[Array, list[Joint]]] = []
    for body in chain:
        joint = tree.robot.tree.get_parent_joint(body)
        if joint is None or joint.type not in ("revolute", "continuous") or joint.mimic is not None:
            continue
        axis = _get_axis(joint, poses)
        if abs(axis[2]) > LEVEL_AXIS or not axis.any():
            continue
        for known, joints in groups:
            if abs(float(known @ axis)) > PARALLEL:
                joints.append(joint)
                break
        else:
            groups.append((axis, [joint]))
    best = max((joints for _, joints in groups), key=len, default=[])
    if len(best) not in (2, 3):
        return None
    return Leg(best[0], best[1], best[2] if len(best) == 3 else None, chain[-1])


def _get_axis(joint: Joint, poses: Mapping[str, Pose]) -> Array:
    """Return the unit axis of a joint in the frame of the root; zero without a direction."""
    xyz = (1.0, 0.0, 0.0) if joint.axis is None else joint.axis.xyz
    axis: Array = np.array(poses[joint.child].rotation) @ np.array(xyz)
    length = float(np.linalg.norm(axis))
    return axis / length if length else axis


@dataclass(frozen=True)
class Bends:
    """Positions of the joints of a leg with the foot below the hip, by increasing depth.

    Attributes:
        depths: Depth of the foot below the root [m].
        angles: Positions of hip, knee and ankle [rad], by joint name.
        usual: Depth of the foot with the knee bent as usual [m].
    """

    depths: Array
    angles: Mapping[str, Array]
    usual: float

    def interpolate(self, depth: float) -> dict[str, float]:
        """Return the positions at a depth [m]."""
        return {
            name: float(np.interp(depth, self.depths, values))
            for name, values in self.angles.items()
        }


def list_bends(
    tree: RigidTree,
    leg: Leg,
    poses: Mapping[str, Pose],
    positions: Mapping[str, float],
    sole: Array,
    shift: Array,
) -> Bends | None:
    """List the positions of a leg with the foot below the hip; None if there are none.

    Args:
        tree: The rigid bodies.
        leg: The leg.
        poses: Poses of the links at the positions.
        positions: Joint positions [rad, m].
        sole: Contact points of the foot [m], shape (n, 3).
        shift: Offset of the feet from the hips [m], x and y.
    """
    plane = _Plane.create(_get_axis(leg.hip, poses))
    signs = {joint.name: math.copysign(1.0, float(_get_axis(joint, poses) @ plane.axis))
             for joint in leg.joints}  # fmt: skip
    hip, knee, *ankle = (plane.project(poses[joint.child].translation) for joint in leg.joints)
    lowest = plane.project(sole.mean(axis=0))
    end = ankle[0] if ankle else lowest
    knees = np.linspace(*_get_inner_range(tree, leg.knee), _SAMPLES)
    turn = signs[leg.knee.name] * (knees - positions.get(leg.knee.name, 0.0))
    reach = knee + (end - knee) * np.exp(-1j * turn) - hip
    most = SHIFT * float(abs(reach).max())
    aside = min(max(float(shift @ plane.along[:2]), -most), most)
    level = np.sqrt(np.maximum(abs(reach) ** 2 - aside**2, 0.0))
    turned = -np.angle((aside - 1j * level) * reach.conj())
    hips = positions.get(leg.hip.name, 0.0) + signs[leg.hip.name] * turned
    angles = {leg.hip.name: (hips + math.pi) % (2 * math.pi) - math.pi, leg.knee.name: knees}
    if leg.ankle is not None:  # the foot is turned as with all joints at zero
        sums = sum(signs[name] * values for name, values in angles.items())
        angles[leg.ankle.name] = -signs[leg.ankle.name] * sums
    off = lowest.imag - float(sole[:, 2].min())  # of a plane that is not upright
    return _select_bends(tree, leg, angles, level, off - hip.imag - (lowest - end).imag)


@dataclass(frozen=True)
class _Plane:
    """A plane in which a leg moves. Its points are complex numbers, horizontal and up.

    A turn by a right-handed angle about the axis is a multiplication by exp(-i · angle).

    Attributes:
        axis: Its normal.
        along: The horizontal unit vector in it.
        up: The unit vector perpendicular to both.
    """

    axis: Array
    along: Array
    up: Array

    @classmethod
    def create(cls, axis: Array) -> _Plane:
        """Create the plane that is perpendicular to a unit vector, which is not vertical."""
        along = np.cross(axis, (0.0, 0.0, 1.0))
        along /= np.linalg.norm(along)
        return cls(axis, along, np.cross(along, axis))

    def project(self, point: Array | Sequence[float]) -> complex:
        """Return a point [m] in the plane."""
        return complex(float(self.along @ point), float(self.up @ point))


def _select_bends(
    tree: RigidTree, leg: Leg, angles: dict[str, Array], level: Array, below: float
) -> Bends | None:
    """Select the positions within the limits, on the side to which the knee bends further.

    Args:
        tree: The rigid bodies.
        leg: The leg.
        angles: Positions of its joints by the angle of the knee [rad].
        level: Height of the hip above the foot or ankle [m].
        below: What is added to it for the depth below the root [m].
    """
    turns = abs(angles[leg.hip.name])
    possible = (level > 0) & (turns < TURN)
    for joint in leg.joints:
        low, high = _get_inner_range(tree, joint)
        possible &= (low <= angles[joint.name]) & (angles[joint.name] <= high)
    straight = int(level.argmax())
    numbers = np.arange(len(level))
    sides = [np.flatnonzero(possible & side) for side in (numbers <= straight, numbers >= straight)]
    best = max(sides, key=len)
    if len(best) < 2:
        return None
    best = best[np.argsort(level[best], kind="stable")]
    depths = level[best] + below
    usual = STRETCHED * float(level[best].max()) + below
    return Bends(depths, {name: values[best] for name, values in angles.items()}, usual)


def _get_inner_range(tree: RigidTree, joint: Joint) -> tuple[float, float]:
    """Return the range of a joint [rad] without what is close to its limits."""
    low, high = compute_allowed_range(tree.robot, joint.name)
    low, high = max(low, -math.pi), min(high, math.pi)
    return low + MARGIN * (high - low), high - MARGIN * (high - low)
