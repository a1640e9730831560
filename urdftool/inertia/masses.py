"""Mass of each link of a robot: given, distributed by volume, or as written."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..suggestions import suggest_name
from .inertia_error import InertiaError


@dataclass(frozen=True)
class Masses:
    """Mass assignment.

    Attributes:
        by_link: Masses [kg] of single links, which take precedence.
        density: Density [kg/m³] of the others.
        total: Mass [kg] of the whole robot; links without a mass share the remainder by volume.
        recompute: Whether ``density`` and ``total`` replace written masses.
    """

    by_link: Mapping[str, float] = field(default_factory=dict)
    density: float | None = None
    total: float | None = None
    recompute: bool = False


def check_masses(masses: Masses, names: Sequence[str]) -> None:
    """Check masses against the links of a robot.

    Raises:
        InertiaError: A link is not in the robot, a number is not above zero, or both a density and
            a total mass are given.
    """
    for name, mass in masses.by_link.items():
        if name not in names:
            hint = suggest_name(name, names, 0.5) or f"; links are {_format_listed(names)}"
            raise InertiaError(f"the robot has no link '{name}'{hint}")
        _check(f"the mass of link '{name}'", mass, "kg")
    if masses.density is not None:
        _check("the density", masses.density, "kg/m³")
    if masses.total is not None:
        _check("the total mass", masses.total, "kg")
    if masses.density is not None and masses.total is not None:
        raise InertiaError("give a density or a total mass, not both")


def _check(what: str, value: float, unit: str) -> None:
    if not (math.isfinite(value) and value > 0):
        raise InertiaError(f"{what} is {value:g} {unit}; must be above zero")


def _format_listed(names: Sequence[str]) -> str:
    shown = ", ".join(names[:8])
    return f"{shown}, …" if len(names) > 8 else shown


def assign_masses(
    masses: Masses,
    written: Mapping[str, float | None],
    volumes: Mapping[str, float | None],
    unknown: Sequence[str] = (),
) -> dict[str, float | None]:
    """Compute the mass of each link [kg]; None if unknown.

    Args:
        masses: The requested assignment.
        written: Written mass of each link; None if it is missing or not above 0.
        volumes: Volume [m³] of each link's geometry; None if unknown.
        unknown: Links with geometry whose volume is unknown.

    Raises:
        InertiaError: A total mass cannot be distributed: nothing remains of it, no link takes a
            share, or the volume of a link is unknown.
    """
    found: dict[str, float | None] = {}
    shared: list[str] = []
    spread = masses.density is not None or masses.total is not None
    for name, mass in written.items():
        volume = volumes.get(name)
        if name in masses.by_link:
            found[name] = masses.by_link[name]
        elif spread and volume and (masses.recompute or mass is None):
            found[name] = None if masses.density is None else masses.density * volume
            shared.append(name)
        else:
            found[name] = mass
    lost = [name for name in unknown if not found[name]]
    if masses.total is not None and lost:
        raise InertiaError(
            f"the total mass cannot be distributed, since the volume of {_format_listed(lost)} is "
            "not "
            "known; "
            f"give its mass with --mass {lost[0]}=KG, or its meshes"
        )
    if masses.total is not None and not shared:
        raise InertiaError(
            f"the total mass of {masses.total:g} kg cannot be distributed: every link with a "
            "known volume has a mass already; --all replaces these masses"
        )
    if masses.total is not None:
        assigned = math.fsum(mass for mass in found.values() if mass)
        rest = masses.total - assigned
        if rest <= 1e-12 * masses.total:
            raise InertiaError(
                f"the total mass of {masses.total:g} kg leaves nothing for "
                f"{_format_listed(shared)}: the "
                f"other links have {assigned:g} kg"
            )
        whole = math.fsum(volumes[name] or 0.0 for name in shared)
        for name in shared:
            found[name] = rest * (volumes[name] or 0.0) / whole
    return found
