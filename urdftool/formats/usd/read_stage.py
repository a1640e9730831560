"""A stage that is read: units, prims by kind, places and names."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from hashlib import sha256

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdPhysics

from ...diagnostic import Severity
from ...errors import ModelError
from ...model.contradiction import Contradiction
from ...model.part import Vector
from ...model.pose import Pose, Rotation
from ...model.provenance import Written
from ...source.location import Place
from ..reading import LARGEST, Losses
from .read_places import Layers

NO_TURN = (1.0, 0.0, 0.0, 0.0)
"""Quaternion of the identity."""

ROUNDING = 1e-6
"""Relative difference of two 32-bit floats that rounding of one number explains: 8 ulp."""

_UNSCALED = 1e-6
"""Difference of the scale from 1 that rounding explains."""


class Context:
    """State of reading one stage.

    Attributes:
        stage: The stage.
        layers: The layers as source files.
        losses: What the robot does not hold.
        top: Prim below which the robot is; the pseudo-root if no prim is the default.
        length: Meters in a unit of length.
        mass: Kilograms in a unit of mass.
        chosen: Name of the articulation that is read; empty for the one with most bodies.
        is_ours: Whether urdftool wrote the stage.
        bodies: Prims of rigid bodies by path, in the order of the stage.
        others: Prims of other robots and bodies, which are not read, by path.
        joints: Prims of joints, in the order of the stage.
        contradictions: Attributes for different simulators that differ.
        names: Name of the link of each body or frame, by path.
        shifts: Pose of the frame of each link in the frame of its prim, by path.
    """

    def __init__(self, stage: Usd.Stage, layers: Layers, losses: Losses, chosen: str) -> None:
        """Find the bodies and joints of a stage.

        Raises:
            ModelError: There is no rigid body, or the stage has several robots.
        """
        self.stage, self.losses = stage, losses
        self.layers = layers
        self.top = stage.GetDefaultPrim() or stage.GetPseudoRoot()
        self.chosen = chosen
        self.length = self._check_unit("metersPerUnit", UsdGeom.GetStageMetersPerUnit(stage))
        kilograms = UsdPhysics.GetStageKilogramsPerUnit(stage)
        self.mass = self._check_unit("kilogramsPerUnit", kilograms)
        self.is_y_up = UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y
        self.is_ours = bool(self.top.GetCustomDataByKey("urdf:root"))
        self._cache = UsdGeom.XformCache()
        self.bodies: dict[str, Usd.Prim] = {}
        self.others: dict[str, Usd.Prim] = {}
        self.joints: list[Usd.Prim] = []
        for prim in self.iterate_prims():
            if _is_body(prim):
                self.bodies[str(prim.GetPath())] = prim
            if prim.IsA(UsdPhysics.Joint):
                self.joints.append(prim)
        self.contradictions: list[Contradiction] = []
        self.names: dict[str, str] = {}
        self.shifts: dict[str, Pose] = {}
        if not self.bodies and not self.is_ours:
            raise ModelError("the stage has no rigid body", at=self.get_place(self.top))

    def _check_unit(self, name: str, value: float) -> float:
        if not 0 < value < LARGEST:
            at = self.get_place(self.stage.GetPseudoRoot())
            raise ModelError(f"{name} must be positive, but is {value:g}", at=at)
        return float(value)

    def iterate_prims(self, below: Usd.Prim | None = None) -> Iterator[Usd.Prim]:
        """Yield the prims of the robot, also those of instances."""
        prim = below or self.top
        yield from Usd.PrimRange(prim, Usd.TraverseInstanceProxies())

    @property
    def exported(self) -> Usd.Prim:
        """Return the prim of an export of this tool, which another stage may reference.

        It is at or above the bodies that are read; the top if there is none.
        """
        prim = next(iter(self.bodies.values()), self.top)
        while prim and not prim.GetCustomDataByKey("urdf:root"):
            prim = prim.GetParent()
        return prim or self.top

    @property
    def robot_name(self) -> str:
        """Return the name of the robot."""
        stored = self.exported.GetCustomDataByKey("urdf:robot")
        return str(stored) if stored else self.top.GetName().strip("/")

    def get_place(self, prim: Usd.Prim, attribute: str = "") -> Place:
        """Return the place of a prim, or of the layer that sets an attribute of it."""
        return self.layers.get_place(prim, attribute)

    def get_written(self, prim: Usd.Prim, attribute: str = "") -> Written:
        """Return the provenance of a prim, or of the layer that sets an attribute of it."""
        return Written(self.get_place(prim, attribute))

    def get_value(self, prim: Usd.Prim, *names: str) -> float | None:
        """Return the value of the first attribute with an authored number; None without one.

        Attributes that say the same for different simulators and differ are reported.

        Raises:
            ModelError: One is not a number, or NaN.
        """
        found: dict[str, float] = {}
        for name in names:
            attribute = prim.GetAttribute(name)
            if attribute and attribute.HasAuthoredValue():
                value = attribute.Get()
                number = float(value) if isinstance(value, (int, float)) else math.nan
                if math.isnan(number):
                    raise self.make_error(prim, name, f"must be a number, but is {value}")
                found[name] = number
        first = next(iter(found.values()), None)
        for name, number in found.items():
            if first is not None and not math.isclose(number, first, rel_tol=ROUNDING):
                self.report_contradiction(prim, name, {n: f"{v:g}" for n, v in found.items()})
                break
        return first

    def report_contradiction(self, prim: Usd.Prim, name: str, values: dict[str, str]) -> None:
        """Record attributes that say the same for different simulators, with other values.

        Args:
            prim: The prim.
            name: The first attribute that differs from the one that is read.
            values: Values in words by attribute; the first is read.
        """
        place = self.get_place(prim, name)
        kind = "joint" if prim.IsA(UsdPhysics.Joint) else "link"
        found = Contradiction(Written(place), kind, prim.GetName(), values)
        if found not in self.contradictions:
            self.contradictions.append(found)
            text = "attributes contradict each other, and the first is read"
            self.losses.add("contradiction", text, f"{found.name}: {found.shown}", place)

    def get_vector(
        self, prim: Usd.Prim, name: str, default: tuple[float, ...]
    ) -> tuple[float, ...]:
        """Return the numbers of an attribute; a quaternion as (w, x, y, z).

        Args:
            prim: The prim.
            name: The attribute.
            default: The numbers if it has no value; they give the length.

        Raises:
            ModelError: It has another number of numbers, or NaN.
        """
        attribute = prim.GetAttribute(name)
        value = attribute.Get() if attribute else None
        if value is None:
            return default
        if isinstance(value, (Gf.Quatf, Gf.Quatd, Gf.Quath)):
            value = (value.GetReal(), *value.GetImaginary())
        try:
            numbers = tuple(float(part) for part in value)
        except (TypeError, ValueError):
            numbers = ()
        if len(numbers) != len(default) or any(math.isnan(part) for part in numbers):
            raise self.make_error(prim, name, f"must be {len(default)} numbers, but is {value}")
        return numbers

    def check_finite(self, prim: Usd.Prim, name: str, values: Iterable[float]) -> None:
        """Check numbers of an attribute.

        Raises:
            ModelError: One is infinite, NaN, or larger than any of a robot.
        """
        for value in values:
            if not isinstance(value, (int, float)) or not abs(value) < LARGEST:
                raise self.make_error(prim, name, f"has a number that is {_describe(value)}")

    def make_error(self, prim: Usd.Prim, name: str, what: str) -> ModelError:
        """Return the error for an attribute with an invalid value."""
        return ModelError(f"{name} of {prim.GetPath()} {what}", at=self.get_place(prim, name))

    def get_matrix(self, prim: Usd.Prim) -> Gf.Matrix4d:
        """Return the transform of a prim to the stage, as OpenUSD multiplies it (row vectors).

        Raises:
            ModelError: It has numbers that are not finite, or the scale is zero.
        """
        matrix = self._cache.GetLocalToWorldTransform(prim)
        self.check_finite(prim, "xformOpOrder", (part for row in matrix for part in row))
        if not matrix.GetDeterminant3():
            raise self.make_error(prim, "xformOpOrder", "has a scale of zero")
        return matrix

    def has_zero_scale(self, prim: Usd.Prim) -> bool:
        """Tell whether the transform of a prim to the stage has a scale of zero."""
        return not bool(self._cache.GetLocalToWorldTransform(prim).GetDeterminant3())

    def get_pose(self, prim: Usd.Prim) -> Pose:
        """Return the pose of a prim in the stage [m], without its scale."""
        return compute_pose(self.get_matrix(prim), self.length)

    def get_scale(self, prim: Usd.Prim) -> Gf.Matrix4d | None:
        """Return scale and shear of a prim in the stage, as a matrix; None is the identity."""
        matrix = self.get_matrix(prim)
        factors = matrix * matrix.RemoveScaleShear().GetInverse()
        same = Gf.IsClose(factors, Gf.Matrix4d(1.0), _UNSCALED)
        return None if same else factors

    def find_body(self, prim: Usd.Prim) -> str:
        """Return the path of the body that carries a prim; empty if none does."""
        while prim and str(prim.GetPath()) not in self.bodies:
            prim = prim.GetParent()
        return str(prim.GetPath()) if prim else ""

    def is_of_other(self, prim: Usd.Prim) -> bool:
        """Tell whether a prim is, or is below, one of another robot, which is not read."""
        while prim and str(prim.GetPath()) not in self.bodies:
            if str(prim.GetPath()) in self.others:
                return True
            prim = prim.GetParent()
        return False

    def report_loss(
        self, code: str, what: str, prim: Usd.Prim, severity: Severity = Severity.WARNING
    ) -> None:
        """Record what the robot does not hold of a prim."""
        place, content = self.get_place(prim), _digest(prim)
        self.losses.add(code, what, prim.GetName(), place, severity, content)


def _digest(prim: Usd.Prim) -> str:
    """Return a digest of the type, the attributes and the relationships of a prim."""
    found = [f"{one.GetName()} {one.Get()}" for one in prim.GetAuthoredAttributes()]
    found += [f"{one.GetName()} {one.GetTargets()}" for one in prim.GetAuthoredRelationships()]
    return sha256("\n".join((str(prim.GetTypeName()), *found)).encode()).hexdigest()


def _is_body(prim: Usd.Prim) -> bool:
    """Tell whether a prim is a rigid body that moves."""
    if not prim.HasAPI(UsdPhysics.RigidBodyAPI):
        return False
    return UsdPhysics.RigidBodyAPI(prim).GetRigidBodyEnabledAttr().Get() is not False


def _describe(value: object) -> str:
    if not isinstance(value, (int, float)):
        return f"missing: {value}"
    return "not finite" if not math.isfinite(value) else "too large"


def compute_pose(matrix: Gf.Matrix4d, length: float = 1.0) -> Pose:
    """Return the pose of a matrix for row vectors, without scale; translations in meters."""
    rigid = matrix.RemoveScaleShear()
    x, y, z = rigid.ExtractTranslation()
    rows: Rotation = tuple(  # type: ignore[assignment]
        tuple(float(rigid[column][row]) for column in range(3)) for row in range(3)
    )
    return Pose(rows, (x * length, y * length, z * length))


def scale_point(scale: Gf.Matrix4d | None, point: Sequence[float]) -> Vector:
    """Return a point of a prim in its frame without scale."""
    x, y, z = point if scale is None else scale.Transform(Gf.Vec3d(*point))
    return float(x), float(y), float(z)


def has_schema(prim: Usd.Prim, schema: str) -> bool:
    """Tell whether a schema is applied, also one that is not registered."""
    listed = prim.GetMetadata("apiSchemas")
    return listed is not None and schema in listed.GetAddedOrExplicitItems()


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
