"""Reading of the world around the robot of a stage: gravity."""

from __future__ import annotations

import math

from pxr import UsdPhysics

from ...model.settings import Settings, Value
from .read_stage import Context, convert_float

_EARTH = 9.81
"""Gravity [m/s²] by default: UsdPhysics says "earth gravity" without a number; chosen."""


def read_world(context: Context) -> Settings:
    """Return the gravity [m/s²] of the first scene of a stage that sets it.

    By the schema of UsdPhysics, a negative magnitude is that of the Earth, and no direction is
    down.
    """
    for prim in context.stage.Traverse():
        scene = UsdPhysics.Scene(prim)
        written = scene.GetGravityMagnitudeAttr(), scene.GetGravityDirectionAttr()
        if not prim.IsA(UsdPhysics.Scene) or not any(one.HasAuthoredValue() for one in written):
            continue
        magnitude, direction = written[0].Get(), [float(part) for part in written[1].Get()]
        amount = convert_float(magnitude, context.length) if 0 <= magnitude < math.inf else _EARTH
        size = math.hypot(*direction)
        x, y, z = (part / size for part in direction) if size > 0 else _get_down(context)
        up = (x, -z, y) if context.is_y_up else (x, y, z)
        place = context.get_written(prim, written[0].GetName())
        return {"gravity": Value(place, tuple(amount * part + 0.0 for part in up))}
    return {}


def _get_down(context: Context) -> tuple[float, float, float]:
    return (0.0, -1.0, 0.0) if context.is_y_up else (0.0, 0.0, -1.0)
