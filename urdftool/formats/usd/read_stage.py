"""A stage that is read: units, prims by kind, places and names."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdPhysics, UsdUtils

from ...diagnostic import Severity
from ...errors import ModelError
from ...model.pose import Pose, Rotation, rotation_from_quaternion
from ...model.provenance import Written
from ...source.document import STDIN
from ...source.location import Place, SourceFile
from ..reading import Losses
from .read_places import Layers


class Context:
    """State of reading one stage.

    Attributes:
        stage: The stage.
        layers: The layers as source files.
        losses: What the robot does not hold.
        top: Prim below which the robot is; the pseudo-root if no prim is the default.
        length: Meters in a unit of length.
        mass: Kilograms in a unit of mass.
        bodies: Prims of rigid bodies by path, in the order of the stage.
        joints: Prims of enabled joints, in the order of the stage.
        names: Name of the link of each body or frame, by path.
        shifts: Pose of the frame of each link in the frame of its prim, by path.
    """

    def __init__(self, stage: Usd.Stage, layers: Layers, losses: Losses, articulation: str) -> None:
        """Find the bodies and joints of a stage.

        Raises:
            ModelError: There is no rigid body, or the stage has several robots.
        """
        self.stage, self.losses = stage, losses
        self.layers = layers
        self.top = self._find_top(articulation)
        self.length = float(UsdGeom.GetStageMetersPerUnit(stage))
        self.mass = float(UsdPhysics.GetStageKilogramsPerUnit(stage))
        self.is_y_up = UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y
        self._cache = UsdGeom.XformCache()
        self.bodies: dict[str, Usd.Prim] = {}
        self.joints: list[Usd.Prim] = []
        for prim in self.iterate_prims():
            if prim.HasAPI(UsdPhysics.RigidBodyAPI):
                self.bodies[str(prim.GetPath())] = prim
            if prim.IsA(UsdPhysics.Joint):
                self.joints.append(prim)
        self.names: dict[str, str] = {}
        self.shifts: dict[str, Pose] = {}
        if not self.bodies:
            raise ModelError("the stage has no rigid body", at=self.get_place(self.top))

    def _find_top(self, articulation: str) -> Usd.Prim:
        if articulation:
            prim = self.stage.GetPrimAtPath(articulation)
            if not prim:
                at = self.get_place(self.stage.GetPseudoRoot())
                raise ModelError(f"the stage has no prim {articulation}", at=at)
            return prim
        default = self.stage.GetDefaultPrim()
        return default if default else self.stage.GetPseudoRoot()

    def iterate_prims(self, below: Usd.Prim | None = None) -> Iterator[Usd.Prim]:
        """Yield the prims of the robot, also those of instances."""
        prim = below or self.top
        yield from Usd.PrimRange(prim, Usd.TraverseInstanceProxies())

    @property
    def robot_name(self) -> str:
        """Return the name of the robot."""
        stored = self.top.GetCustomDataByKey("urdf:robot")
        return str(stored) if stored else self.top.GetName().strip("/")

    def get_place(self, prim: Usd.Prim, attribute: str = "") -> Place:
        """Return the place of a prim, or of the layer that sets an attribute of it."""
        return self.layers.get_place(prim, attribute)

    def get_written(self, prim: Usd.Prim, attribute: str = "") -> Written:
        """Return the provenance of a prim, or of the layer that sets an attribute of it."""
        return Written(self.get_place(prim, attribute))

    def get_matrix(self, prim: Usd.Prim) -> Gf.Matrix4d:
        """Return the transform of a prim to the stage, as OpenUSD multiplies it (row vectors)."""
        return self._cache.GetLocalToWorldTransform(prim)

    def get_pose(self, prim: Usd.Prim) -> Pose:
        """Return the pose of a prim in the stage [m], without its scale."""
        return compute_pose(self.get_matrix(prim), self.length)

    def find_body(self, prim: Usd.Prim) -> str:
        """Return the path of the body that carries a prim; empty if none does."""
        while prim and str(prim.GetPath()) not in self.bodies:
            prim = prim.GetParent()
        return str(prim.GetPath()) if prim else ""

    def report_loss(
        self, code: str, what: str, prim: Usd.Prim, severity: Severity = Severity.WARNING
    ) -> None:
        """Record what the robot does not hold of a prim."""
        self.losses.add(code, what, prim.GetName(), self.get_place(prim), severity)


def open_stage(file: SourceFile, losses: Losses) -> Usd.Stage:
    """Open a stage with its payloads, and record the warnings of OpenUSD.

    Raises:
        ModelError: OpenUSD does not open it.
    """
    delegate = UsdUtils.CoalescingDiagnosticDelegate()
    place = Place(file, 0, 0)
    try:
        if file.path == STDIN:
            with TemporaryDirectory(prefix="urdftool-") as folder:
                copy = Path(folder) / f"stdin{_get_suffix(file.data)}"
                copy.write_bytes(file.data)
                stage = Usd.Stage.Open(str(copy), Usd.Stage.LoadAll)
        else:
            stage = Usd.Stage.Open(os.path.abspath(file.path), Usd.Stage.LoadAll)
    except Exception as error:
        reasons = [str(item.commentary) for item in delegate.TakeUncoalescedDiagnostics()]
        notes = reasons or [str(error)]
        raise ModelError("OpenUSD does not open the stage", at=place, notes=notes) from None
    for item in delegate.TakeUncoalescedDiagnostics():
        text = " ".join(str(item.commentary).split())
        losses.add("warning", f"OpenUSD warns: {text}", "", place, Severity.INFO)
    return stage


def _get_suffix(data: bytes) -> str:
    if data.startswith(b"PXR-USDC"):
        return ".usdc"
    return ".usdz" if data.startswith(b"PK") else ".usda"


def compute_pose(matrix: Gf.Matrix4d, length: float = 1.0) -> Pose:
    """Return the pose of a matrix for row vectors, without scale; translations in meters."""
    rigid = matrix.RemoveScaleShear()
    x, y, z = rigid.ExtractTranslation()
    rows: Rotation = tuple(  # type: ignore[assignment]
        tuple(float(rigid[column][row]) for column in range(3)) for row in range(3)
    )
    return Pose(rows, (x * length, y * length, z * length))


def compute_joint_pose(position: Gf.Vec3f, rotation: Gf.Quatf, length: float) -> Pose:
    """Return the pose of a joint frame in its body [m]."""
    x, y, z = (float(part) * length for part in position)
    i, j, k = rotation.GetImaginary()
    four = (float(rotation.GetReal()), float(i), float(j), float(k))
    return Pose(rotation_from_quaternion(four), (x, y, z))


def has_schema(prim: Usd.Prim, schema: str) -> bool:
    """Tell whether a schema is applied, also one that is not registered."""
    listed = prim.GetMetadata("apiSchemas")
    return listed is not None and schema in listed.GetAddedOrExplicitItems()


def get_value(prim: Usd.Prim, *names: str) -> float | None:
    """Return the value of the first attribute with an authored number; None without one."""
    for name in names:
        attribute = prim.GetAttribute(name)
        if attribute and attribute.HasAuthoredValue():
            return float(attribute.Get())
    return None


def convert_float(value: float, factor: float = 1.0) -> float:
    """Convert a 32-bit float to another unit: the shortest number that is stored as the same.

    Args:
        value: Value in the unit of the stage.
        factor: Number of our units in that unit.
    """
    stored = np.float32(value)
    for digits in range(1, 10):
        found = float(f"{value * factor:.{digits}g}")
        if np.float32(found / factor) == stored:
            return found
    return value * factor


def get_targets(prim: Usd.Prim, name: str) -> list[str]:
    """Return the paths to which a relationship leads."""
    relation = prim.GetRelationship(name)
    return [str(path) for path in relation.GetTargets()] if relation else []
