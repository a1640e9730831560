"""Bodies without a density: what a piece of geometry encloses, ready to be weighed.

A piece of unit density is all that is needed of it: mass properties are proportional to density,
and a scaled mesh follows from the unscaled one, so that each file is read and integrated once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import MeshError
from ..geometry.mesh import Array
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import inertia_from_second_moment, second_moment
from ..source.description import GltfUp
from .inertia_error import InertiaError


@dataclass(frozen=True, eq=False)
class MeshBody:
    """What a mesh encloses, or its surface, at a density of one."""

    path: Path
    unit: SpatialInertia
    """At 1 kg/m³, or 1 kg/m² for a surface, in the frame of the mesh."""
    lower: Array
    """Smallest corner of the box around it [m]."""
    upper: Array
    """Largest corner of the box around it [m]."""
    method: str
    """As ``Estimate.method``; ``"surface"`` for a shell."""
    reliable: bool
    error: float
    """Estimated error of the volume, relative to it."""
    hull_measure: float | None
    """Volume [m³] of the convex hull; None where the result is exact."""
    bodies: int
    triangles: int
    notes: tuple[str, ...]
    surface: bool = False

    @property
    def measure(self) -> float:
        """Volume [m³]; area [m²] of a surface."""
        return self.unit.mass

    def scaled(self, factors: tuple[float, float, float]) -> MeshBody:
        """The same mesh scaled along its axes; negative factors mirror it.

        Raises:
            InertiaError: A factor is zero or not finite, or they are unequal for a surface.
        """
        x, y, z = factors
        if not all(math.isfinite(factor) and factor for factor in factors):
            raise InertiaError(
                f"the mesh scale {x:g} {y:g} {z:g} is not three finite factors other than zero"
            )
        scale = np.array(factors)
        if self.surface:
            if not abs(x) == abs(y) == abs(z):
                raise InertiaError("the surface of a mesh is weighed with three equal factors only")
            growth = x * x
        else:
            growth = abs(x * y * z)
        xx, xy, xz, yy, yz, zz = (growth * part for part in second_moment(self.unit.tensor))
        second = (x * x * xx, x * y * xy, x * z * xz, y * y * yy, y * z * yz, z * z * zz)
        a, b, c = self.unit.com
        unit = SpatialInertia(
            self.unit.mass * growth, (a * x, b * y, c * z), inertia_from_second_moment(second)
        )
        corners = np.stack([self.lower * scale, self.upper * scale])
        hull = None if self.hull_measure is None else self.hull_measure * growth
        found = replace(
            self,
            unit=unit,
            lower=corners.min(axis=0),
            upper=corners.max(axis=0),
            hull_measure=hull,
        )
        return found._with_suspicion()

    def _with_suspicion(self) -> MeshBody:
        """With a note where the size hints at a wrong unit."""
        from ..geometry.topology import unit_suspicion

        hint = unit_suspicion(float((self.upper - self.lower).max()))
        return replace(self, notes=(*self.notes, hint)) if hint else self

    def as_dict(self) -> dict[str, Any]:
        """The JSON form of all but the mass properties."""
        return {
            "method": self.method,
            "reliable": self.reliable,
            "error": self.error,
            "area" if self.surface else "volume": self.measure,
            "hull_volume": self.hull_measure,
            "bodies": self.bodies,
            "triangles": self.triangles,
            "notes": list(self.notes),
        }


def mesh_body(path: Path, *, surface: bool = False, gltf_up: GltfUp = "y") -> MeshBody:
    """What a mesh file encloses, unscaled.

    Args:
        path: An STL, OBJ, DAE, PLY, glTF or GLB file.
        surface: Take its surface as a thin shell instead of what it encloses.
        gltf_up: The axis of a glTF file that is up.

    Raises:
        MeshError: The file cannot be read, or encloses nothing.
    """
    from ..geometry.load import load_mesh

    mesh = load_mesh(path, gltf_up=gltf_up)
    used = mesh.vertices[np.unique(mesh.faces)]
    box = used.min(axis=0), used.max(axis=0)
    count = len(mesh.faces)
    if surface:
        from .polyhedron import shell_moments

        shell = shell_moments(mesh.vertices, mesh.faces).with_density(1.0)
        return MeshBody(
            path, shell, *box, "surface", True, 0.0, None, 1, count, mesh.note_texts, surface=True
        )
    from .estimate import estimate_mass_properties

    try:
        found = estimate_mass_properties(mesh.vertices, mesh.faces, density=1.0)
    except MeshError as error:
        if error.path:
            raise
        raise MeshError(error.message, path=path) from error
    return MeshBody(
        path,
        found.properties,
        *box,
        found.method,
        found.reliable,
        found.error,
        found.hull_volume,
        found.bodies,
        count,
        (*mesh.note_texts, *found.notes),
    )


def weighed(
    unit: SpatialInertia, what: str, *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """A body of unit density with the mass [kg] or density [kg/m³] it has.

    Raises:
        InertiaError: Not just one of the two is given, or it is not above zero.
    """
    if (mass is None) == (density is None):
        raise InertiaError(f"a {what} needs either a mass [kg] or a density [kg/m³], not both")
    name, given = ("mass", mass) if mass is not None else ("density", density)
    assert given is not None
    if not (math.isfinite(given) and given > 0):
        raise InertiaError(f"the {name} of a {what} is {given:g}; a number above zero is needed")
    return unit.with_mass(given if mass is not None else given * unit.mass)
