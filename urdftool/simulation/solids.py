"""Unions of convex parts, and the volume that two of them share."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..geometry.convex_points import select_extreme_points
from ..geometry.hull import compute_convex_hull, load_manifold
from ..model.pose import Pose
from .recording import Array

if TYPE_CHECKING:
    from manifold3d import Manifold


class Solids:
    """Union of convex parts in one frame."""

    def __init__(self, parts: Iterable[Manifold]) -> None:
        """Store the parts."""
        self.parts = list(parts)

    def __bool__(self) -> bool:
        """Tell whether there is any part."""
        return bool(self.parts)

    def __or__(self, other: Solids) -> Solids:
        """Return the parts of both."""
        return Solids([*self.parts, *other.parts])

    def transform(self, pose: Pose) -> Solids:
        """Transform the parts to another frame, in which the present one has the given pose."""
        if not self.parts:
            return self
        there = np.column_stack([np.array(pose.rotation), np.array(pose.translation)])
        moved = Solids([self._union.transform(there)])  # the union is computed once
        moved.volume = self.volume
        return moved

    @cached_property
    def volume(self) -> float:
        """Compute the volume of the union [m³]."""
        return float(self._union.volume())

    def compute_shared_volume(self, other: Solids) -> float:
        """Compute the volume that two unions share [m³]."""
        return float((self._union ^ other._union).volume())

    @cached_property
    def _union(self) -> Manifold:
        manifold = load_manifold()
        from manifold3d import OpType

        if len(self.parts) == 1:
            return self.parts[0]
        return manifold.batch_boolean(self.parts, OpType.Add) if self.parts else manifold()


def find_outermost(clouds: Iterable[Array]) -> list[Array]:
    """Choose the outermost points of each cloud, whose hull is nearly that of all its points."""
    return [select_extreme_points(points) for points in clouds]


def compute_hulls(clouds: Iterable[Array]) -> Solids:
    """Compute the convex hulls of point clouds [m]; flat clouds, without volume, are skipped.

    Pass large clouds through :func:`find_outermost`. Results are not kept in the memo of a robot:
    manifold3d prints a warning for each hull that exists when Python ends.
    """
    found = map(compute_convex_hull, clouds)
    return Solids(part for part in found if part is not None)
