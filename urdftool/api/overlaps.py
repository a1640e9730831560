"""Links that overlap at home, as ``export mjcf`` finds and excludes them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from ..errors import UrdftoolError
from ..model.elements import Robot
from ..model.kinematics import find_movable_joints

if TYPE_CHECKING:
    from ..finding import Finding


def find_overlaps(robot: Robot, positions: Mapping[str, float]) -> Finding | None:
    """Find the links that overlap at joint positions, with the collision geometry of MuJoCo.

    Args:
        robot: The robot.
        positions: Joint positions by name [rad or m].

    Returns:
        The warning of ``export mjcf``, whose data has the ``pairs``; None if there are none, if
        MuJoCo is not installed, or if the robot cannot be written as MJCF.
    """
    from ..formats.mjcf.options import Options
    from ..formats.mjcf.write import write

    leading = {n for n, joint in find_movable_joints(robot).items() if joint.mimic is None}
    pose = {name: value for name, value in positions.items() if name in leading}
    options = Options(
        actuators="none", exclude="touching", pose=pose, force=True, keep_locked_joints=True
    )
    try:
        written = write(robot, options)
    except UrdftoolError:
        return None
    return next((loss for loss in written.losses if loss.code == "lossy-overlap"), None)
