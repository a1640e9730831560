"""Motion of the free bodies and joints of a MuJoCo model, from poses of its simulation."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ...mechanics.reference import Array
from ...mechanics.standing import (
    DRIFT,
    THE_BASE,
    TILT,
    BaseMotion,
    Bounds,
    JointMotion,
    Motion,
    estimate_end,
)
from ...mujoco_library import import_mujoco

WHEEL = 0.01
"""Distance of the center of mass of a wheel from its axis, at most [size of the robot]; chosen, no
source.
"""


class ModelPose:
    """Joint positions, places of the free bodies, and of the mass that each carries."""

    def __init__(self, model: Any, data: Any, bases: list[int]) -> None:
        self.bodies, self.joints = bases, np.array(data.qpos)
        self.places = np.array(data.xpos[bases])
        self.up = np.array(data.xmat[bases])[:, 6:]  # the world's z axis in the body
        self.heights = np.array(data.subtree_com[bases])[:, 2]
        self.all_places, self.geoms = np.array(data.xpos), np.array(data.geom_xpos)
        self.lows = dict(list_low_points(import_mujoco("--verify"), model, data))
        self.size = _measure_size(model, self)
        self.wheels = set(_list_wheels(import_mujoco("--verify"), model, data, self.size))


def measure_motion(
    model: Any, data: Any, names: dict[int, str], poses: list[ModelPose], held: set[int]
) -> Motion:
    """Measure the motion of a model from the first pose to the last.

    Args:
        model: The model.
        data: Its state at the end.
        names: Names of the joints that are not free.
        poses: At the start, and at the beginning, in the middle and at the end of the last window.
        held: Joints that a servo or motor holds.
    """
    mujoco, start = import_mujoco("--verify"), poses[0]
    return Motion(
        _measure_bases(mujoco, model, data, poses),
        _measure_joints(mujoco, model, names, poses, held),
        bounds=Bounds.make_for_size(start.size),
    )


def _measure_bases(mujoco: Any, model: Any, data: Any, poses: list[ModelPose]) -> list[BaseMotion]:
    """Measure the motion of each free body, from the start to the last of the poses."""
    start, *window = poses
    end, found = window[-1], []
    is_alone = (model.body_parentid[1:] == 0).sum() == 1
    for row, body in enumerate(start.bodies):
        moves = [pose.places[row] - start.places[row] for pose in window]
        cosines = [float(start.up[row] @ pose.up[row]) for pose in window]
        tilts = [math.degrees(math.acos(min(max(cosine, -1.0), 1.0))) for cosine in cosines]
        own = [geom for geom in start.lows if model.body_rootid[model.geom_bodyid[geom]] == body]
        lowest = min((start.lows[geom] for geom in own), default=0.0)
        height = max(float(start.heights[row]) - lowest, DRIFT)
        sunk = float(start.heights[row] - end.heights[row])
        low = min((end.lows[geom] for geom in own), default=0.0)
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body) or body
        found.append(
            BaseMotion(
                THE_BASE if is_alone else f"body '{name}'",
                drift=float(np.linalg.norm(moves[-1])),
                slide=abs(estimate_end([float(np.linalg.norm(move[:2])) for move in moves])),
                tilt=tilts[-1],
                lean=abs(estimate_end(tilts)),
                sink=-float(moves[-1][2]),
                drop=sunk / height,
                shrinking=float(sunk + low - lowest) / height,
                resting=tuple(_list_resting_bodies(mujoco, model, data, start, own, body, lowest)),
            )
        )
    return found


def _list_resting_bodies(
    mujoco: Any, model: Any, data: Any, start: ModelPose, own: list[int], base: int, lowest: float
) -> Iterator[str]:
    """List the bodies in contact with the world that were too high for it at the start."""
    touching = set()
    for contact in data.contact[: data.ncon]:
        bodies = [int(model.geom_bodyid[geom]) for geom in contact.geom]
        if model.body_weldid[bodies[0]] == 0 or model.body_weldid[bodies[1]] == 0:
            touching |= {int(model.body_weldid[body]) for body in bodies}
    spans: dict[int, float] = {}
    for geom in own:
        reach = float(np.linalg.norm((start.geoms[geom] - start.all_places[base])[:2]))
        above = start.lows[geom] - lowest - DRIFT - math.sin(math.radians(TILT)) * reach
        rigid = int(model.body_weldid[model.geom_bodyid[geom]])
        spans[rigid] = min(above, spans.get(rigid, math.inf))
    for rigid, above in spans.items():
        if rigid in touching and above > 0:
            yield mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, rigid) or str(rigid)


def _measure_joints(
    mujoco: Any,
    model: Any,
    names: dict[int, str],
    poses: list[ModelPose],
    held: set[int],
) -> list[JointMotion]:
    """Measure the motion of each joint that does not follow another one."""
    start, end = poses[0], poses[-1]
    kinds = mujoco.mjtJoint
    followers = {
        int(model.eq_obj1id[number])
        for number in range(model.neq)
        if model.eq_type[number] == mujoco.mjtEq.mjEQ_JOINT and model.eq_obj2id[number] >= 0
    }
    found = []
    for joint, name in names.items():
        if joint in followers or joint in start.wheels:
            continue
        first = int(model.jnt_qposadr[joint])
        moved = end.joints[first] - start.joints[first]
        if model.jnt_type[joint] == kinds.mjJNT_BALL:
            part = slice(first, first + 4)  # a unit quaternion
            moved = 2 * math.acos(min(abs(float(end.joints[part] @ start.joints[part])), 1.0))
        found.append(
            JointMotion(
                name,
                abs(float(moved)),
                is_held=joint in held,
                is_slide=bool(model.jnt_type[joint] == kinds.mjJNT_SLIDE),
                is_carried=int(model.body_rootid[model.jnt_bodyid[joint]]) in start.bodies,
            )
        )
    return found


def _list_wheels(mujoco: Any, model: Any, data: Any, size: float) -> Iterator[int]:
    """List the joints that turn without a limit about an axis through what they carry."""
    for joint in range(model.njnt):
        if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE and not model.jnt_limited[joint]:
            arm = data.subtree_com[model.jnt_bodyid[joint]] - data.xanchor[joint]
            if np.linalg.norm(np.cross(arm, data.xaxis[joint])) < WHEEL * size:
                yield joint


def _measure_size(model: Any, start: ModelPose) -> float:
    """Measure the largest extent of the spheres about the geoms of moving bodies [m]."""
    own = np.flatnonzero((model.geom_rbound > 0) & (model.body_weldid[model.geom_bodyid] > 0))
    if not len(own):
        return float(model.stat.extent)
    places, radii = start.geoms[own], model.geom_rbound[own][:, None]
    return float(((places + radii).max(axis=0) - (places - radii).min(axis=0)).max())


def compute_lowest_point(mujoco: Any, model: Any, data: Any) -> float:
    """Compute the height [m] of the lowest point of the collision geoms, in the world."""
    return min((low for _, low in list_low_points(mujoco, model, data)), default=0.0)


def list_low_points(mujoco: Any, model: Any, data: Any) -> Iterator[tuple[int, float]]:
    """Yield each collision geom that is not a plane, and the height of its lowest point [m]."""
    kinds = mujoco.mjtGeom
    for geom in range(model.ngeom):
        kind = int(model.geom_type[geom])
        collides = model.geom_contype[geom] or model.geom_conaffinity[geom]
        if not collides or kind in (int(kinds.mjGEOM_PLANE), int(kinds.mjGEOM_HFIELD)):
            continue
        rotation = data.geom_xmat[geom].reshape(3, 3)
        place, size = data.geom_xpos[geom], model.geom_size[geom]
        if kind in _REACHES:
            yield geom, float(place[2] - _REACHES[kind](rotation[2], size))
            continue
        if kind == int(kinds.mjGEOM_MESH):
            mesh = int(model.geom_dataid[geom])
            first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
            points = model.mesh_vert[first : first + count]
        else:
            middle, half = model.geom_aabb[geom][:3], model.geom_aabb[geom][3:]
            signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
            points = middle + signs * half
        yield geom, float((points @ rotation.T + place)[:, 2].min())


_SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER = 2, 3, 4, 5  # mjtGeom of MuJoCo

_REACHES: dict[int, Callable[[Array, Array], float]] = {
    _SPHERE: lambda _, size: float(size[0]),
    _CAPSULE: lambda up, size: float(size[0] + abs(up[2]) * size[1]),
    _ELLIPSOID: lambda up, size: float(np.linalg.norm(up * size)),
    _CYLINDER: lambda up, size: float(
        abs(up[2]) * size[1] + size[0] * math.sqrt(max(0.0, 1 - up[2] ** 2))
    ),
}
"""How far shapes reach below their center [m]: by the world's z axis in the shape, and its size."""
