"""Bodies and frames of a stage, with mass and inertia."""

from __future__ import annotations

from dataclasses import dataclass

from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics

from ...model.elements import Link
from ...model.numbers import remove_noise
from ...model.pose import Pose
from .bodies import Bodies
from .inertials import BodyInertia
from .names import Names
from .stage import PHYSICS, StageBuilder, apply, compute_quaternion, set_pose, set_value, store_name


@dataclass(frozen=True)
class LinkWriter:
    """Writes the links of a robot."""

    builder: StageBuilder
    bodies: Bodies
    names: Names

    def get_path(self, link: str) -> Sdf.Path:
        """Return the path of a link's prim; a frame is below its body."""
        body = self.bodies.carrier[link]
        root = self.builder.root
        if body and body != link:
            root = root.AppendChild(self.names.link[body])
        return root.AppendChild(self.names.link[link])

    def write(self, inertias: dict[str, BodyInertia]) -> None:
        """Write all bodies, then the frames on them."""
        for link in self.bodies.links:
            prim = self._create_prim(link, self.bodies.poses[link.name])
            with self.builder.edit_layer(PHYSICS):
                UsdPhysics.RigidBodyAPI.Apply(prim)
                _set_mass(prim, inertias[link.name])
        for link in self.bodies.frames:
            pose = self.bodies.pose[link.name]
            at = pose if self.bodies.carrier[link.name] else self.bodies.root_pose @ pose
            self._create_prim(link, at)

    def _create_prim(self, link: Link, pose: Pose) -> Usd.Prim:
        prim = UsdGeom.Xform.Define(self.builder.stage, self.get_path(link.name)).GetPrim()
        set_pose(prim, pose)
        store_name(prim, "link", link.name)
        joint = self.bodies.robot.tree.get_parent_joint(link.name)
        is_frame = self.bodies.carrier[link.name] != link.name or link.name == self.bodies.base
        if joint is not None and (is_frame or joint.type == "floating"):
            kind = "floating" if joint.type == "floating" else "fixed"
            prim.SetCustomDataByKey(f"urdf:{kind}_joint", joint.name)
            prim.SetCustomDataByKey("urdf:parent", joint.parent)
        return prim


def _set_mass(prim: Usd.Prim, inertia: BodyInertia) -> None:
    """Write all four values of the schema: a reader computes each that is missing."""
    mass = UsdPhysics.MassAPI.Apply(prim)
    body = inertia.body
    mass.CreateMassAttr(body.mass)
    mass.CreateCenterOfMassAttr(Gf.Vec3f(*remove_noise(body.com)))
    mass.CreateDiagonalInertiaAttr(Gf.Vec3f(*inertia.moments.tolist()))
    rows: list[list[float]] = inertia.axes.tolist()
    rotation = tuple(tuple(row) for row in rows)
    mass.CreatePrincipalAxesAttr(Gf.Quatf(*compute_quaternion(rotation)))  # type: ignore[arg-type]
    xx, xy, xz, yy, yz, zz = body.tensor
    apply(prim, "NewtonMassAPI")
    set_value(prim, "newton:inertia", "double[]", [xx, yy, zz, xy, xz, yz])
