"""The key home of MuJoCo's model: within limits, consistent, held, and standing on the floor."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..check import Check
from ..mechanics import Array
from .announced import LIMITS, TREE, Said
from .compiled import Compiled
from .verify_source import Source

FLOOR = 2e-6
"""How far the lowest point of a free robot may be from the floor [m]; heights are rounded."""

MIMIC = 1e-9


def home_check(source: Source, compiled: Compiled, said: Said) -> Check:
    """Check the key home: limits, mimics, controls of servos, and the height of a free base."""
    check = Check("home", "key home: limits, mimics, controls, lowest point on the floor", FLOOR)
    model = compiled.model
    key = compiled.id("KEY", "home")
    if key < 0:
        check.compare(math.inf, "the model has no key 'home'")
        return check
    start = np.array(model.key_qpos[key])
    for joint in source.robot.joints:
        number = compiled.id("JOINT", joint.name)
        if number < 0 or not model.jnt_limited[number]:
            continue
        low, high = model.jnt_range[number]
        position = start[model.jnt_qposadr[number]]
        off = max(low - position, position - high, 0.0)
        follows = joint.mimic is not None
        check.compare(float(off), f"joint '{joint.name}' is beyond its limits", known=follows)
    for name, off in _mimics(source, compiled, start):
        known = said.of((*TREE, *LIMITS), name)
        check.compare(off * FLOOR / MIMIC, f"joint '{name}' is not where it mimics", known=known)
    _controls(compiled, start, key, check)
    if source.is_free and any(link.collisions for link in source.robot.links):
        for what, positions in (("home", start), ("zero", np.array(model.qpos0))):
            off = abs(_lowest(compiled, positions))
            check.compare(off, f"lowest point at {what} is not on the floor")
    return check


def _mimics(source: Source, compiled: Compiled, start: Array) -> Iterator[tuple[str, float]]:
    """Followers that are within their limits where they follow, with their distance from there."""
    model = compiled.model
    for joint in source.robot.joints:
        if joint.mimic is None:
            continue
        numbers = [compiled.id("JOINT", name) for name in (joint.name, joint.mimic.joint)]
        if min(numbers) < 0 or numbers[0] == numbers[1]:
            continue
        own, led = (float(start[model.jnt_qposadr[number]]) for number in numbers)
        place = joint.mimic.multiplier * led + joint.mimic.offset
        if model.jnt_limited[numbers[0]]:
            low, high = model.jnt_range[numbers[0]]
            place = min(max(place, float(low)), float(high))
        yield joint.name, abs(own - place)


def _controls(compiled: Compiled, start: Array, key: int, check: Check) -> None:
    """Compare the control of a servo with the position of its joint; that of others with zero."""
    model = compiled.model
    for number in range(model.nu):
        joint = int(model.actuator_trnid[number][0])
        servo = model.actuator_biastype[number] == 1 and model.actuator_biasprm[number][1] != 0
        wanted = float(start[model.jnt_qposadr[joint]]) if servo else 0.0
        off = abs(float(model.key_ctrl[key][number]) - wanted)
        check.compare(off, f"control of '{compiled.name('ACTUATOR', number)}'")


def _lowest(compiled: Compiled, positions: Array) -> float:
    """The lowest point [m] of what collides, with the joints somewhere."""
    model, data = compiled.model, compiled.data
    data.qpos[:] = positions
    compiled.mujoco.mj_kinematics(model, data)
    return min(
        float(data.geom_xpos[geom][2]) - _depth(compiled, geom, data.geom_xmat[geom].reshape(3, 3))
        for geom in range(model.ngeom)
        if model.geom_contype[geom] or model.geom_conaffinity[geom]
    )


def _depth(compiled: Compiled, geom: int, axes: Array) -> float:
    """How far a geom reaches below its origin [m]."""
    model, kinds = compiled.model, compiled.mujoco.mjtGeom
    size, up = model.geom_size[geom], axes[2]
    kind: Any = model.geom_type[geom]
    if kind == kinds.mjGEOM_SPHERE:
        return float(size[0])
    if kind == kinds.mjGEOM_CAPSULE:
        return float(size[0] + size[1] * abs(up[2]))
    if kind == kinds.mjGEOM_CYLINDER:
        return float(size[0] * math.hypot(up[0], up[1]) + size[1] * abs(up[2]))
    if kind == kinds.mjGEOM_ELLIPSOID:
        return float(np.linalg.norm(size * up))
    if kind == kinds.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        return -float((model.mesh_vert[first : first + count] @ up).min())
    return float(size @ abs(up))
