"""Mass properties of bodies."""

from __future__ import annotations

from pxr import Usd, UsdPhysics

from ...mechanics.tensor import rotate_tensor
from ...model.elements import Inertia, Inertial
from ...model.part import Vector
from ...model.pose import Pose, get_origin_at, rotation_from_quaternion
from .read_stage import Context, convert_float, has_schema


def read_inertial(context: Context, prim: Usd.Prim) -> Inertial | None:
    """Return the mass properties of a body as written, in the frame of its link."""
    mass = UsdPhysics.MassAPI(prim) if prim.HasAPI(UsdPhysics.MassAPI) else None
    value = mass.GetMassAttr().Get() if mass else 0.0
    if mass is None or not value or value < 0:
        context.report_loss(
            "mass", "bodies without mass, which simulators compute, have none", prim
        )
        return None
    written = context.get_written(prim, "physics:mass")
    center = mass.GetCenterOfMassAttr().Get()
    if not all(abs(part) < 1e30 for part in center):
        text = "centers of mass that simulators compute from collision geometry are the origin"
        context.report_loss("center-of-mass", text, prim)
        center = (0.0, 0.0, 0.0)
    x, y, z = (convert_float(part, context.length) for part in center)
    shift = context.shifts.get(str(prim.GetPath()), Pose())
    place = context.get_written(prim, "physics:centerOfMass")
    origin = get_origin_at(shift.invert() @ Pose(translation=(x, y, z)), place)
    unit = context.mass * context.length * context.length
    six = _read_tensor(context, prim, mass)
    name = "newton:inertia" if has_schema(prim, "NewtonMassAPI") else "physics:diagonalInertia"
    tensor = context.get_written(prim, name)
    inertia = None if six is None else Inertia(tensor, *(part * unit for part in six))
    return Inertial(written, origin, convert_float(value, context.mass), inertia)


def _read_tensor(
    context: Context, prim: Usd.Prim, mass: UsdPhysics.MassAPI
) -> tuple[float, float, float, float, float, float] | None:
    """Return ixx, ixy, ixz, iyy, iyz, izz along the axes of the body; None if not written."""
    attribute = prim.GetAttribute("newton:inertia")
    if (
        has_schema(prim, "NewtonMassAPI")
        and attribute
        and attribute.Get()
        and len(attribute.Get()) == 6
    ):
        xx, yy, zz, xy, xz, yz = map(float, attribute.Get())
        return xx, xy, xz, yy, yz, zz
    moments: Vector = tuple(map(float, mass.GetDiagonalInertiaAttr().Get()))  # type: ignore[assignment]
    if not any(moments):
        context.report_loss("inertia", "inertia that simulators compute is not read", prim)
        return None
    axes = mass.GetPrincipalAxesAttr().Get()
    i, j, k = axes.GetImaginary()
    turn = rotation_from_quaternion((float(axes.GetReal()), float(i), float(j), float(k)))
    a, b, c = moments
    return rotate_tensor((a, 0.0, 0.0, b, 0.0, c), turn)
