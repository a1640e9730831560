"""Stepping of a robot that was read back from an export of another format than MJCF.

The robot is written as MJCF, with the joint positions, servos and contact pairs that the file has,
and stepped in MuJoCo as an export to MJCF is. A free base stands on a floor below its lowest point.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from ..compare.check import Check
from ..errors import UrdftoolError
from ..extras import is_installed
from ..finding import Finding
from ..model.elements import Robot
from ..model.kinematics import find_movable_joints
from .common.directory import write_export
from .common.losses import DeclaredLosses
from .written import Written

START = "its start in MuJoCo"
"""Where a robot starts that was read back, for the table."""


def check_read_back(
    robot: Robot,
    positions: Mapping[str, float],
    timestep: float | None,
    losses: Iterable[Finding],
    *,
    self_collides: bool,
) -> Check:
    """Step a robot that was read back, and describe how it moves.

    Positions are those of the start [rad or m]; gains were chosen for the time step [s]. Links
    collide with each other only with ``self_collides``.

    Returns:
        The row ``runs``; not compared if MuJoCo is not installed, or the robot is not an MJCF.
    """
    check = Check("runs", f"2 s from {START}", 0.0)
    if not is_installed("mujoco"):
        check.skipped = "not stepped: MuJoCo is not installed"
        return check
    from .mjcf.verify_runs import check_runs

    try:
        written = _write_mjcf(robot, positions, timestep)
        declared = DeclaredLosses.from_findings([*losses, *written.losses])
        with TemporaryDirectory(prefix="urdftool-") as folder:
            path = Path(folder) / "robot.xml"
            write_export(path, written, single=True)
            return check_runs(
                path, declared, excluded=True, start=START, self_collides=self_collides
            )
    except UrdftoolError as error:
        check.skipped = f"not stepped: {error.message}"
        return check


def _write_mjcf(robot: Robot, positions: Mapping[str, float], timestep: float | None) -> Written:
    """Write a robot as MJCF, from its own positions and with its own servos."""
    from .mjcf.options import Options
    from .mjcf.write import write

    own = {
        name: positions[name]
        for name, joint in find_movable_joints(robot).items()
        if joint.mimic is None and name in positions
    }
    return write(robot, Options(pose=own, timestep=timestep, force=True, file="robot.xml"))
