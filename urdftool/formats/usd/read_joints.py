"""Types, limits, drives and dynamics of joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from pxr import Usd, UsdPhysics

from ...diagnostic import Severity
from ...model.drives import GAINS
from ...model.elements import Dynamics, Joint, Limit, Mimic, Vector
from ...model.kinematics import MOVABLE
from ...model.mechanism import JointActuator
from ...model.settings import RESISTANCE
from .read_stage import ROUNDING, Context, convert_float, get_targets, has_schema

_AXES: dict[str, Vector] = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}

_FREEDOMS = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")


class JointKind(NamedTuple):
    """Type of a joint in URDF, and its axis in the frame of the joint."""

    type: str
    axis: Vector = (1.0, 0.0, 0.0)
    freedom: str = ""


class NamedJoint(NamedTuple):
    """A joint of a stage that is one of the robot, or closes a loop of it.

    Attributes:
        prim: Its prim.
        name: Its name in the robot.
        kind: Its type.
        start: How the stage shows its child moved in the frame of the joint, as text: three
            lengths [m] and a quaternion (w, x, y, z); empty at zero.
    """

    prim: Usd.Prim
    name: str
    kind: JointKind
    start: str = ""


def find_kind(context: Context, prim: Usd.Prim) -> JointKind:
    """Determine the type of a joint."""
    if prim.IsA(UsdPhysics.FixedJoint):
        return JointKind("fixed")
    if prim.IsA(UsdPhysics.SphericalJoint):
        return JointKind("ball")
    if prim.IsA(UsdPhysics.RevoluteJoint):
        axis = _read_axis(context, prim)
        lower, upper = _read_bounds(context, prim)
        limited = math.isfinite(lower) or math.isfinite(upper)
        return JointKind("revolute" if limited else "continuous", axis)
    if prim.IsA(UsdPhysics.PrismaticJoint):
        return JointKind("prismatic", _read_axis(context, prim))
    free = [name for name in _FREEDOMS if not _is_locked(context, prim, name)]
    if not free:
        return JointKind("fixed")
    if len(free) == 1:
        axis, bounds = _AXES[free[0][-1]], _read_bounds(context, prim, free[0])
        if free[0].startswith("trans"):
            return JointKind("prismatic", axis, free[0])
        kind = "revolute" if any(math.isfinite(bound) for bound in bounds) else "continuous"
        return JointKind(kind, axis, free[0])
    if len(free) == 6:
        return JointKind("floating")
    turns = [name for name in free if name.startswith("rot")]
    if len(free) == 3 and len(turns) == 3:
        return JointKind("ball")
    if len(free) == 3 and len(turns) == 1 and f"trans{turns[0][-1]}" not in free:
        return JointKind("planar", _AXES[turns[0][-1]])
    context.report_loss("joint-type", "joints with these degrees of freedom are fixed", prim)
    return JointKind("fixed")


def _read_axis(context: Context, prim: Usd.Prim) -> Vector:
    """Return the axis of a revolute or prismatic joint in the frame of the joint.

    Raises:
        ModelError: It is none of X, Y and Z.
    """
    axis = str(prim.GetAttribute("physics:axis").Get())
    if axis not in _AXES:
        raise context.make_error(prim, "physics:axis", f"must be X, Y or Z, but is {axis}")
    return _AXES[axis]


def _is_locked(context: Context, prim: Usd.Prim, name: str) -> bool:
    low = context.get_value(prim, f"limit:{name}:physics:low")
    high = context.get_value(prim, f"limit:{name}:physics:high")
    return low is not None and high is not None and low > high


def _read_bounds(context: Context, prim: Usd.Prim, freedom: str = "") -> tuple[float, float]:
    """Return the lower and upper limit; those of one freedom of a joint without a fixed type."""
    names = (
        (f"limit:{freedom}:physics:low", f"limit:{freedom}:physics:high")
        if freedom
        else ("physics:lowerLimit", "physics:upperLimit")
    )
    lower, upper = (context.get_value(prim, name) for name in names)
    return -math.inf if lower is None else lower, math.inf if upper is None else upper


@dataclass(frozen=True)
class Units:
    """Names and units of the attributes of a joint.

    Attributes:
        name: Instance of the schemas of drives and axes: ``angular``, ``linear`` or ``rotX``.
        position: Radians or meters in a unit of position.
        force: Newton meters or newtons in a unit of force.
        inertia: Kilogram square meters or kilograms in a unit of armature.
        rate: Factor of a value per unit of velocity to one per rad/s or m/s.
        by_radian: The same for attributes of MuJoCo, which are not per degree.
    """

    name: str
    position: float
    force: float
    inertia: float
    rate: float
    by_radian: float


def find_units(context: Context, kind: JointKind) -> Units:
    """Return names and units of the attributes of a joint with one freedom."""
    freedom, torque = kind.freedom, context.mass * context.length * context.length
    if kind.type == "prismatic":
        force = context.mass * context.length
        rate = force / context.length
        return Units(freedom or "linear", context.length, force, context.mass, rate, rate)
    rate = torque * math.degrees(1.0)
    return Units(freedom or "angular", math.radians(1.0), torque, torque, rate, torque)


def add_motion(context: Context, prim: Usd.Prim, joint: Joint, freedom: str) -> None:
    """Add limits, dynamics, mimic and drive of a joint with one position."""
    if joint.type not in MOVABLE:
        return
    units = find_units(context, JointKind(joint.type, freedom=freedom))
    lower, upper = _read_bounds(context, prim, freedom)
    effort = _read_effort(context, prim, units)
    velocity = context.get_value(
        prim,
        "newton:velocityLimit",
        f"physxJointAxis:{units.name}:maxJointVelocity",
        "physxJoint:maxJointVelocity",
    )
    bounds = _convert_bound(lower, units.position), _convert_bound(upper, units.position)
    largest = _convert_bound(effort, units.force), _convert_bound(velocity, units.position)
    if any(value is not None for value in (*bounds, *largest)):
        if joint.type != "continuous":
            low, high = bounds
            bounds = -math.inf if low is None else low, math.inf if high is None else high
        written = context.get_written(prim, "physics:lowerLimit")
        joint.limit = Limit(written, *bounds, *largest)
    joint.dynamics = _read_dynamics(context, prim, units)
    joint.mimic = _read_mimic(context, prim, units)


def _convert_bound(value: float | None, unit: float) -> float | None:
    """Convert a limit; None for one that is absent or infinite."""
    return convert_float(value, unit) if value is not None and math.isfinite(value) else None


def _read_effort(context: Context, prim: Usd.Prim, units: Units) -> float | None:
    """Return the largest force or torque, of the drive or of MuJoCo; None without a limit."""
    driven = has_drive(prim, units.name)
    effort = context.get_value(prim, f"drive:{units.name}:physics:maxForce") if driven else None
    lower, upper = (
        context.get_value(prim, f"mjc:actuatorfrcrange:{end}") or 0.0 for end in ("min", "max")
    )
    limited = prim.GetAttribute("mjc:actuatorfrclimited")
    if effort is not None or lower >= upper or (limited and limited.Get() == "false"):
        return effort
    return max(abs(lower), abs(upper))


def _read_dynamics(context: Context, prim: Usd.Prim, units: Units) -> Dynamics | None:
    values: dict[str, float] = {}
    known = {"friction": units.force, "armature": units.inertia}
    for row in RESISTANCE:
        names = (row.usd, *(name.replace("*", units.name) for name in row.physx))
        value, unit = context.get_value(prim, *names), known.get(row.name, units.rate)
        if value is None:  # of MuJoCo's schema, whose rate is by radian
            value = context.get_value(prim, f"mjc:{row.mjcf_attribute}")
            unit = known.get(row.name, units.by_radian)
        if value is not None:
            values[row.name] = convert_float(value, unit)
    return Dynamics(context.get_written(prim), **values) if values else None


def _read_mimic(context: Context, prim: Usd.Prim, units: Units) -> Mimic | None:
    """Return what a joint follows; Newton comes before PhysX, which comes before MuJoCo."""
    if has_schema(prim, "NewtonMimicAPI") and get_targets(prim, "newton:mimicJoint"):
        enabled = prim.GetAttribute("newton:mimicEnabled")
        if enabled and enabled.Get() is False:
            context.report_loss("mimic", "joints whose mimic is disabled are independent", prim)
            return None
        factor = context.get_value(prim, "newton:mimicCoef1")
        offset = context.get_value(prim, "newton:mimicCoef0") or 0.0
        scale = 1.0 if factor is None else convert_float(factor)
        targets = get_targets(prim, "newton:mimicJoint")
        _check_physx_mimic(context, prim, targets, scale)
        return _follow(context, prim, targets, scale, convert_float(offset, units.position))
    for axis in _FREEDOMS:
        name = f"physxMimicJoint:{axis}"
        if has_schema(prim, f"PhysxMimicJointAPI:{axis}"):
            gearing = context.get_value(prim, f"{name}:gearing")
            offset = context.get_value(prim, f"{name}:offset") or 0.0
            if offset and axis.startswith("rot"):
                text = "offsets of PhysxMimicJointAPI, whose unit is not documented, are degrees"
                context.report_loss("mimic-offset", text, prim, Severity.INFO)
            scale = -(1.0 if gearing is None else convert_float(gearing))
            targets = get_targets(prim, f"{name}:referenceJoint")
            return _follow(context, prim, targets, scale, -convert_float(offset, units.position))
    if has_schema(prim, "MjcEqualityJointAPI"):
        targets = get_targets(prim, "newton:mimicJoint") or get_targets(prim, "mjc:target")
        factor = context.get_value(prim, "newton:mimicCoef1", "mjc:coef1")
        offset = context.get_value(prim, "mjc:coef0") or 0.0
        scale = 1.0 if factor is None else convert_float(factor)
        unit = context.length if units.name == "linear" else 1.0
        return _follow(context, prim, targets, scale, convert_float(offset, unit))
    return None


def _check_physx_mimic(context: Context, prim: Usd.Prim, targets: list[str], factor: float) -> None:
    """Report a mimic joint of PhysX with another leader or factor than Newton's.

    Offsets are not compared, since the unit of PhysX's is not documented.
    """
    for axis in _FREEDOMS:
        name = f"physxMimicJoint:{axis}"
        if not has_schema(prim, f"PhysxMimicJointAPI:{axis}"):
            continue
        gearing = context.get_value(prim, f"{name}:gearing")
        other = -(1.0 if gearing is None else convert_float(gearing))
        leader = get_targets(prim, f"{name}:referenceJoint")
        if leader != targets:
            values = (", ".join(targets), ", ".join(leader) or "none")
            names = "newton:mimicJoint", f"{name}:referenceJoint"
            context.report_contradiction(prim, names[1], dict(zip(names, values, strict=True)))
        elif not math.isclose(factor, other, rel_tol=ROUNDING):
            values = (f"{factor:g}", f"{-other:g}")
            names = "newton:mimicCoef1", f"{name}:gearing"
            context.report_contradiction(prim, names[1], dict(zip(names, values, strict=True)))


def _follow(
    context: Context, prim: Usd.Prim, targets: list[str], factor: float, offset: float
) -> Mimic | None:
    leader = context.stage.GetPrimAtPath(targets[0]) if targets else None
    if not leader:
        context.report_loss("mimic", "joints that follow no joint are independent", prim)
        return None
    stored = leader.GetCustomDataByKey("urdf:joint") or leader.GetDisplayName()
    return Mimic(context.get_written(prim), str(stored or leader.GetName()), factor, offset)


def has_drive(prim: Usd.Prim, axis: str) -> bool:
    """Tell whether simulators make a drive of the attributes of an axis, which a schema decides."""
    return bool(prim.HasAPI(UsdPhysics.DriveAPI, axis))


def read_actuator(
    context: Context, prim: Usd.Prim, joint: Joint, freedom: str
) -> JointActuator | None:
    """Return the drive of a joint as an actuator; None without one, or if its gains are zero."""
    if joint.type not in MOVABLE:
        return None
    units = find_units(context, JointKind(joint.type, freedom=freedom))
    if not has_drive(prim, units.name):
        return None
    kp, kd = (
        convert_float(context.get_value(prim, f"drive:{units.name}:physics:{gain}") or 0.0, rate)
        for gain, rate in zip(GAINS, (units.force / units.position, units.rate), strict=True)
    )
    if not kp and not kd:
        return None
    kind = prim.GetAttribute(f"drive:{units.name}:physics:type")
    if kind and kind.Get() == UsdPhysics.Tokens.acceleration:
        text = "drives of accelerations are read as drives of forces, as Newton does"
        context.report_loss("drive-type", text, prim)
    effort = joint.get_magnitude("effort")
    return JointActuator(
        context.get_written(prim, f"drive:{units.name}:physics:stiffness"),
        joint.name,
        joint.name,
        "position" if kp else "velocity",
        gain=kp or kd,
        bias=(0.0, -kp, -kd),
        force_range=None if effort is None else (-effort, effort),
    )
