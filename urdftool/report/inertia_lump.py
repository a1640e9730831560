"""Mass properties of rigid bodies and the whole robot: a table and JSON."""

from __future__ import annotations

from typing import Any

from ..inertia.lump import Lumped
from ..inertia.rounding import round_properties
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import COMPONENTS
from ..model.elements import Robot
from .findings import clean
from .inertia import numbers
from .json_text import json_text
from .tables import render_table

_HEADS = ("body", "links", "mass [kg]", "com x", "y", "z [m]", *COMPONENTS[:5], "izz [kg m²]")


def table(lumped: Lumped) -> str:
    """Format a row for each rigid body in the frame of its first link, and one for the whole."""
    rows: list[tuple[str, ...]] = [_HEADS]
    rows += [
        (clean(body.link), str(len(body.members)), *_cells(body.properties))
        for body in lumped.lumps
    ]
    count = str(sum(len(body.members) for body in lumped.lumps))
    rows.append((f"whole, in {clean(lumped.root)}", count, *_cells(lumped.whole)))
    return render_table(rows)


def _cells(properties: SpatialInertia | None) -> tuple[str, ...]:
    if properties is None:
        return ("–",) * (len(_HEADS) - 2)
    values = (properties.mass, *properties.com, *properties.tensor)
    return tuple(f"{value:.4g}" for value in values)


def as_json(lumped: Lumped, robot: Robot) -> str:
    """Format the bodies, the whole and the joint positions as one object."""
    assert robot.source is not None
    found = {
        "version": 1,
        "robot": robot.name,
        "path": robot.source.path,
        "positions": lumped.positions,
        "bodies": [
            {"link": body.link, "links": list(body.members), "properties": _dict(body.properties)}
            for body in lumped.lumps
        ],
        "whole": {"frame": lumped.root, "properties": _dict(lumped.whole)},
        "notes": list(lumped.notes),
    }
    return json_text(found, 1) + "\n"


def _dict(properties: SpatialInertia | None) -> dict[str, Any] | None:
    if properties is None:
        return None
    try:
        return numbers(round_properties(properties))
    except ValueError:  # inconsistent mass properties, which the notes report
        return numbers(properties)
