"""Types, limits, drives and dynamics of joints."""

from __future__ import annotations

import math
from typing import NamedTuple

from pxr import Usd, UsdPhysics

from ...diagnostic import Severity
from ...model.elements import Dynamics, Joint, Limit, Mimic, Vector
from ...model.mechanism import JointActuator
from .read_stage import Context, convert_float, get_targets, get_value, has_schema

_AXES: dict[str, Vector] = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}

_FREEDOMS = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")


class JointKind(NamedTuple):
    """Type of a joint in URDF, and its axis in the frame of the joint."""

    type: str
    axis: Vector = (1.0, 0.0, 0.0)
    freedom: str = ""


def find_kind(context: Context, prim: Usd.Prim) -> JointKind:
    """Determine the type of a joint."""
    if prim.IsA(UsdPhysics.FixedJoint):
        return JointKind("fixed")
    if prim.IsA(UsdPhysics.SphericalJoint):
        return JointKind("ball")
    if prim.IsA(UsdPhysics.RevoluteJoint):
        axis = _AXES[str(UsdPhysics.RevoluteJoint(prim).GetAxisAttr().Get())]
        lower, upper = _read_bounds(prim)
        limited = math.isfinite(lower) or math.isfinite(upper)
        return JointKind("revolute" if limited else "continuous", axis)
    if prim.IsA(UsdPhysics.PrismaticJoint):
        return JointKind(
            "prismatic", _AXES[str(UsdPhysics.PrismaticJoint(prim).GetAxisAttr().Get())]
        )
    free = [name for name in _FREEDOMS if not _is_locked(prim, name)]
    if not free:
        return JointKind("fixed")
    if len(free) == 1:
        axis = _AXES[free[0][-1]]
        return JointKind("prismatic" if free[0].startswith("trans") else "revolute", axis, free[0])
    if len(free) == 6:
        return JointKind("floating")
    turns = [name for name in free if name.startswith("rot")]
    if len(free) == 3 and len(turns) == 3:
        return JointKind("ball")
    if len(free) == 3 and len(turns) == 1 and f"trans{turns[0][-1]}" not in free:
        return JointKind("planar", _AXES[turns[0][-1]])
    context.report_loss("joint-type", "joints with these degrees of freedom are fixed", prim)
    return JointKind("fixed")


def _is_locked(prim: Usd.Prim, name: str) -> bool:
    low = get_value(prim, f"limit:{name}:physics:low")
    high = get_value(prim, f"limit:{name}:physics:high")
    return low is not None and high is not None and low > high


def _read_bounds(prim: Usd.Prim) -> tuple[float, float]:
    lower, upper = get_value(prim, "physics:lowerLimit"), get_value(prim, "physics:upperLimit")
    return -math.inf if lower is None else lower, math.inf if upper is None else upper


def add_motion(context: Context, prim: Usd.Prim, joint: Joint) -> None:
    """Add limits, dynamics, mimic and drive of a joint with one position."""
    if joint.type not in ("revolute", "continuous", "prismatic"):
        return
    angular = joint.type != "prismatic"
    unit = math.radians(1.0) if angular else context.length
    force = context.mass * context.length * (context.length if angular else 1.0)
    kind = "angular" if angular else "linear"
    lower, upper = _read_bounds(prim)
    effort = get_value(prim, f"drive:{kind}:physics:maxForce")
    velocity = get_value(
        prim,
        "newton:velocityLimit",
        f"physxJointAxis:{kind}:maxJointVelocity",
        "physxJoint:maxJointVelocity",
    )
    limit = Limit(
        context.get_written(prim, "physics:lowerLimit"),
        convert_float(lower, unit) if math.isfinite(lower) else None,
        convert_float(upper, unit) if math.isfinite(upper) else None,
        convert_float(effort, force) if effort is not None and math.isfinite(effort) else None,
        convert_float(velocity, unit) if velocity is not None and math.isfinite(velocity) else None,
    )
    if any(value is not None for value in (limit.lower, limit.upper, limit.effort, limit.velocity)):
        joint.limit = limit
    joint.dynamics = _read_dynamics(context, prim, kind, force)
    joint.mimic = _read_mimic(context, prim, unit)


def _read_dynamics(context: Context, prim: Usd.Prim, kind: str, force: float) -> Dynamics | None:
    per = math.degrees(1.0) if kind == "angular" else 1.0 / context.length
    damping = get_value(prim, "newton:damping", f"physxJointAxis:{kind}:viscousFrictionCoefficient")
    friction = get_value(prim, "newton:friction", f"physxJointAxis:{kind}:staticFrictionEffort")
    armature = get_value(
        prim, "newton:armature", f"physxJointAxis:{kind}:armature", "physxJoint:armature"
    )
    if damping is None and friction is None and armature is None:
        return None
    inertia = force if kind == "angular" else context.mass
    return Dynamics(
        context.get_written(prim),
        None if damping is None else convert_float(damping, force * per),
        None if friction is None else convert_float(friction, force),
        None if armature is None else convert_float(armature, inertia),
    )


def _read_mimic(context: Context, prim: Usd.Prim, unit: float) -> Mimic | None:
    """Return what a joint follows; attributes of Newton are read before those of PhysX."""
    if has_schema(prim, "NewtonMimicAPI"):
        targets = get_targets(prim, "newton:mimicJoint")
        factor, offset = get_value(prim, "newton:mimicCoef1"), get_value(prim, "newton:mimicCoef0")
        scale = 1.0 if factor is None else convert_float(factor)
        return _follow(context, prim, targets, scale, convert_float(offset or 0.0, unit))
    for axis in ("rotX", "rotY", "rotZ"):
        name = f"physxMimicJoint:{axis}"
        if has_schema(prim, f"PhysxMimicJointAPI:{axis}"):
            targets = get_targets(prim, f"{name}:referenceJoint")
            gearing, offset = get_value(prim, f"{name}:gearing"), get_value(prim, f"{name}:offset")
            if offset:
                text = "offsets of PhysxMimicJointAPI, whose unit is not documented, are degrees"
                context.report_loss("mimic-offset", text, prim, Severity.INFO)
            scale = -(1.0 if gearing is None else gearing)
            return _follow(context, prim, targets, scale, -convert_float(offset or 0.0, unit))
    return None


def _follow(
    context: Context, prim: Usd.Prim, targets: list[str], factor: float, offset: float
) -> Mimic | None:
    leader = context.stage.GetPrimAtPath(targets[0]) if targets else None
    if not leader:
        context.report_loss("mimic", "joints that follow no joint are independent", prim)
        return None
    stored = leader.GetCustomDataByKey("urdf:joint") or leader.GetDisplayName()
    return Mimic(context.get_written(prim), str(stored or leader.GetName()), factor, offset)


def read_actuator(context: Context, prim: Usd.Prim, joint: Joint) -> JointActuator | None:
    """Return the drive of a joint as an actuator; None if its gains are zero."""
    angular = joint.type != "prismatic"
    kind = "angular" if angular else "linear"
    stiffness = get_value(prim, f"drive:{kind}:physics:stiffness") or 0.0
    damping = get_value(prim, f"drive:{kind}:physics:damping") or 0.0
    if not stiffness and not damping:
        return None
    force = context.mass * context.length * (context.length if angular else 1.0)
    factor = force * (math.degrees(1.0) if angular else 1.0 / context.length)
    mode = "position" if stiffness else "velocity"
    gain = stiffness if stiffness else damping
    effort = joint.limit.effort if joint.limit is not None else None
    return JointActuator(
        context.get_written(prim),
        joint.name,
        joint.name,
        mode,
        gain=gain * factor,
        bias=(0.0, -stiffness * factor, -damping * factor),
        force_range=None if effort is None else (-effort, effort),
    )
