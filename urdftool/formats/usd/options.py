"""Options of an export to USD."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, get_args

from ..common.actuator_config import KEYS, make_file_option
from ..common.cut import Cutter
from ..common.option import (
    ACTUATORS,
    BASE,
    DECOMPOSE,
    FIX_INERTIA,
    FORCE,
    POSE,
    TIMESTEP,
    Actuators,
    Base,
    FixInertia,
    Overlaps,
    check_options,
    declare,
)

Target = Literal["both", "newton", "isaac"]
Layers = Literal["single", "payload"]
Approximation = Literal["hull", "mesh"]

SUFFIXES = (".usda", ".usdc", ".usdz", ".usd")


@dataclass(frozen=True)
class Options:
    """Options of an export to USD.

    Attributes:
        cutter: Decomposes collision meshes into convex pieces, for ``decompose``.
        state: SRDF group state for the home configuration, or ``stand``; empty for the likeliest.
        file: Name of the stage; empty for the robot's name with ``.usda``.
        overlaps: Finds links that overlap at home, which then never collide; None looks for none.
        proofs: What is known of pairs of the SRDF, by the names of both links, as custom data.
    """

    target: Target = declare(
        "both",
        "Simulator: newton omits attributes of PhysX, isaac adds the schemas of Isaac Sim.",
        words=get_args(Target),
    )
    base: Base = declare("auto", BASE)
    layers: Layers = declare(
        "single",
        "One layer, or a payload with one layer each for geometry, materials and physics.",
        words=get_args(Layers),
    )
    srdf: Path | None = declare(
        None,
        "SRDF file with disabled collisions, virtual joint and group states for the home position.",
        kind=Path,
        metavar="FILE",
    )
    pose: Mapping[str, float] = declare({}, POSE)
    state: str = ""
    actuators: Actuators = declare("auto", ACTUATORS)
    timestep: float | None = declare(None, TIMESTEP)
    self_collision: bool | None = declare(
        None,
        "Whether links collide with each other.  [default: with --srdf or <self_collide>]",
        kind=bool,
    )
    actuator_config: Path | None = declare(None, make_file_option(KEYS[:-1]))
    approximation: Approximation = declare(
        "hull",
        "Collision geometry of a mesh: its convex hull, or its triangles.",
        words=get_args(Approximation),
    )
    decompose: bool = declare(False, DECOMPOSE)
    cutter: Cutter | None = None
    fix_inertia: FixInertia = declare("none", FIX_INERTIA)
    force: bool = declare(False, FORCE)
    file: str = ""

    overlaps: Overlaps | None = None
    proofs: Mapping[frozenset[str], str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raise ConfigError if a value is not allowed."""
        check_options(self)

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return tuple(path for path in (self.srdf, self.actuator_config) if path is not None)

    @property
    def has_physx(self) -> bool:
        """Tell whether attributes of PhysX are written."""
        return self.target != "newton"
