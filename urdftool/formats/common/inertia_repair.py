"""What may become of an inertia tensor that no rigid body has, in either language."""

from __future__ import annotations

from typing import Literal

FixInertia = Literal["none", "lift", "balance", "box"]
"""Refuse it; take the nearest that a body has; a ball's of the same mean; a box's of its size."""

REPAIRS: tuple[FixInertia, ...] = ("none", "lift", "balance", "box")
