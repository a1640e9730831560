"""A pose in which a robot stands on its legs: each foot below its hip.

The knees are bent so that all feet have the same height.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ...diagnostic import Severity
from ...errors import ModelError
from ...listing import list_first
from ...model.pose import Pose
from ...model.start import start_positions
from ..written import Written
from .base_pose import compute_level_poses
from .home_positions import STAND, HomePositions
from .legs import Bends, Leg, find_legs, list_bends
from .rigid_tree import RigidTree
from .shape_box import ShapeBoxes
from .standing import CLEARANCE, LEVEL, Ground, find_leg_chains, measure_ground
from .support import (
    CONTACT,
    compute_center,
    compute_margin,
    list_contact_points,
    list_support_points,
)

Array = npt.NDArray[np.float64]

FLAT = 1e-4
"""Difference of the heights of feet [m] at which the search ends; chosen, no source."""

MARGIN = 0.005
"""Least distance of the center of mass from the edge of the support polygon [m]; chosen, no
source."""

NARROW = 2.0
"""Tilt that tips a robot over [°], below which it is reported; chosen, no source: of 60 robots, the
next ones are at 2.8° and stand."""

_CENTERED, _ROUNDS = 1e-3, 12
"""Distance [m] that ends the search, and its largest number of steps. Chosen, no source."""


def compute_standing_positions(
    tree: RigidTree, boxes: ShapeBoxes, legs: Sequence[Leg], positions: Mapping[str, float]
) -> dict[str, float] | None:
    """Compute joint positions at which each foot is below its hip, all at the same height.

    Other joints keep their positions.

    Returns:
        All positions [rad, m]; None if the limits do not allow it, or the feet do not become level.
    """
    bent = {joint.name for leg in legs for joint in leg.joints}
    others = {name: value for name, value in positions.items() if name not in bent}
    found, shift = dict(positions), np.zeros(2)
    for number in range(_ROUNDS):
        poses = compute_level_poses(tree.robot, found)
        feet = [list_contact_points(tree, boxes, leg.foot, poses) for leg in legs]
        if not all(map(len, feet)):
            return None
        step = _compute_offset(tree, poses, feet) if number else np.zeros(2)
        lows = [float(points[:, 2].min()) for points in feet]
        if number and max(lows) - min(lows) < FLAT and np.hypot(*step) < _CENTERED:
            return found
        shift = shift + step
        bends = [
            list_bends(tree, leg, poses, found, points, shift)
            for leg, points in zip(legs, feet, strict=True)
        ]
        known = [one for one in bends if one is not None]
        depth = _choose_depth(known) if len(known) == len(legs) else None
        if depth is None:
            return None
        angles = {name: value for one in known for name, value in one.interpolate(depth).items()}
        found = start_positions(tree.robot, others | angles)[0]
    return found if max(lows) - min(lows) < FLAT else None


def _compute_offset(tree: RigidTree, poses: Mapping[str, Pose], feet: Sequence[Array]) -> Array:
    """Return the offset of the center of mass from the middle of the feet [m], x and y."""
    center = compute_center(tree.robot, poses)
    if center is None:
        return np.zeros(2)
    found: Array = np.array(center[:2]) - np.mean([p[:, :2].mean(axis=0) for p in feet], axis=0)
    return found


def _choose_depth(bends: Sequence[Bends]) -> float | None:
    """Return the depth [m] of all feet, the least that bends a leg; None if not all reach one."""
    least = max(float(one.depths[0]) for one in bends)
    most = min(float(one.depths[-1]) for one in bends)
    return None if least > most else min(max(min(one.usual for one in bends), least), most)


def choose_standing_positions(
    tree: RigidTree, boxes: ShapeBoxes, home: HomePositions, written: Written
) -> dict[str, float]:
    """Choose positions with bent legs, if the user asks for it, or if it would not stand as it is.

    Without the user's word, the legs are bent if zero is outside of the limits of hip or knee, if a
    foot is not on the ground, or if the root is, and if no other source gives their positions.

    Raises:
        ModelError: The user asks for it, and the robot has no legs that can be bent.
    """
    legs = find_legs(tree, boxes, home.values)
    ends = list(find_leg_chains(tree, boxes, home.values))
    joints = {joint.name for leg in legs for joint in leg.joints}
    is_whole = len(legs) > 1 and len(legs) == len(ends)
    if not home.stands and not (
        is_whole and not joints & home.given and _needs_bend(tree, boxes, legs, home)
    ):
        return home.values
    found = compute_standing_positions(tree, boxes, legs, home.values) if is_whole else None
    if found is None or compute_standing_margin(tree, boxes, found) < MARGIN:
        if home.stands:
            raise ModelError(_explain_unbent(legs, ends, found), at=tree.robot.place)
        return home.values
    _report_bent(tree, legs, home, found, written)
    return found


def _needs_bend(
    tree: RigidTree, boxes: ShapeBoxes, legs: Sequence[Leg], home: HomePositions
) -> bool:
    """Tell whether a hip or knee cannot be at zero, a foot is in the air, or the robot lies."""
    if any(joint.name in home.clamped for leg in legs for joint in (leg.hip, leg.knee)):
        return True
    ground = measure_ground(tree, boxes, home.values)
    if ground is None:
        return False
    if tree.root.name in ground.get_near(CLEARANCE):
        return True
    low = ground.low + LEVEL * ground.size
    return any(ground.get_lowest(leg.foot) > low for leg in legs)


def compute_standing_margin(
    tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float]
) -> float:
    """Compute the margin of the center of mass [m]; infinite for a robot without mass."""
    poses = compute_level_poses(tree.robot, positions)
    center = compute_center(tree.robot, poses)
    if center is None:
        return math.inf
    return compute_margin(list_support_points(tree, boxes, poses).tolist(), center)


def report_support(
    tree: RigidTree, boxes: ShapeBoxes, positions: Mapping[str, float], written: Written
) -> None:
    """Report a free robot whose center of mass is outside its support polygon at home, or near."""
    poses = compute_level_poses(tree.robot, positions)
    center, ground = compute_center(tree.robot, poses), measure_ground(tree, boxes, positions)
    if center is None or ground is None:
        return
    level = max(CONTACT, CLEARANCE * ground.size)
    points = list_support_points(tree, boxes, poses, level)
    margin = compute_margin(points.tolist(), center)
    tilt = math.degrees(math.atan2(margin, center[2] - points[:, 2].min(initial=center[2])))
    if tilt >= NARROW or math.isinf(margin):
        return
    text = _describe_support(ground, margin, tilt)
    data = {"margin": margin, "tilt": tilt}
    place, severity = tree.robot.place, Severity.INFO
    written.report_loss("unsupported", text, place, severity=severity, data=data)
    written.advice.append(text)


def _describe_support(ground: Ground, margin: float, tilt: float) -> str:
    names = [ground.feet[body] for body in ground.get_near(CLEARANCE)]
    shown = ", ".join(f"'{name}'" for name in names[:4]) + (" and others" if len(names) > 4 else "")
    side, then = "inside", f"a tilt of {tilt:.1f}° tips the robot over without a controller"
    if margin < 0:
        side, then = "outside", "the robot falls without a controller"
    distance = f"{abs(1000 * margin):.3g} mm {side} of the support polygon of {shown}"
    return f"at home, the center of mass is {distance}: {then}"


def _explain_unbent(
    legs: Sequence[Leg], ends: Sequence[str], found: Mapping[str, float] | None
) -> str:
    """Explain why a robot has no pose in which it stands."""
    if len(ends) < 2:
        why = "it has fewer than two legs"
    elif len(legs) < len(ends):
        bent = {leg.foot for leg in legs}
        names = ", ".join(f"'{end}'" for end in ends if end not in bent)
        why = f"the legs of {names} have no hip and knee with parallel, level axes"
    elif found is None:
        why = "within the limits, the feet do not reach one height below the hips"
    else:
        why = "its center of mass is not above the support polygon of its feet"
    return f"--pose {STAND}: the robot has no pose in which it stands: {why}"


def _report_bent(
    tree: RigidTree,
    legs: Sequence[Leg],
    home: HomePositions,
    found: Mapping[str, float],
    written: Written,
) -> None:
    names = [joint.name for leg in legs for joint in leg.joints]
    clamped = [name for name in names if name in home.clamped]
    why = f" ('{clamped[0]}' cannot be at zero)" if clamped else ""
    shown = list_first([f"'{name}' {found[name]:.3g}" for name in names], 3)
    written.report_loss(
        "standing",
        f"the home position bends the {len(legs)} legs so that each foot is below its hip{why}: "
        f"{shown}; --pose JOINT=VALUE sets others",
        tree.robot.place,
        severity=Severity.INFO,
        data={"positions": {name: found[name] for name in names}},
    )
