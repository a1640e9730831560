"""Links with mass properties, visuals and collisions; units and sources as in ``elements``."""

from __future__ import annotations

from dataclasses import dataclass, field

from .part import Origin, Part, Vector
from .settings import Settings, is_set
from .shapes import Geometry

COMPONENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
"""Names of the six numbers of a tensor in URDF and SDF, in their order."""


@dataclass(slots=True)
class Inertia(Part):
    """Inertia tensor [kg·m²] about the center of mass, in the inertial frame."""

    ixx: float = 0.0
    ixy: float = 0.0
    ixz: float = 0.0
    iyy: float = 0.0
    iyz: float = 0.0
    izz: float = 0.0

    @property
    def moments(self) -> Vector:
        """Return the diagonal: ixx, iyy, izz."""
        return self.ixx, self.iyy, self.izz

    @property
    def products(self) -> Vector:
        """Return the off-diagonal elements: ixy, ixz, iyz."""
        return self.ixy, self.ixz, self.iyz

    @property
    def six(self) -> tuple[float, float, float, float, float, float]:
        """Return ixx, ixy, ixz, iyy, iyz, izz."""
        return self.ixx, self.ixy, self.ixz, self.iyy, self.iyz, self.izz


@dataclass(slots=True)
class Inertial(Part):
    """Mass [kg], pose of the inertial frame in the link frame, inertia; None if not written."""

    origin: Origin | None = None
    mass: float | None = None
    inertia: Inertia | None = None


@dataclass(slots=True)
class Material(Part):
    """Named color (``rgba``, each 0 to 1) or texture; both None for a reference by name."""

    name: str = ""
    color: tuple[float, float, float, float] | None = None
    texture: str | None = None


@dataclass(slots=True)
class Visual(Part):
    """Visual geometry of a link.

    Attributes:
        appearance: Settings of ``appearance.APPEARANCE`` in addition to the material.
        script: Material of an Ogre script that its reader does not know.
    """

    name: str | None = None
    origin: Origin | None = None
    geometry: Geometry | None = None
    material: Material | None = None
    appearance: Settings = field(default_factory=dict)
    script: str = ""


@dataclass(slots=True)
class Collision(Part):
    """Collision geometry of a link; ``surface`` has the settings of ``settings.SURFACE``."""

    name: str | None = None
    origin: Origin | None = None
    geometry: Geometry | None = None
    surface: Settings = field(default_factory=dict)


@dataclass(slots=True)
class Link(Part):
    """Link of a robot: a rigid body or a coordinate frame.

    Attributes:
        is_virtual: Whether a reader inserted it between two joints that the source writes between
            the same two bodies; it has no mass and no geometry.
        settings: Settings of ``settings.OF_LINKS``.
        surface: Settings that a URDF gives its collisions; those of blocks reach collisions
            without a name, or whose name begins with that of the link.
        gazebo_material: Material of Gazebo that a ``<gazebo>`` block names; empty for none.
    """

    name: str = ""
    inertial: Inertial | None = None
    visuals: list[Visual] = field(default_factory=list)
    collisions: list[Collision] = field(default_factory=list)
    is_virtual: bool = False
    settings: Settings = field(default_factory=dict)
    surface: Settings = field(default_factory=dict)
    gazebo_material: str = ""

    @property
    def mass(self) -> float:
        """Return the mass [kg]; 0 if not written."""
        return (self.inertial.mass or 0.0) if self.inertial else 0.0

    @property
    def is_weightless(self) -> bool:
        """Tell whether gravity does not act on the link."""
        return not is_set(self.settings, "gravity", True)

    @property
    def is_frame(self) -> bool:
        """Tell whether the link has no visual, no collision and no inertial."""
        return not (self.visuals or self.collisions or self.inertial)
