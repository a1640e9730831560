"""Comparison of what Newton imports of a stage with the source of the export."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from pxr import Usd

from ...compare.check import Check
from ...errors import UrdftoolError
from ...isolated import IsolatedProcess
from ...mechanics.reference import Mechanics
from ...model.elements import Joint, Robot
from ...model.kinematics import add_mimic_positions, get_limits
from ...model.pose import rotation_from_quaternion
from ...model.settings import OF_LIMITS, RESISTANCE
from ..common.losses import DeclaredLosses
from .declared_losses import INERTIA, MASS, TREE
from .verify_newton_shapes import compare_colliders
from .verify_newton_source import (
    CONFIGURATIONS,
    FLOAT,
    Source,
    compare_poses,
    get_effort,
    get_gains,
    get_inertial,
    make_source,
    resolve_mimic,
)

Array = npt.NDArray[np.float64]

TIME_LIMIT = 300.0
"""Time [s] for the import; the first one on a machine compiles Newton's kernels."""

_NO_EFFORT, _NO_VELOCITY = 1e6, 1e6
"""Values of Newton for joints without such limits; those with a drive have an infinite effort."""

_UNLIMITED = 1e9
"""Position beyond which Newton treats a joint as unlimited."""


def compare_newton(robot: Robot, losses: DeclaredLosses, path: Path) -> list[Check]:
    """Import a stage with Newton in a process of its own, and compare it with the source."""
    source = make_source(robot, losses, path)
    links, joints = _read_names(path)
    paths = {name: label for label, name in joints.items()}
    configurations = [
        {
            paths[name]: value
            for name, value in add_mimic_positions(source.robot, q).items()
            if name in paths
        }
        for q in source.configurations
    ]
    accepted = Check("Newton: import", "Newton accepts the stage", 0.0)
    try:
        with IsolatedProcess("newton", environment={"CUDA_VISIBLE_DEVICES": ""}) as process:
            answer: dict[str, Any] = process.call(
                "urdftool.formats.usd.newton_child",
                "read_stage",
                str(path),
                configurations,
                time_limit=TIME_LIMIT,
            )
    except UrdftoolError as error:
        accepted.compare(1.0, error.message)
        return [accepted]
    if "error" in answer:
        known = losses.has_any("lossy-several-robots")
        accepted.compare(1.0, answer["error"], known=known)
        return [accepted]
    bodies = {links[label]: body for label, body in answer["bodies"].items() if label in links}
    moving = {joints[label]: joint for label, joint in answer["joints"].items() if label in joints}
    accepted.compare(0.0, "")
    return [
        accepted,
        *_compare_bodies(source, bodies),
        *_compare_joints(source, moving, joints),
        _compare_frames(source, answer["poses"], links),
        *compare_colliders(source, answer["shapes"], links),
    ]


def _read_names(path: Path) -> tuple[dict[str, str], dict[str, str]]:
    """Return the names of links and joints by the paths of their prims."""
    links: dict[str, str] = {}
    joints: dict[str, str] = {}
    stage = Usd.Stage.Open(str(path))
    for prim in stage.Traverse():
        for names, kind in ((links, "link"), (joints, "joint")):
            stored = prim.GetCustomDataByKey(f"urdf:{kind}")
            if stored:
                names[str(prim.GetPath())] = str(stored)
    return links, joints


def _compare_bodies(source: Source, bodies: Mapping[str, dict[str, Any]]) -> list[Check]:
    mass = Check("Newton: mass", "mass of each body, and their sum, relative", FLOAT)
    center = Check("Newton: center of mass", "of each body [m]", FLOAT)
    inertia = Check("Newton: inertia", "tensor of each body, relative to its largest entry", FLOAT)
    repaired = Check("Newton: repairs", "mass and inertia after finalize()", FLOAT)
    total = 0.0
    for link in source.robot.links:
        weight, at, tensor = get_inertial(link)
        body = bodies.get(link.name)
        name = f"link '{link.name}'"
        if body is None:
            mass.compare(float(weight > 0), f"{name} is not a body")
            continue
        total += body["mass"]
        known = source.losses.has_for(MASS, link.name)
        mass.compare(abs(weight - body["mass"]) / max(weight, 1e-30), name, known=known)
        size = max(1.0, float(np.abs(at).max()))
        if weight:
            offset = float(np.abs(at - np.array(body["com"])).max())
            center.compare(offset / size, name, known=known)
        read = np.array(body["inertia"])
        known = source.losses.has_for(INERTIA, link.name)
        scale = float(np.abs(tensor).max()) or 1.0
        inertia.compare(float(np.abs(tensor - read).max()) / scale, name, known=known)
        final = float(np.abs(np.array(body["final_inertia"]) - read).max())
        repaired.compare(final / max(float(np.abs(read).max()), 1e-30), name)
    expected = sum(get_inertial(link)[0] for link in source.robot.links)
    sums = abs(total - expected) / max(expected, 1e-30)
    mass.compare(sums, "sum", known=source.losses.has_any(*MASS))
    return [mass, center, inertia, repaired]


def _compare_joints(
    source: Source, moving: Mapping[str, dict[str, Any]], names: Mapping[str, str]
) -> list[Check]:
    freedoms = Check("Newton: joints", "types and degrees of freedom", 0.0)
    values = Check(
        "Newton: joint values",
        f"limits, {', '.join(row.name for row in (*OF_LIMITS, *RESISTANCE))}, drives",
        1e-6,
    )
    mimic = Check("Newton: mimic", "leader, factor and offset", 1e-6)
    for joint in source.robot.joints:
        read = moving.get(joint.name)
        known = source.losses.has_for(TREE, joint.name)
        label = f"joint '{joint.name}'"
        if read is None:
            freedoms.compare(float(not joint.is_fixed and joint.type != "floating"), label,
                             known=known)  # fmt: skip
            continue
        expected = _FREEDOMS.get(joint.type, 0)
        freedoms.compare(float(read["freedoms"] != expected), label, known=known)
        if expected != 1 or read["freedoms"] != 1:
            continue
        for name, (ours, theirs) in _get_values(source, joint, read).items():
            lost = ("lossy-velocity",) if name == "velocity" else ()
            excused = known or source.losses.has_for(lost, joint.name)
            values.compare(_measure_difference(ours, theirs), f"{name} of {label}", known=excused)
        _compare_mimic(source, joint, read, names, mimic)
    return [freedoms, values, mimic]


_FREEDOMS = {"revolute": 1, "continuous": 1, "prismatic": 1, "planar": 3, "ball": 3, "spherical": 3}


def _get_values(
    source: Source, joint: Joint, read: Mapping[str, float]
) -> dict[str, tuple[float, float]]:
    lower, upper = get_limits(joint)
    velocity = joint.get_magnitude("velocity")
    kp, kd = get_gains(source.robot, joint)
    return {
        "lower limit": (_bound(lower), _bound(read["limit_lower"])),
        "upper limit": (_bound(upper), _bound(read["limit_upper"])),
        "effort": (get_effort(joint), _bound(read["effort_limit"])),
        "velocity": (_NO_VELOCITY if velocity is None else velocity, read["velocity_limit"]),
        **{
            row.name: (getattr(joint.dynamics, row.name, None) or 0.0, read[row.name])
            for row in RESISTANCE
        },
        "kp of the drive": (kp, read["target_ke"]),
        "kd of the drive": (kd, read["target_kd"]),
    }


def _bound(value: float) -> float:
    return math.copysign(math.inf, value) if abs(value) >= _UNLIMITED else value


def _measure_difference(one: float, other: float) -> float:
    return 0.0 if one == other else abs(one - other) / max(1.0, abs(one))


def _compare_mimic(
    source: Source, joint: Joint, read: Mapping[str, Any], names: Mapping[str, str], check: Check
) -> None:
    leader, factor, offset = resolve_mimic(joint, source.robot)
    got = read["mimic"]
    theirs = (joint.name, 1.0, 0.0) if got is None else (names.get(got[0], ""), *got[1:])
    difference = float(leader != theirs[0])
    if not difference:
        difference = max(
            _measure_difference(float(factor), theirs[1]),
            _measure_difference(float(offset), theirs[2]),
        )
    known = source.losses.has_for(("lossy-mimic",), joint.name)
    check.compare(difference, f"joint '{joint.name}'", known=known)


def _compare_frames(
    source: Source, poses: list[dict[str, list[float]]], links: Mapping[str, str]
) -> Check:
    check = Check(
        "Newton: frames", f"poses of bodies in the first, at {CONFIGURATIONS + 1} configurations",
        1e-5,
    )  # fmt: skip
    mechanics = Mechanics(source.robot)
    for positions, read in zip(source.configurations, poses, strict=True):
        ours = mechanics.compute_frames(add_mimic_positions(source.robot, positions))
        theirs = {links[label]: _make_matrix(row) for label, row in read.items() if label in links}
        for name, difference in compare_poses(ours, theirs):
            known = source.is_below_changed_joint(name)
            check.compare(difference / _count_depth(source, name), f"link '{name}'", known=known)
    return check


def _count_depth(source: Source, link: str) -> int:
    """Return the number of links above a link, at least 1: Newton computes with 32-bit floats."""
    return max(1, sum(1 for _ in source.robot.tree.list_ancestors(link)))


def _make_matrix(row: list[float]) -> Array:
    """Return the 4 × 4 matrix of a position and a quaternion ``(x, y, z, w)``."""
    found = np.eye(4)
    x, y, z, w = row[3:]
    found[:3, 3], found[:3, :3] = row[:3], rotation_from_quaternion((w, x, y, z))
    return found
