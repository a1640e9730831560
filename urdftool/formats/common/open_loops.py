"""Closed loops of a robot that are open at its home configuration."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ...model.elements import Robot
from ...model.kinematics import compute_link_poses
from ...model.mechanism import Closure
from ...model.pose import Pose, make_pose
from ..written import Written

_OPEN = 1e-3
"""Distance [m] of the two ends above which a simulator moves the robot noticeably to close the
loop; chosen, no source.
"""


def report_open_loops(robot: Robot, positions: Mapping[str, float], written: Written) -> None:
    """Report the loops whose ends are apart at a configuration."""
    if not robot.closures:
        return
    poses = compute_link_poses(robot, positions)
    gaps: dict[int, tuple[float, Closure]] = {}
    for loop in robot.closures:
        if loop.is_active and loop.parent in poses and loop.child in poses:
            gap = _measure_gap(loop, poses)
            # one joint may make two constraints
            gaps[id(loop.provenance)] = max(
                (gap, loop), gaps.get(id(loop.provenance), (_OPEN, loop)), key=lambda one: one[0]
            )
    for gap, loop in gaps.values():
        if gap > _OPEN:
            _report(loop, gap, written)


def _report(loop: Closure, gap: float, written: Written) -> None:
    name = loop.name or f"{loop.parent} – {loop.child}"
    written.report_loss(
        "open-loop",
        f"closed loop '{name}' is open by {gap:.3g} m at home, and simulators close it with a "
        "jerk; --pose chooses other positions",
        loop.place,
        kind="closed loop",
        name=name,
    )


def _measure_gap(loop: Closure, poses: Mapping[str, Pose]) -> float:
    """Return the distance [m] of the two ends of a loop."""
    one = poses[loop.parent] @ make_pose(loop.origin)
    other = poses[loop.child] @ make_pose(loop.child_origin)
    return math.dist(one.translation, other.translation)
