"""A stage in memory: its layers, and functions that author prims."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics

from ... import __version__
from ...model.numbers import remove_noise
from ...model.pose import IDENTITY, Pose, Rotation, quaternion_from_rotation

GEOMETRY, MATERIALS, PHYSICS, PHYSX, ISAAC = "geometry", "materials", "physics", "physx", "isaac"

LAYERS = (ISAAC, PHYSX, PHYSICS, MATERIALS, GEOMETRY)
"""Layers of a stage with payload, the strongest first; each below the layer of the hierarchy."""


CREATOR = f"urdftool {__version__}"
"""Creator of a layer; a binary layer has no comment that names it."""


class StageBuilder:
    """A stage that is being written.

    Attributes:
        stage: The stage.
        root: Path of the default prim.
        layers: Layer of each kind of data by name; all the same if the stage has one layer.
    """

    def __init__(self, name: str, *, is_layered: bool, kinds: Iterable[str] = LAYERS) -> None:
        """Create a stage with an empty robot."""
        self.base = Sdf.Layer.CreateAnonymous("base.usda")
        self.layers = dict.fromkeys(LAYERS, self.base)
        if is_layered:
            own = {kind: Sdf.Layer.CreateAnonymous(f"{kind}.usdc") for kind in kinds}
            self.layers |= own
            self.base.subLayerPaths = [layer.identifier for layer in own.values()]
        self.stage = Usd.Stage.Open(self.base)
        set_units(self.stage)
        self.base.customLayerData = {"creator": CREATOR}
        self.root = Sdf.Path(f"/{name}")
        prim = UsdGeom.Xform.Define(self.stage, self.root).GetPrim()
        self.stage.SetDefaultPrim(prim)
        Usd.ModelAPI(prim).SetKind("component")

    def edit_layer(self, kind: str) -> Usd.EditContext:
        """Return a context in which changes go to the layer of a kind of data."""
        return Usd.EditContext(self.stage, self.layers[kind])

    @property
    def prim(self) -> Usd.Prim:
        """Return the default prim."""
        return self.stage.GetPrimAtPath(self.root)


def set_units(stage: Usd.Stage) -> None:
    """Set meters, kilograms, Z up and one time code a second."""
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdPhysics.SetStageKilogramsPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(1.0)


def set_pose(prim: Usd.Prim, pose: Pose, scale: Sequence[float] | None = None) -> None:
    """Write translation and orientation in double precision, and a scale if given."""
    form = UsdGeom.Xformable(prim)
    double = UsdGeom.XformOp.PrecisionDouble
    form.AddTranslateOp(double).Set(Gf.Vec3d(*remove_noise(pose.translation)))
    form.AddOrientOp(double).Set(Gf.Quatd(*compute_quaternion(pose.rotation)))
    if scale is not None:
        form.AddScaleOp(double).Set(Gf.Vec3d(*scale))


def compute_quaternion(rotation: Rotation) -> tuple[float, float, float, float]:
    """Return the quaternion ``(w, x, y, z)`` of a rotation with a nonnegative w, without noise."""
    if rotation is IDENTITY.rotation:
        return 1.0, 0.0, 0.0, 0.0
    four = quaternion_from_rotation(rotation)
    sign = -1.0 if four[0] < 0 else 1.0
    w, x, y, z = remove_noise(sign * part for part in four)
    return w, x, y, z


def apply(prim: Usd.Prim, *schemas: str) -> None:
    """Apply schemas by name; schemas of Newton and PhysX need no registration for it."""
    for schema in schemas:
        prim.AddAppliedSchema(schema)


def set_value(prim: Usd.Prim, name: str, kind: str, value: Any, *, uniform: bool = False) -> None:
    """Write an attribute of a schema that may not be registered."""
    variability = Sdf.VariabilityUniform if uniform else Sdf.VariabilityVarying
    type_name = Sdf.ValueTypeNames.Find(kind)
    attribute = prim.CreateAttribute(name, type_name, custom=False, variability=variability)
    attribute.Set(value)


def set_targets(prim: Usd.Prim, name: str, targets: Sequence[Sdf.Path]) -> None:
    """Write a relationship."""
    prim.CreateRelationship(name, custom=False).SetTargets(list(targets))


def store_name(prim: Usd.Prim, kind: str, name: str) -> None:
    """Store the name of a link or joint, which the prim's name may differ from."""
    prim.SetCustomDataByKey(f"urdf:{kind}", name)
    if prim.GetName() != name:
        prim.SetDisplayName(name)
