"""Bodies of unit density: volume, center of mass and inertia of meshes, before mass is assigned.

Mass properties are proportional to density, and those of a scaled mesh follow from the unscaled
one, so each file is read and integrated only once.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from types import NoneType
from typing import Any

import numpy as np

from ..diagnostic import Diagnostic, make_remark
from ..errors import MeshError
from ..geometry.mesh import Array
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import compute_inertia_from_second_moment, compute_second_moment
from ..source.description import GltfUp
from ..storage import DiskCache, cache_key
from .inertia_error import InertiaError

_REVISION = 3
"""Of the mass properties of the same mesh. Chosen, no source."""

_PLAIN: dict[str, tuple[type, ...]] = {
    "method": (str,),
    "reliable": (bool,),
    "error": (float,),
    "hull_measure": (float, NoneType),
    "bodies": (int,),
    "triangles": (int,),
    "surface": (bool,),
}
"""Fields that an entry of the cache holds as they are, with their types."""


@dataclass(frozen=True, eq=False)
class MeshBody:
    """The solid that a mesh encloses, or its surface as a shell, at unit density."""

    path: Path
    unit: SpatialInertia
    """Mass properties at 1 kg/m³, or 1 kg/m² for a surface, in the frame of the mesh."""
    lower: Array
    """Lower corner of the bounding box [m]."""
    upper: Array
    """Upper corner of the bounding box [m]."""
    method: str
    """Method as in ``Estimate.method``; ``"surface"`` for a shell."""
    reliable: bool
    error: float
    """Estimated relative error of volume, center and moments."""
    hull_measure: float | None
    """Volume [m³] of the convex hull; None if the result is exact."""
    bodies: int
    triangles: int
    notes: tuple[Diagnostic, ...]
    surface: bool = False
    suspicion: Diagnostic | None = None
    """Why the size suggests a wrong unit; None if it does not."""

    @property
    def note_texts(self) -> tuple[str, ...]:
        """Return the notes and the message of the suspicion."""
        found = self.notes if self.suspicion is None else (*self.notes, self.suspicion)
        return tuple(note.message for note in found)

    @property
    def measure(self) -> float:
        """Return the volume [m³], or the area [m²] of a surface."""
        return self.unit.mass

    def scale(self, factors: tuple[float, float, float]) -> MeshBody:
        """Scale the mesh along its axes; negative factors mirror it.

        Raises:
            InertiaError: A factor is zero or not finite, or the factors of a surface have different
                absolute values.
        """
        x, y, z = factors
        if not all(math.isfinite(factor) and factor for factor in factors):
            raise InertiaError(
                f"the mesh scale {x:g} {y:g} {z:g} is not three finite factors other than zero"
            )
        scale = np.array(factors)
        if self.surface:
            if not abs(x) == abs(y) == abs(z):
                raise InertiaError(
                    "the surface of a mesh has mass properties for three equal factors only"
                )
            growth = x * x
        else:
            growth = abs(x * y * z)
        xx, xy, xz, yy, yz, zz = (growth * part for part in compute_second_moment(self.unit.tensor))
        second = (x * x * xx, x * y * xy, x * z * xz, y * y * yy, y * z * yz, z * z * zz)
        a, b, c = self.unit.com
        unit = SpatialInertia(
            self.unit.mass * growth,
            (a * x, b * y, c * z),
            compute_inertia_from_second_moment(second),
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
        """Set the suspicion by the size."""
        from ..geometry.topology import explain_unit_suspicion

        return replace(
            self, suspicion=explain_unit_suspicion(float((self.upper - self.lower).max()))
        )

    def as_dict(self) -> dict[str, Any]:
        """Return the JSON form of everything but the mass properties."""
        return {
            "method": self.method,
            "reliable": self.reliable,
            "error": self.error,
            "area" if self.surface else "volume": self.measure,
            "hull_volume": self.hull_measure,
            "bodies": self.bodies,
            "triangles": self.triangles,
            "notes": list(self.note_texts),
        }


def get_cached_mesh_body(
    path: Path, cache: DiskCache, *, surface: bool = False, gltf_up: GltfUp = "y"
) -> MeshBody:
    """Return :func:`integrate_mesh_body`, which is kept by the content of the file.

    Raises:
        MeshError: The file cannot be read or encloses no volume.
    """
    if cache.folder is None or not path.is_file():
        return integrate_mesh_body(path, surface=surface, gltf_up=gltf_up)
    from ..geometry.thin import compute_content_key

    key = cache_key(_REVISION, ["body", surface, gltf_up], [compute_content_key(path).encode()])
    data = cache.get(key)
    known = None if data is None else _unpack(data, path)
    if known is not None:
        return known
    body = integrate_mesh_body(path, surface=surface, gltf_up=gltf_up)
    cache.put(key, _pack(body))
    return body


def _pack(body: MeshBody) -> bytes:
    table = {
        "unit": [body.unit.mass, list(body.unit.com), list(body.unit.tensor)],
        "box": [body.lower.tolist(), body.upper.tolist()],
        **{name: getattr(body, name) for name in _PLAIN},
        "notes": [[note.code, note.message, dict(note.data)] for note in body.notes],
    }
    return json.dumps(table).encode()


def _unpack(data: bytes, path: Path) -> MeshBody | None:
    """Return the body of an entry; None if the entry is damaged."""
    try:
        table = json.loads(data)
        mass, com, tensor = table["unit"]
        numbers = [mass, *com, *tensor, *table["box"][0], *table["box"][1]]
        plain = {name: table[name] for name in _PLAIN}
        if len(numbers) != 16 or not all(type(n) is float and math.isfinite(n) for n in numbers):
            return None
        if any(type(plain[name]) not in kinds for name, kinds in _PLAIN.items()):
            return None
        lower, upper = np.array(numbers[10:13]), np.array(numbers[13:])
        unit = SpatialInertia(mass, tuple(com), tuple(tensor))
        notes = [make_remark(str(code), str(text), **more) for code, text, more in table["notes"]]
        return MeshBody(path=path, unit=unit, lower=lower, upper=upper, notes=tuple(notes), **plain)
    except (ValueError, TypeError, KeyError, IndexError, RecursionError):
        return None


def integrate_mesh_body(path: Path, *, surface: bool = False, gltf_up: GltfUp = "y") -> MeshBody:
    """Integrate a mesh file at unit density, unscaled.

    ``surface`` integrates its surface as a thin shell.

    Raises:
        MeshError: The file cannot be read or encloses no volume.
    """
    from ..geometry.load import load_mesh
    from ..geometry.topology import find_used_vertices

    mesh = load_mesh(path, gltf_up=gltf_up)
    used = mesh.vertices[find_used_vertices(mesh.faces, len(mesh.vertices))]
    box = used.min(axis=0), used.max(axis=0)
    count = len(mesh.faces)
    remarks = tuple(make_remark(note.code, note.message) for note in mesh.notes)
    if surface:
        from .polyhedron import compute_shell_moments

        shell = compute_shell_moments(mesh.vertices, mesh.faces).with_density(1.0)
        return MeshBody(
            path, shell, *box, "surface", True, 0.0, None, 1, count, remarks, surface=True
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
        (*remarks, *found.notes),
    )


def scale_to_mass(
    unit: SpatialInertia, what: str, *, mass: float | None = None, density: float | None = None
) -> SpatialInertia:
    """Scale a body of unit density to a mass [kg] or a density [kg/m³].

    Args:
        unit: Mass properties at unit density.
        what: Name of the body in error messages.
        mass: Mass [kg]; give this or ``density``.
        density: Density [kg/m³].

    Raises:
        InertiaError: Not exactly one of the two is given, or it is not above zero.
    """
    if (mass is None) == (density is None):
        raise InertiaError(f"a {what} requires either a mass [kg] or a density [kg/m³], not both")
    name, given = ("mass", mass) if mass is not None else ("density", density)
    assert given is not None
    if not (math.isfinite(given) and given > 0):
        raise InertiaError(f"the {name} of a {what} is {given:g}; must be above zero")
    return unit.with_mass(given if mass is not None else given * unit.mass)
