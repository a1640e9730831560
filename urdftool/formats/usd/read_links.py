"""Mass properties of bodies."""

from __future__ import annotations

import math

from pxr import Usd, UsdPhysics

from ...mechanics.tensor import SymmetricTensor, rotate_tensor
from ...model.elements import Inertia, Inertial
from ...model.pose import Pose, get_origin_at, rotation_from_quaternion
from ..reading import LARGEST
from .read_stage import NO_TURN, Context, convert_float, has_schema, scale_point

_COMPUTED = (-math.inf, -math.inf, -math.inf)
"""Center of mass that is not written."""

_ALIKE = 1e-5
"""Difference of two tensors of one body, relative to the trace, that the rounding of moments and
axes to 32-bit floats explains. Chosen, no source."""


def read_inertial(context: Context, prim: Usd.Prim) -> Inertial | None:
    """Return the mass properties of a body as written, in the frame of its link."""
    mass = UsdPhysics.MassAPI(prim) if prim.HasAPI(UsdPhysics.MassAPI) else None
    value = context.get_value(prim, "physics:mass") if mass else None
    if mass is None or not value or value < 0:
        context.report_loss(
            "mass", "bodies without mass, which simulators compute, have none", prim
        )
        return None
    context.check_finite(prim, "physics:mass", (value,))
    written = context.get_written(prim, "physics:mass")
    center = context.get_vector(prim, "physics:centerOfMass", _COMPUTED)
    if not all(abs(part) < LARGEST for part in center):
        text = "centers of mass that simulators compute from collision geometry are the origin"
        context.report_loss("center-of-mass", text, prim)
        center = (0.0, 0.0, 0.0)
    center = scale_point(context.get_scale(prim), center)
    x, y, z = (convert_float(part, context.length) for part in center)
    shift = context.shifts.get(str(prim.GetPath()), Pose())
    place = context.get_written(prim, "physics:centerOfMass")
    origin = get_origin_at(shift.invert() @ Pose(translation=(x, y, z)), place)
    unit = context.mass * context.length * context.length
    six = _read_tensor(context, prim)
    name = "newton:inertia" if has_schema(prim, "NewtonMassAPI") else "physics:diagonalInertia"
    tensor = context.get_written(prim, name)
    inertia = None if six is None else Inertia(tensor, *(part * unit for part in six))
    return Inertial(written, origin, convert_float(value, context.mass), inertia)


def _read_tensor(context: Context, prim: Usd.Prim) -> SymmetricTensor | None:
    """Return ixx, ixy, ixz, iyy, iyz, izz along the axes of the body; None if not written."""
    six = _read_newton_tensor(context, prim)
    if six is not None:
        if names := find_contradicting_inertia(context, prim):
            context.report_contradiction(prim, names[1], dict.fromkeys(names, ""))
        return six
    six = _read_diagonal_tensor(context, prim)
    if six is None:
        context.report_loss("inertia", "inertia that simulators compute is not read", prim)
    return six


def find_contradicting_inertia(context: Context, prim: Usd.Prim) -> tuple[str, ...]:
    """Return the attributes for Newton and for PhysX if their tensors differ; nothing otherwise."""
    one, two = _read_newton_tensor(context, prim), _read_diagonal_tensor(context, prim)
    if one is None or two is None:
        return ()
    trace = abs(one[0] + one[3] + one[5])
    largest = max(abs(a - b) for a, b in zip(one, two, strict=True))
    return ("newton:inertia", "physics:diagonalInertia") if largest > _ALIKE * trace else ()


def _read_newton_tensor(context: Context, prim: Usd.Prim) -> SymmetricTensor | None:
    if not (has_schema(prim, "NewtonMassAPI") and prim.GetAttribute("newton:inertia")):
        return None
    six = context.get_vector(prim, "newton:inertia", (0.0,) * 6)
    context.check_finite(prim, "newton:inertia", six)
    xx, yy, zz, xy, xz, yz = six
    return (xx, xy, xz, yy, yz, zz) if any(six) else None


def _read_diagonal_tensor(context: Context, prim: Usd.Prim) -> SymmetricTensor | None:
    moments = context.get_vector(prim, "physics:diagonalInertia", (0.0, 0.0, 0.0))
    if not any(moments):
        return None
    context.check_finite(prim, "physics:diagonalInertia", moments)
    axes = context.get_vector(prim, "physics:principalAxes", NO_TURN)
    context.check_finite(prim, "physics:principalAxes", axes)
    w, x, y, z = axes
    a, b, c = moments
    return rotate_tensor((a, 0.0, 0.0, b, 0.0, c), rotation_from_quaternion((w, x, y, z)))
