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
    Mesh,
    Origin,
    Plane,
    Robot,
    Sphere,
    Visual,
)
from ...model.pose import IDENTITY, Pose, get_origin_at
from ...model.provenance import Written
from ...model.shapes import PLANE_SIZE
from .read_materials import read_material, read_surface
from .read_mesh import MeshFolder, Triangles, read_triangles
from .read_stage import Context, compute_pose

Array = npt.NDArray[np.float64]

_TURNS = {
    "X": Pose(((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0))),
    "Y": Pose(((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))),
    "Z": IDENTITY,
}
"""Rotation of a shape along z to each axis."""

_EVEN = 1e-6
"""Relative difference of scale factors that counts as equal. Chosen, no source."""


def add_shapes(context: Context, robot: Robot, folder: MeshFolder) -> None:
    """Add the visible shapes and the collision shapes of every body and frame."""
    for prim in context.iterate_prims():
        if not prim.IsA(UsdGeom.Gprim) or context.is_of_other(prim):
            continue
        owner = _find_owner(context, prim)
        collides = _is_collider(prim)
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


def _is_collider(prim: Usd.Prim) -> bool:
    """Tell whether a prim is enabled collision geometry."""
    if not prim.HasAPI(UsdPhysics.CollisionAPI):
        return False
    return UsdPhysics.CollisionAPI(prim).GetCollisionEnabledAttr().Get() is not False


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
    if context.has_zero_scale(prim):
        context.report_loss("shape", "shapes with a scale of zero are left out", prim)
        return
    frame = context.get_pose(context.stage.GetPrimAtPath(owner))
    shift = context.shifts.get(owner, IDENTITY)
    matrix = context.get_matrix(prim)
    pose = shift.invert() @ frame.invert() @ compute_pose(matrix, context.length)
    linear = np.array([[matrix[row][column] for row in range(3)] for column in range(3)])
    residual = np.array(compute_pose(matrix).rotation).T @ linear
    written = context.get_written(prim)
    name = str(prim.GetCustomDataByKey("urdf:shape") or "") or None
    drawn, collides = roles
    if prim.IsA(UsdGeom.Mesh):
        _add_mesh(context, prim, link, residual, get_origin_at(pose, written), folder, roles)
        return
    for size in ("size", "radius", "height"):
        if attribute := prim.GetAttribute(size):
            context.check_finite(prim, size, (attribute.Get(),))
    geometry, turn = _read_geometry(prim, residual, context.length, written)
    if geometry is None:
        context.report_loss("shape", f"shapes of type {prim.GetTypeName()} are not read", prim)
        return
    origin = get_origin_at(pose @ turn, written)
    if drawn:
        material = read_material(context, prim, folder, has_coordinates=False)
        link.visuals.append(Visual(written, name, origin, geometry, material))
    if collides:
        link.collisions.append(
            Collision(written, name, origin, geometry, read_surface(context, prim))
        )


def _add_mesh(
    context: Context,
    prim: Usd.Prim,
    link: Link,
    residual: Array,
    origin: Origin,
    folder: MeshFolder,
    roles: tuple[bool, bool],
) -> None:
    """Add a mesh; subsets of its faces with materials of their own become visuals."""
    triangles = read_triangles(prim, residual, context.length)
    written = context.get_written(prim)
    if triangles is None:
        context.report_loss("shape", "meshes without faces, or with invalid points, are left out",
                            prim)  # fmt: skip
        return
    name = str(prim.GetCustomDataByKey("urdf:shape") or "") or None
    start = f"{link.name}_{prim.GetName()}"
    drawn, collides = roles
    for part, some in _split_subsets(prim, triangles) if drawn else ():
        mapped = some.coordinates is not None
        material = read_material(context, part, folder, has_coordinates=mapped)
        textured = material is not None and material.texture is not None
        mesh = Mesh(written, folder.store(some, start, textured=textured))
        link.visuals.append(Visual(written, name, origin, mesh, material))
    if collides:
        _report_approximation(context, prim)
        mesh = Mesh(written, folder.store(triangles, start, textured=False))
        link.collisions.append(Collision(written, name, origin, mesh, read_surface(context, prim)))


def _split_subsets(prim: Usd.Prim, triangles: Triangles) -> list[tuple[Usd.Prim, Triangles]]:
    """Return the parts of a mesh with a material each, and the prims that the materials are of."""
    parts = []
    rest = np.ones(len(triangles.faces), dtype=bool)
    for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
        chosen = np.isin(triangles.faces, np.array(subset.GetIndicesAttr().Get() or [], dtype=int))
        chosen &= rest
        rest &= ~chosen
        if chosen.any():
            parts.append((subset.GetPrim(), triangles.select(chosen)))
    if not parts:
        return [(prim, triangles)]
    return [*parts, (prim, triangles.select(rest))] if rest.any() else parts


def _report_approximation(context: Context, prim: Usd.Prim) -> None:
    """Report that simulators use another shape than the mesh, unless urdftool wrote the stage."""
    if context.is_ours or not prim.HasAPI(UsdPhysics.MeshCollisionAPI):
        return
    kind = UsdPhysics.MeshCollisionAPI(prim).GetApproximationAttr().Get()
    if kind not in (None, UsdPhysics.Tokens.none):
        text = "collision meshes that simulators approximate are read as their triangles"
        context.report_loss("approximation", text, prim, Severity.INFO)


def _read_geometry(
    prim: Usd.Prim, residual: Array, length: float, written: Written
) -> tuple[Geometry | None, Pose]:
    """Return the geometry of a prim, and its rotation in the frame of the prim."""
    scale = np.abs(np.diag(residual)) * length
    if np.abs(residual - np.diag(np.diag(residual))).max() > _EVEN * scale.max():
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
        turn = _TURNS[str(UsdGeom.Plane(prim).GetAxisAttr().Get())]
        return Plane(written, _read_extent(UsdGeom.Plane(prim), scale)), turn
    return _read_round(prim, scale, written)


def _read_extent(plane: UsdGeom.Plane, scale: Array) -> tuple[float, float] | None:
    """Return where a plane with the normal z is drawn [m]; None if it is not limited there."""
    sides = plane.GetWidthAttr(), plane.GetLengthAttr()
    if plane.GetAxisAttr().Get() != UsdGeom.Tokens.z or not all(s.IsAuthored() for s in sides):
        return None
    width, length = (float(side.Get()) for side in sides)
    if width == length == PLANE_SIZE:
        return None
    return width * float(scale[0]), length * float(scale[1])


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
