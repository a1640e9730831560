"""Comparison of a scene with its model: the same robot, and a floor below it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ...compare.check import Check
from ...errors import OutputError
from ...model.elements import Robot
from .compiled import Compiled
from .verify_fuse import compare_fields
from .verify_home import get_lowest_point

FLOOR = 1e-4
"""Tolerance of the floor's height, relative to the size of the robot. Chosen, no source."""

ROUNDED = 1.01e-4
"""Rounding of the floor's height [m]."""

FLUSH = 1e-3
"""Depth [m] to which a fixed robot may reach below a floor at z = 0."""

ROBOT = ("jnt_", "dof_", "actuator_", "sensor_", "key_", "eq_sol", "eq_active", "eq_type",
         "body_mass", "body_inertia", "body_pos", "body_quat", "body_ipos", "body_iquat",
         "body_gravcomp")  # fmt: skip
"""Prefixes of the fields of MuJoCo's model that a scene does not change."""


def check_scene(robot: Robot, compiled: Compiled, path: Path) -> Check:
    """Compare a scene with the model it includes.

    Raises:
        OutputError: MuJoCo does not compile it.
    """
    check = Check("scene", "the same robot, with a floor at z = 0 or at its lowest point", FLOOR)
    try:
        scene = Compiled(path, robot.tree.roots[0].name, compiled.renamed)
    except OutputError as error:
        check.differing.append(error.message)
        return check
    for posed in (compiled, scene):
        posed.set_pose({})
    compare_fields(compiled, scene, check, ROBOT)
    model, kinds = scene.model, scene.mujoco.mjtGeom
    planes = [g for g in range(model.ngeom) if int(model.geom_type[g]) == int(kinds.mjGEOM_PLANE)]
    own = sum(int(kind) == int(kinds.mjGEOM_PLANE) for kind in compiled.model.geom_type)
    if len(planes) != own + 1 or model.ngeom != compiled.model.ngeom + 1:
        check.compare(math.inf, f"{len(planes) - own} floors")
        return check
    floor = planes[-1] if planes else 0
    if not model.geom_contype[floor] == model.geom_conaffinity[floor] == 1:
        check.compare(math.inf, "no contact with the floor")
    height, size = _get_floor_height(robot, compiled)
    found = float(scene.data.geom_xpos[floor][2])
    off = max(abs(found - height) - ROUNDED, 0.0)
    check.compare(off / max(size, 0.1), f"the floor is at z = {found:g}")
    up = scene.data.geom_xmat[floor].reshape(3, 3)[2]
    check.compare(float(np.abs(up - (0.0, 0.0, 1.0)).max()), "the floor is tilted")
    return check


def _get_floor_height(robot: Robot, compiled: Compiled) -> tuple[float, float]:
    """Return the expected height of the floor, and the height of the robot [m]."""
    compiled.set_pose({})
    low, size = get_lowest_point(compiled)
    key = compiled.get_id("KEY", "home")
    if key >= 0:
        compiled.set_pose_at_key(key)
        low = min(low, get_lowest_point(compiled)[0])
    is_free = robot.base is not None and robot.base.is_free
    held = not is_free and math.isfinite(low)
    return low if held and low < -FLUSH else 0.0, size if math.isfinite(size) else 0.0
