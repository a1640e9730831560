"""Comparison of the initial state in the compiled model: root, floor, limits and controls."""

from __future__ import annotations

import math

import numpy as np

from ...compare.check import Check
from ...mechanics.reference import Array, get_origin_matrix
from ...model.elements import Robot
from ...model.world import WORLD
from .compiled import Compiled

EXACT = 1e-9
"""Tolerance of values that are copied. Chosen, no source."""

GROUND = 1e-4
"""Tolerance of the height of a free robot's lowest point, relative to its size; the bounding box of
a mesh with many points is not exact. Chosen, no source."""


_OF_JOINTS = (0, 1)
"""``mjtTrn`` of actuators of joints."""


def check_home(
    robot: Robot, compiled: Compiled, *, on_floor: bool = True, is_copied: bool = False
) -> Check:
    """Compare the initial pose, and the key ``home`` with limits, controls and the floor."""
    check = Check("home", "pose of the root, floor, limits, controls", EXACT)
    model = compiled.model
    key = compiled.get_id("KEY", "home")
    if key < 0:
        check.compare(math.inf, "there is no key 'home'")
    compiled.set_pose({})
    _compare_root(robot, compiled, check, on_floor=on_floor)
    if key < 0 or is_copied:
        return check
    positions = compiled.get_positions_of_key(key)
    for index in range(model.nu):
        if model.actuator_trntype[index] not in _OF_JOINTS:
            continue
        driven = compiled.name("JOINT", int(model.actuator_trnid[index][0]))
        serves = float(model.actuator_biasprm[index][1]) != 0  # position feedback: a position servo
        off = abs(float(model.key_ctrl[key][index]) - serves * positions.get(driven, 0.0))
        check.compare(off, f"control of joint '{driven}'")
    if np.any(model.key_qvel[key]) or np.any(model.key_act[key]):
        check.compare(math.inf, "the robot moves")
    compiled.set_pose_at_key(key)
    _compare_root(robot, compiled, check, on_floor=on_floor)
    return check


def _compare_root(robot: Robot, compiled: Compiled, check: Check, *, on_floor: bool) -> None:
    """Compare the pose of the root; a free root stands on the floor."""
    root = robot.tree.roots[0].name
    body = compiled.get_body(root)
    if root == WORLD or body < 0:  # the tree lacks it
        return
    if compiled.model.body_parentid[body] != 0:
        check.compare(math.inf, f"root link '{root}' is not a body of the world")
    is_free = robot.base is not None and robot.base.is_free
    expected = get_origin_matrix(None if robot.base is None else robot.base.origin)
    found = np.array(compiled.data.xpos[body])
    low, size = get_lowest_point(compiled)
    count = 2 if is_free and on_floor and math.isfinite(low) else 3
    off = float(abs(found[:count] - expected[:count, 3]).max())
    check.compare(off, "the root is at another pose")
    if count == 2:
        check.compare(max(abs(low) - GROUND * max(size, 0.1), 0.0), "the root is not on the floor")
    off = float(abs(compiled.data.xmat[body].reshape(3, 3) - expected[:3, :3]).max())
    check.compare(off, "the root is turned")


def get_lowest_point(compiled: Compiled) -> tuple[float, float]:
    """Return the lowest point of the collision geometry, and its height [m]; inf without geometry.

    Without collision geometry, visual geometry is measured.
    """
    model, data = compiled.model, compiled.data
    touching = [g for g in range(model.ngeom) if model.geom_contype[g] or model.geom_conaffinity[g]]
    low, high = math.inf, -math.inf
    for geom in touching or range(model.ngeom):
        if model.geom_bodyid[geom] == 0:
            continue
        way = data.geom_xmat[geom].reshape(3, 3)[2]
        middle = float(data.geom_xpos[geom][2])
        a, b = (middle + reach for reach in get_reaches(compiled, geom, way))
        low, high = min(low, a), max(high, b)
    return low, high - low


def get_reaches(compiled: Compiled, geom: int, way: Array) -> tuple[float, float]:
    """Return the extents of a geom along a direction of unit length in its frame [m]."""
    model, kinds = compiled.model, compiled.mujoco.mjtGeom
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    if kind == int(kinds.mjGEOM_MESH):
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        heights = model.mesh_vert[first : first + count].astype(float) @ way
        return float(heights.min()), float(heights.max())
    if kind == int(kinds.mjGEOM_BOX):
        half = float(abs(way) @ size)
    elif kind == int(kinds.mjGEOM_CYLINDER):
        half = float(size[0] * math.hypot(way[0], way[1]) + size[1] * abs(way[2]))
    elif kind == int(kinds.mjGEOM_CAPSULE):
        half = float(size[0] + size[1] * abs(way[2]))
    elif kind == int(kinds.mjGEOM_ELLIPSOID):
        half = float(np.linalg.norm(way * size))
    else:
        half = float(size[0])
    return -half, half
