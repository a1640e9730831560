"""Friction of contact, as physics materials of the collision geometry of links."""

from __future__ import annotations

from dataclasses import dataclass, field

from pxr import Sdf, Usd, UsdPhysics, UsdShade

from ...diagnostic import Severity
from ...model.elements import Link
from ..common.contact_friction import (
    get_bullet_friction,
    get_gazebo_friction,
    get_second_gazebo_friction,
)
from ..written import Written
from .links import LinkWriter
from .stage import PHYSICS


@dataclass(frozen=True)
class SurfaceWriter:
    """Makes one physics material for each coefficient of friction.

    Attributes:
        links: Writer of links.
        written: Receives the losses.
    """

    links: LinkWriter
    written: Written
    _paths: dict[float, Sdf.Path] = field(default_factory=dict)

    def find_material(self, link: Link) -> UsdShade.Material | None:
        """Return the material of the collisions of a link; None if it has no friction."""
        robot = self.links.bodies.robot
        sliding = get_gazebo_friction(robot, link.name)
        if sliding is None:
            sliding = get_bullet_friction(robot, link.name)
        if sliding is None or not link.collisions:
            return None
        other = get_second_gazebo_friction(robot, link.name)
        if other is not None and other != sliding:
            self.written.report_loss(
                "friction",
                f"friction of link '{link.name}' is {sliding:g} and {other:g} by direction; a "
                f"physics material has one, {sliding:g}",
                link.place,
                kind="link",
                name=link.name,
                severity=Severity.INFO,
            )
        return UsdShade.Material.Get(self.links.builder.stage, self._get_path(sliding))

    def bind(self, collider: Usd.Prim, material: UsdShade.Material) -> None:
        """Bind a material to collision geometry: readers do not inherit it from prims above."""
        with self.links.builder.edit_layer(PHYSICS):
            strength = UsdShade.Tokens.weakerThanDescendants
            UsdShade.MaterialBindingAPI.Apply(collider).Bind(material, strength, "physics")

    def _get_path(self, sliding: float) -> Sdf.Path:
        """Return the path of the material of a coefficient, which is created if it is new."""
        if sliding not in self._paths:
            stage = self.links.builder.stage
            scope = self.links.builder.root.AppendChild("surfaces")
            path = scope.AppendChild(f"friction_{len(self._paths) + 1}")
            with self.links.builder.edit_layer(PHYSICS):
                stage.DefinePrim(scope, "Scope")
                prim = UsdShade.Material.Define(stage, path).GetPrim()
                surface = UsdPhysics.MaterialAPI.Apply(prim)
                surface.CreateStaticFrictionAttr(sliding)
                surface.CreateDynamicFrictionAttr(sliding)
            self._paths[sliding] = path
        return self._paths[sliding]
