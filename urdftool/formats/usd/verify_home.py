"""Comparison of the home in a stage: positions, and targets of the servos, in the attributes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path

from pxr import Usd, UsdPhysics

from ...compare.check import Check
from ...model.elements import Robot
from ...model.kinematics import get_limits

TOLERANCE = 1e-6
"""Tolerance of a position [rad or m], relative above 1: a 32-bit float."""


def compare_home(path: Path, robot: Robot, home: Mapping[str, float]) -> Check:
    """Compare positions and targets of joints with the home, and both with the limits."""
    check = Check("home", "positions and targets of servos at home, within limits [rad, m]", 1e-6)
    for name, prim in _list_joints(path):
        joint = robot.joint.get(name)
        if joint is None:
            continue
        expected = home.get(joint.name, 0.0)
        for text, value in _list_positions(prim).items():
            error = abs(value - expected) / max(1.0, abs(expected))
            check.compare(error, f"joint '{joint.name}': {text}")
        lower, upper = get_limits(joint)
        if lower <= upper and joint.mimic is None:
            check.compare(
                max(lower - expected, expected - upper, 0.0), f"joint '{joint.name}': limits"
            )
    return check


def read_start(path: Path) -> dict[str, float]:
    """Return the positions at which the joints of a stage start [rad or m], by name."""
    return {name: _list_positions(prim)["position"] for name, prim in _list_joints(path)}


def _list_joints(path: Path) -> Iterator[tuple[str, Usd.Prim]]:
    """Yield the joints with one degree of freedom, with their names in the source."""
    stage = Usd.Stage.Open(str(path))
    for prim in stage.Traverse():
        name = prim.GetCustomDataByKey("urdf:joint")
        is_single = prim.IsA(UsdPhysics.RevoluteJoint) or prim.IsA(UsdPhysics.PrismaticJoint)
        if name and is_single:
            yield str(name), prim


def _list_positions(prim: Usd.Prim) -> dict[str, float]:
    """Return the position of a joint and the target of its servo, if it has one [rad or m]."""
    kind, unit = "linear", 1.0
    if prim.IsA(UsdPhysics.RevoluteJoint):
        kind, unit = "angular", math.radians(1.0)
    names = {"position": f"state:{kind}:physics:position"}
    if prim.GetAttribute(f"drive:{kind}:physics:stiffness").Get():
        names["target"] = f"drive:{kind}:physics:targetPosition"
    return {text: unit * (prim.GetAttribute(n).Get() or 0.0) for text, n in names.items()}
