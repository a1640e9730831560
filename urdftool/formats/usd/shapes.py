"""Visuals and collisions of links as prims."""

from __future__ import annotations

from dataclasses import dataclass

from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, Vt

from ...diagnostic import Severity
from ...geometry.tessellate import tessellate
from ...model.bounds import has_extent
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
    Plane,
    Sphere,
    Visual,
)
from ...model.pose import make_pose
from ...model.shapes import PLANE_SIZE, get_shape_name
from ..common.naming import UniqueNames
from ..written import Written
from .links import LinkWriter
from .materials import MaterialWriter
from .meshes import Meshes, approximate, make_collider, write_triangles
from .names import make_identifier
from .stage import GEOMETRY, PHYSICS, set_pose
from .surfaces import SurfaceWriter


@dataclass(frozen=True)
class ShapeWriter:
    """Writes the shapes of a robot."""

    links: LinkWriter
    meshes: Meshes
    materials: MaterialWriter
    surfaces: SurfaceWriter
    written: Written

    def write(self, link: Link) -> None:
        """Write the visuals and collisions of a link."""
        for scope, shapes in (("visuals", link.visuals), ("collisions", link.collisions)):
            names = UniqueNames()
            for shape in shapes:
                if shape.geometry is None:
                    continue
                stem = shape.name or get_shape_name(shape.geometry)
                path = self.links.get_path(link.name).AppendChild(scope)
                name = names.take(make_identifier(stem, "shape"))
                surface = None
                if isinstance(shape, Collision):
                    surface = self.surfaces.find_material(link, shape)
                shared = surface is None
                self._write_shape(link, shape, shape.geometry, path, name, is_shared=shared)
                if surface is not None:
                    self._bind_surface(path.AppendChild(name), surface)

    def _bind_surface(self, path: Sdf.Path, surface: UsdShade.Material) -> None:
        """Bind a physics material to the collider of a shape, which is below it for a mesh."""
        prim = self.links.builder.stage.GetPrimAtPath(path)
        if prim:
            for part in (prim, *prim.GetChildren()):
                if part.HasAPI(UsdPhysics.CollisionAPI):
                    self.surfaces.bind(part, surface)

    def _write_shape(
        self,
        link: Link,
        shape: Visual | Collision,
        geometry: Geometry,
        scope: Sdf.Path,
        name: str,
        *,
        is_shared: bool,
    ) -> None:
        if not isinstance(geometry, Plane) and not has_extent(geometry):
            self.written.report_loss(
                "shape",
                f"{get_shape_name(geometry)} of link '{link.name}' has a size of zero or less, and "
                "is left out",
                shape.place,
                kind="link",
                name=link.name,
            )
            return
        stage = self.links.builder.stage
        with self.links.builder.edit_layer(GEOMETRY):
            prim = self._create_geometry(scope, name, geometry, is_shared=is_shared)
        if prim is None:
            self.written.report_loss(
                "shape",
                f"{get_shape_name(geometry)} of link '{link.name}' is dropped",
                shape.place,
                kind="link",
                name=link.name,
            )
            return
        holder = stage.GetPrimAtPath(scope)
        if not holder.GetTypeName():
            UsdGeom.Xform.Define(stage, scope)
        with self.links.builder.edit_layer(GEOMETRY):
            scale = geometry.size if isinstance(geometry, Box) else None
            set_pose(prim, make_pose(shape.origin), scale)
        if isinstance(geometry, Ellipsoid):
            self.written.report_loss(
                "ellipsoid",
                f"an ellipsoid of link '{link.name}' is written as a mesh",
                shape.place,
                kind="link",
                name=link.name,
                severity=Severity.INFO,
            )
        if shape.name:
            prim.SetCustomDataByKey("urdf:shape", shape.name)
        if isinstance(shape, Visual):
            self._bind_material(prim, link, shape)
        elif not isinstance(geometry, Mesh):
            with self.links.builder.edit_layer(PHYSICS):
                make_collider(prim)
                if isinstance(geometry, Ellipsoid):
                    approximate(prim, UsdPhysics.Tokens.convexHull)

    def _create_geometry(
        self, scope: Sdf.Path, name: str, geometry: Geometry, *, is_shared: bool
    ) -> Usd.Prim | None:
        """Create the prim of a shape without its pose; None if it cannot be written."""
        stage, path = self.links.builder.stage, scope.AppendChild(name)
        if isinstance(geometry, Mesh):
            if id(geometry) not in self.meshes.uses:
                return None
            prim = UsdGeom.Xform.Define(stage, path).GetPrim()
            self.meshes.write(prim, geometry, is_shared=is_shared)
            return prim
        if isinstance(geometry, Ellipsoid):
            return write_triangles(stage, path, *tessellate("ellipsoid", geometry.radii, 48))
        return _create_primitive(stage, path, geometry)

    def _bind_material(self, prim: Usd.Prim, link: Link, visual: Visual) -> None:
        """Bind the material of a visual; colors in a mesh file take precedence, as in RViz."""
        look = self.materials.find_look(link, visual)
        if look is None:
            return
        if look.image is not None and not isinstance(visual.geometry, Mesh):
            self.written.report_loss(
                "texture",
                f"texture of material '{look.name}' is not shown on a primitive shape, which has "
                "no texture coordinates",
                visual.place,
                kind="material",
                name=look.name,
                severity=Severity.INFO,
            )
        self.materials.bind(prim, look, self.links.builder.root.AppendChild("materials"))


def _create_primitive(stage: Usd.Stage, path: Sdf.Path, geometry: Geometry) -> Usd.Prim | None:
    """Create the prim of a primitive; a box is a cube of edge 1 m, to be scaled."""
    shape: UsdGeom.Gprim
    if isinstance(geometry, Box):
        shape = UsdGeom.Cube.Define(stage, path)
        shape.CreateSizeAttr(1.0)
        half = (0.5, 0.5, 0.5)
    elif isinstance(geometry, Sphere):
        shape = UsdGeom.Sphere.Define(stage, path)
        shape.CreateRadiusAttr(geometry.radius)
        half = (geometry.radius,) * 3
    elif isinstance(geometry, (Cylinder, Capsule, Cone)):
        schema = {Cylinder: UsdGeom.Cylinder, Capsule: UsdGeom.Capsule, Cone: UsdGeom.Cone}
        shape = schema[type(geometry)].Define(stage, path)
        shape.CreateRadiusAttr(geometry.radius)
        shape.CreateHeightAttr(geometry.length)
        shape.CreateAxisAttr(UsdGeom.Tokens.z)
        cap = geometry.radius if isinstance(geometry, Capsule) else 0.0
        half = (geometry.radius, geometry.radius, geometry.length / 2 + cap)
    elif isinstance(geometry, Plane):
        shape = UsdGeom.Plane.Define(stage, path)
        width, length = geometry.size or (PLANE_SIZE, PLANE_SIZE)
        shape.CreateWidthAttr(width)
        shape.CreateLengthAttr(length)
        shape.CreateAxisAttr(UsdGeom.Tokens.z)
        half = (width / 2, length / 2, 0.0)
    else:
        return None
    low = Gf.Vec3f(*(-part for part in half))
    shape.CreateExtentAttr(Vt.Vec3fArray([low, Gf.Vec3f(*half)]))
    return shape.GetPrim()
