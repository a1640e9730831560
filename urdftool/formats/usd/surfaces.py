"""Friction and restitution of contact, as physics materials of the collision geometry of links."""

from __future__ import annotations

from dataclasses import dataclass, field

from pxr import Sdf, Usd, UsdPhysics, UsdShade

from ...diagnostic import Severity
from ...model.elements import Collision, Link
from ...model.settings import LOST_SETTINGS, get_number
from ..written import Written
from .links import LinkWriter
from .stage import PHYSICS


@dataclass(frozen=True)
class SurfaceWriter:
    """Makes one physics material for each coefficient of friction."""

    links: LinkWriter
    written: Written
    _paths: dict[tuple[float, float], Sdf.Path] = field(default_factory=dict)

    def find_material(self, link: Link, collision: Collision) -> UsdShade.Material | None:
        """Return the material of a collision of a link; None without friction and restitution."""
        surface = collision.surface
        sliding, other = (get_number(surface, name) for name in ("friction", "second_friction"))
        bounce = get_number(surface, "restitution") or 0.0
        if sliding is None and other is None and not bounce:
            return None
        if sliding is None:  # the schema's default is 0; Gazebo and MuJoCo have 1
            sliding = 1.0
        if other is not None and other != sliding:
            self.written.report_loss(
                "friction",
                f"friction of link '{link.name}' is {sliding:g} and {other:g} by direction; a "
                f"physics material has one, {sliding:g}",
                link.place,
                kind="link",
                name=link.name,
                severity=Severity.INFO,
                data={LOST_SETTINGS: ("second_friction",)},
            )
        return UsdShade.Material.Get(self.links.builder.stage, self._get_path(sliding, bounce))

    def bind(self, collider: Usd.Prim, material: UsdShade.Material) -> None:
        """Bind a material to collision geometry: readers do not inherit it from prims above."""
        with self.links.builder.edit_layer(PHYSICS):
            strength = UsdShade.Tokens.weakerThanDescendants
            UsdShade.MaterialBindingAPI.Apply(collider).Bind(material, strength, "physics")

    def _get_path(self, sliding: float, bounce: float) -> Sdf.Path:
        """Return the path of the material of coefficients, which is created if it is new."""
        key = sliding, bounce
        if key not in self._paths:
            stage = self.links.builder.stage
            scope = self.links.builder.root.AppendChild("surfaces")
            path = scope.AppendChild(f"friction_{len(self._paths) + 1}")
            with self.links.builder.edit_layer(PHYSICS):
                stage.DefinePrim(scope, "Scope")
                prim = UsdShade.Material.Define(stage, path).GetPrim()
                surface = UsdPhysics.MaterialAPI.Apply(prim)
                surface.CreateStaticFrictionAttr(sliding)
                surface.CreateDynamicFrictionAttr(sliding)
                if bounce:
                    surface.CreateRestitutionAttr(bounce)
            self._paths[key] = path
        return self._paths[key]
