"""Comparison of the initial state: the pose of the root, and the key ``home``."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ...compare.check import Check
from ...mechanics.reference import Array, get_origin_matrix, turn
from ...model.elements import Joint
from ...model.read import number, parse_numbers
from ...source.document import Element
from ..common.losses import DeclaredLosses
from .compiled import Compiled
from .verify_source import Source, is_locked

EXACT = 1e-9
GROUND = 1e-4
"""Tolerance of the height of a free robot's lowest point, relative to its size;
the bounding box of a mesh with many points is not exact.
"""

STATES = ("home", "default", "ready", "stand", "standing", "initial", "neutral")
"""Names of group states, in order of preference for the home configuration."""


def check_base(source: Source, compiled: Compiled) -> Check:
    """Compare whether the root is fixed, and its pose."""
    free = source.is_free
    what = f"root {'free, on the floor' if free else 'held'}, its pose; no other bodies"
    check = Check("base", what, EXACT)
    model = compiled.model
    root = 0 if source.root == "world" else compiled.get_body(source.root)
    if root < 0:
        check.compare(math.inf, f"root link '{source.root}' is missing")
        return check
    first, count = int(model.body_jntadr[root]), int(model.body_jntnum[root])
    kinds = [int(model.jnt_type[first + k]) for k in range(count)]
    if kinds != ([int(compiled.mujoco.mjtJoint.mjJNT_FREE)] if free else []):
        check.compare(math.inf, f"root link '{source.root}' is {'free' if kinds else 'held'}")
    if root > 0 and model.body_parentid[root] != 0:
        check.compare(math.inf, f"root link '{source.root}' is not a body of the world")
    compiled.set_pose({})
    if root > 0:
        _compare_place(source, compiled, free, "the root", check)
    links = {compiled.get_body(link.name) for link in source.robot.links}
    for body in range(1, model.nbody):
        if body not in links:
            check.compare(math.inf, f"body '{compiled.name('BODY', body)}' is not a link")
    return check


def check_home(source: Source, compiled: Compiled, declared: DeclaredLosses) -> Check:
    """Compare the key ``home``: limits, mimics, required positions, controls, floor."""
    check = Check("home", "limits, mimics, required positions, controls, floor", EXACT)
    model = compiled.model
    key = compiled.get_id("KEY", "home")
    if key < 0:
        check.compare(math.inf, "there is no key 'home'")
        return check
    positions = compiled.get_positions_of_key(key)
    asked = _get_required(source)
    for joint in source.robot.joints:
        if joint.name not in positions:
            continue
        found = positions[joint.name]
        known = declared.has_for(("lossy-home", "lossy-limit-inverted", "lossy-mimic"), joint.name)
        lower, upper = _collect_limits(joint)
        if lower <= upper:
            beyond = max(lower - found, found - upper, 0.0)
            check.compare(beyond, f"joint '{joint.name}' is beyond its limits", known=known)
        if joint.mimic is not None and joint.mimic.joint in positions:
            leader = positions[joint.mimic.joint]
            wanted = joint.mimic.multiplier * leader + joint.mimic.offset
            off = abs(found - min(max(wanted, lower), upper) if lower < upper else found - wanted)
            check.compare(off, f"joint '{joint.name}' does not follow '{joint.mimic.joint}'")
        elif joint.mimic is None:
            low, high = _get_allowed(source, joint)
            wanted = asked.get(joint.name, 0.0)
            wanted = min(max(wanted, low), high) if low <= high else wanted
            check.compare(abs(found - wanted), f"joint '{joint.name}' is at {found:g}", known=known)
    for index in range(model.nu):
        driven = compiled.name("JOINT", int(model.actuator_trnid[index][0]))
        serves = float(model.actuator_biasprm[index][1]) != 0  # position feedback: a position servo
        wanted = positions.get(driven, 0.0) if serves else 0.0
        off = abs(float(model.key_ctrl[key][index]) - wanted)
        check.compare(off, f"control of joint '{driven}'")
    if np.any(model.key_qvel[key]) or np.any(model.key_act[key]):
        check.compare(math.inf, "the robot moves")
    compiled.set_pose_at_key(key)
    if source.is_free:
        _compare_place(source, compiled, True, "the root", check)
    return check


def _compare_place(source: Source, compiled: Compiled, free: bool, what: str, check: Check) -> None:
    """Compare the pose of the root; a free root stands on the floor."""
    root = max(compiled.get_body(source.root), 0)
    place, rotation = _get_origin(source)
    found = np.array(compiled.data.xpos[root])
    low, size = get_lowest_point(compiled)
    count = 2 if free and math.isfinite(low) else 3
    check.compare(float(abs(found[:count] - place[:count]).max()), f"{what} is at another pose")
    if count == 2:
        check.compare(max(abs(low) - GROUND * max(size, 0.1), 0.0), f"{what} is not on the floor")
    off = float(abs(compiled.data.xmat[root].reshape(3, 3) - rotation).max())
    check.compare(off, f"{what} is turned")


def _get_origin(source: Source) -> tuple[Array, Array]:
    """Return position and rotation of the whole robot in the description."""
    base = source.robot.base
    if base is not None:
        matrix = get_origin_matrix(base.origin)
        return matrix[:3, 3], matrix[:3, :3]
    origin = source.robot.find_child_xml("origin")
    place = (parse_numbers(origin.get("xyz"), 3) if origin is not None else None) or (0.0, 0.0, 0.0)
    angles = (parse_numbers(origin.get("rpy"), 3) if origin is not None else None) or (
        0.0,
        0.0,
        0.0,
    )
    rotation = np.eye(3)
    for axis, angle in zip(np.eye(3), angles, strict=True):
        rotation = turn(axis, angle) @ rotation
    return np.array(place), rotation


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
        a, b = (middle + reach for reach in _get_reaches(compiled, geom, way))
        low, high = min(low, a), max(high, b)
    return low, high - low


def _get_reaches(compiled: Compiled, geom: int, way: Array) -> tuple[float, float]:
    """Return the lower and upper extent of a geom [m], from the third row of its rotation."""
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


def _collect_limits(joint: Joint) -> tuple[float, float]:
    if joint.type not in ("revolute", "prismatic") or joint.limit is None:
        return -math.inf, math.inf
    return joint.limit.lower or 0.0, joint.limit.upper or 0.0


def _get_allowed(source: Source, joint: Joint) -> tuple[float, float]:
    """Return the range of a joint for which its mimic joints are within their limits, too."""
    low, high = _collect_limits(joint)
    for other in source.robot.joints:
        mimic, bounds = other.mimic, _collect_limits(other)
        if mimic is None or mimic.joint != joint.name or not mimic.multiplier:
            continue
        if bounds[0] < bounds[1] and math.isfinite(bounds[0]):
            ends = sorted((bound - mimic.offset) / mimic.multiplier for bound in bounds)
            if max(low, ends[0]) <= min(high, ends[1]):
                low, high = max(low, ends[0]), min(high, ends[1])
    return low, high


def _get_required(source: Source) -> dict[str, float]:
    """Return the positions that ros2_control, a group state of the SRDF, and the user require."""
    found: dict[str, float] = {}
    for control in source.robot.ros2_controls:
        for component in control.joints:
            single = number(component.params.get("initial_position"))
            if single is not None:
                found[component.name] = single
            for interface in component.state_interfaces:
                value = number(interface.params.get("initial_value"))
                if interface.name == "position" and value is not None:
                    found[component.name] = value
    found.update(_state(source))
    found.update(_get_user_positions(source.options.pose))
    return {
        name: value
        for name, value in found.items()
        if (joint := source.robot.joint.get(name)) is not None and not is_locked(joint)
    }


def _get_user_positions(pose: Mapping[str, float]) -> dict[str, float]:
    return {name: float(value) for name, value in pose.items()}


def _state(source: Source) -> dict[str, float]:
    """Return the positions of the group state that the options name, else of the likeliest."""
    root = source.srdf
    states: dict[str, list[Element]] = {}
    for element in root.list_children("group_state") if root is not None else ():
        states.setdefault(element.get("name") or "", []).append(element)
    by_fold = {name.casefold(): name for name in reversed(list(states))}
    likely = [by_fold[name] for name in STATES if name in by_fold] or list(states)
    chosen = source.options.state or (likely[0] if likely else "")
    found = {}
    for state in states.get(chosen, []):
        for joint in state.list_children("joint"):
            value = number(joint.get("value"))
            if value is not None:
                found[joint.get("name") or ""] = value
    return found
