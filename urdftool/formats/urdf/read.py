"""Read a robot from URDF or xacro."""

from __future__ import annotations

from ...model.load import load as read

__all__ = ("read",)
