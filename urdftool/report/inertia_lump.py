"""Mass properties of rigid bodies and the whole robot: a table and JSON."""

from __future__ import annotations

from typing import Any

from ..control_characters import escape_controls
from ..inertia.lump import Lumped
from ..inertia.rounding import round_properties
from ..mechanics.spatial_inertia import SpatialInertia
from ..model.elements import Robot
from ..model.link import COMPONENTS
from .inertia import build_numbers
from .json_text import format_json
from .tables import render_table

_HEADS = ("body", "links", "mass [kg]", "com x", "y", "z [m]", *COMPONENTS[:5], "izz [kg m²]")


def format_table(lumped: Lumped) -> str:
    """Format a row for each rigid body in the frame of its first link, and one for the whole."""
    rows: list[tuple[str, ...]] = [_HEADS]
    rows += [
        (escape_controls(body.link), str(len(body.members)), *_format_cells(body.properties))
        for body in lumped.lumps
    ]
    count = str(sum(len(body.members) for body in lumped.lumps))
    rows.append((f"whole, in {escape_controls(lumped.root)}", count, *_format_cells(lumped.whole)))
    return render_table(rows)


def _format_cells(properties: SpatialInertia | None) -> tuple[str, ...]:
    if properties is None:
        return ("–",) * (len(_HEADS) - 2)
    values = (properties.mass, *properties.com, *properties.tensor)
    return tuple(f"{value:.4g}" for value in values)


def as_json(lumped: Lumped, robot: Robot) -> str:
    """Format the bodies, the whole and the joint positions as one object."""
    assert robot.source is not None
    record = {
        "version": 1,
        "robot": robot.name,
        "path": robot.source.path,
        "positions": lumped.positions,
        "bodies": [
            {
                "link": body.link,
                "links": list(body.members),
                "properties": _build_dict(body.properties),
            }
            for body in lumped.lumps
        ],
        "whole": {"frame": lumped.root, "properties": _build_dict(lumped.whole)},
        "notes": [note.message for note in lumped.notes],
    }
    return format_json(record, 1) + "\n"


def _build_dict(properties: SpatialInertia | None) -> dict[str, Any] | None:
    if properties is None:
        return None
    try:
        return build_numbers(round_properties(properties))
    except ValueError:  # inconsistent mass properties, which the notes report
        return build_numbers(properties)
