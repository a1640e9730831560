"""Geometry of a stage as visuals and collisions of links."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from pxr import Usd, UsdGeom, UsdPhysics, UsdShade

from ...diagnostic import Severity
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Material,
    Mesh,
    Plane,
    Robot,
    Sphere,
    Visual,
)
from ...model.pose import IDENTITY, Pose, get_origin_at
from ...model.provenance import Written
from .read_mesh import MeshFolder, read_triangles
from .read_stage import Context, compute_pose

Array = npt.NDArray[np.float64]

_TURNS = {
    "X": Pose(((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0))),
    "Y": Pose(((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))),
    "Z": IDENTITY,
}
"""Rotation of a shape along z to each axis."""

_EVEN = 1e-6
"""Relative difference of scale factors that counts as equal."""


def add_shapes(context: Context, robot: Robot, folder: MeshFolder) -> None:
    """Add the visible shapes and the collision shapes of every body and frame."""
    for prim in context.iterate_prims():
        if not prim.IsA(UsdGeom.Gprim):
            continue
        owner = _find_owner(context, prim)
        collides = prim.HasAPI(UsdPhysics.CollisionAPI)
        imageable = UsdGeom.Imageable(prim)
        drawn = imageable.ComputeVisibility() != UsdGeom.Tokens.invisible
        drawn = drawn and imageable.ComputePurpose() in ("default", "render")
        if not drawn and not collides:
            continue
        if owner is None:
            context.report_loss("scenery", "shapes without a body are scenery", prim, Severity.INFO)
            continue
        _add_shape(
            context, prim, robot.link[context.names[owner]], owner, folder, (drawn, collides)
        )


def _find_owner(context: Context, prim: Usd.Prim) -> str | None:
    """Return the path of the body or frame that has a prim; None if none has."""
    while prim:
        if str(prim.GetPath()) in context.names:
            return str(prim.GetPath())
        prim = prim.GetParent()
    return None


def _add_shape(
    context: Context,
    prim: Usd.Prim,
    link: Link,
    owner: str,
    folder: MeshFolder,
    roles: tuple[bool, bool],
) -> None:
    frame = context.get_pose(context.stage.GetPrimAtPath(owner))
    shift = context.shifts.get(owner, IDENTITY)
    matrix = context.get_matrix(prim)
    pose = shift.invert() @ frame.invert() @ compute_pose(matrix, context.length)
    linear = np.array([[matrix[row][column] for row in range(3)] for column in range(3)])
    rigid = np.array(compute_pose(matrix).rotation)
    written = context.get_written(prim)
    geometry, turn = _read_geometry(context, prim, rigid.T @ linear, written, folder)
    if geometry is None:
        context.report_loss("shape", f"shapes of type {prim.GetTypeName()} are not read", prim)
        return
    origin = get_origin_at(pose @ turn, written)
    name = str(prim.GetCustomDataByKey("urdf:shape") or "") or None
    drawn, collides = roles
    if drawn:
        link.visuals.append(Visual(written, name, origin, geometry, _read_material(context, prim)))
    if collides:
        link.collisions.append(Collision(written, name, origin, geometry))


def _read_geometry(
    context: Context, prim: Usd.Prim, residual: Array, written: Written, folder: MeshFolder
) -> tuple[Geometry | None, Pose]:
    """Return the geometry of a prim, and its rotation in the frame of the prim."""
    scale = np.abs(np.diag(residual)) * context.length
    sheared = np.abs(residual - np.diag(np.diag(residual))).max() > _EVEN * scale.max()
    if prim.IsA(UsdGeom.Mesh):
        triangles = read_triangles(prim, residual, context.length)
        if triangles is None:
            return None, IDENTITY
        return Mesh(written, folder.store(triangles)), IDENTITY
    if sheared:
        return None, IDENTITY
    if prim.IsA(UsdGeom.Cube):
        x, y, z = (float(UsdGeom.Cube(prim).GetSizeAttr().Get()) * scale).tolist()
        return Box(written, (x, y, z)), IDENTITY
    if prim.IsA(UsdGeom.Sphere):
        x, y, z = (float(UsdGeom.Sphere(prim).GetRadiusAttr().Get()) * scale).tolist()
        if max(x, y, z) - min(x, y, z) <= _EVEN * max(x, y, z):
            return Sphere(written, x), IDENTITY
        return Ellipsoid(written, (x, y, z)), IDENTITY
    if prim.IsA(UsdGeom.Plane):
        return Plane(written), _TURNS[str(UsdGeom.Plane(prim).GetAxisAttr().Get())]
    return _read_round(prim, scale, written)


def _read_round(prim: Usd.Prim, scale: Array, written: Written) -> tuple[Geometry | None, Pose]:
    """Return a cylinder, capsule or cone; None for another shape or unequal scales."""
    for schema, make in (
        (UsdGeom.Cylinder, Cylinder),
        (UsdGeom.Capsule, Capsule),
        (UsdGeom.Cone, Cone),
    ):
        if not prim.IsA(schema):
            continue
        shape = schema(prim)
        axis = str(shape.GetAxisAttr().Get())
        along = "XYZ".index(axis)
        across = np.delete(scale, along)
        if abs(across[0] - across[1]) > _EVEN * across.max():
            return None, IDENTITY
        radius = float(shape.GetRadiusAttr().Get()) * float(across[0])
        height = float(shape.GetHeightAttr().Get()) * float(scale[along])
        return make(written, radius, height), _TURNS[axis]
    return None, IDENTITY


def _read_material(context: Context, prim: Usd.Prim) -> Material | None:
    """Return the color or texture of a prim; None without one."""
    bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    if not bound:
        return None
    surface, _, _ = bound.ComputeSurfaceSource()
    if not surface:
        return None
    written, name = context.get_written(bound.GetPrim()), bound.GetPrim().GetName()
    color = surface.GetInput("diffuseColor")
    if color and color.HasConnectedSource():
        context.report_loss("texture", "textures are not read", bound.GetPrim(), Severity.INFO)
        return None
    if not color or color.Get() is None:
        return None
    opacity = surface.GetInput("opacity")
    alpha = opacity.Get() if opacity else None
    red, green, blue = (_encode(float(part)) for part in color.Get())
    return Material(written, name, (red, green, blue, 1.0 if alpha is None else float(alpha)))


def _encode(value: float) -> float:
    """Convert linear light to a component of an sRGB color."""
    value = min(max(value, 0.0), 1.0)
    return 12.92 * value if value <= 0.0031308 else float(1.055 * value ** (1 / 2.4) - 0.055)
