"""Options of an export to USD."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from ..common.base import Base
from ..common.cut import Cutter
from ..common.inertia_repair import FixInertia

Target = Literal["both", "newton", "isaac"]
Layers = Literal["single", "payload"]
Approximation = Literal["hull", "mesh"]

SUFFIXES = (".usda", ".usdc", ".usdz", ".usd")


@dataclass(frozen=True)
class Options:
    """Options of an export to USD.

    Attributes:
        target: Simulator whose attributes are written; ``both`` for one stage for all.
        base: Whether the root is fixed to the world; ``auto`` uses the description.
        layers: ``single`` writes one layer; ``payload`` writes a layer that loads others, one each
            for geometry, materials and physics.
        srdf: A MoveIt SRDF, for pairs of links that never collide.
        self_collision: Whether links of the robot collide with each other; None if an SRDF is
            given or the description requests it.
        actuator_config: TOML file with gains, armature, damping, friction and force range.
        approximation: Collision geometry of a mesh: its convex hull, or its triangles.
        cutter: Decomposes collision meshes into convex pieces; None leaves them whole.
        fix_inertia: Repair method for physically inconsistent tensors.
        force: Continue in spite of defects of the source if a robot remains.
        file: Name of the stage; empty for the robot's name with ``.usda``.
    """

    target: Target = "both"
    base: Base = "auto"
    layers: Layers = "single"
    srdf: Path | None = None
    self_collision: bool | None = None
    actuator_config: Path | None = None
    approximation: Approximation = "hull"
    cutter: Cutter | None = None
    fix_inertia: FixInertia = "none"
    force: bool = False
    file: str = ""

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return tuple(path for path in (self.srdf, self.actuator_config) if path is not None)

    @property
    def has_newton(self) -> bool:
        """Tell whether attributes of Newton are written."""
        return True

    @property
    def has_physx(self) -> bool:
        """Tell whether attributes of PhysX are written."""
        return self.target != "newton"
