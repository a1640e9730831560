"""Options of an MJCF export."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, get_args

from ...model.elements import Robot
from ..common.actuator_config import make_file_option
from ..common.cut import Cutter
from ..common.option import (
    ACTUATORS,
    BASE,
    DECOMPOSE,
    FIX_INERTIA,
    FORCE,
    MESH_FOLDER,
    POSE,
    TIMESTEP,
    Actuators,
    Base,
    FixInertia,
    check_options,
    declare,
)

Exclude = Literal["touching", "adjacent", "none"]

Purpose = Literal["", "rl"]

Overlap = Callable[[Robot, Mapping[str, float], str, str], float | None]
"""Measures the penetration depth [m] of the authored collision geometry of two links in a pose.

It returns None if neither link has a mesh, so that MuJoCo's own depth is exact.
"""


@dataclass(frozen=True)
class Options:
    """Options of an MJCF export.

    Attributes:
        file: Name of the model file; empty for the robot's name, with ``scene.xml`` next to it.
        cutter: Decomposes collision meshes that are not convex, for ``decompose``.
        state: SRDF group state for the home configuration, or ``stand``; empty for the likeliest.
        overlap: Measures authored geometry, to distinguish overlaps of convex hulls; None skips the
            search for overlaps unless ``exclude`` requires it.
        proofs: What is known of pairs of the SRDF, by the names of both links, as comments.
    """

    actuators: Actuators = declare("auto", ACTUATORS)
    timestep: float | None = declare(None, TIMESTEP)
    base: Base = declare("auto", BASE)
    scene: bool = declare(False, "Also write scene.xml with a floor and a light.", kind=bool)
    srdf: Path | None = declare(
        None,
        "SRDF file with disabled collisions and group states for the home position.",
        kind=Path,
        metavar="FILE",
    )
    fix_inertia: FixInertia = declare("none", FIX_INERTIA)
    force: bool = declare(False, FORCE)
    mesh_dir: str = declare("assets", MESH_FOLDER)
    file: str = ""
    decompose: bool = declare(False, DECOMPOSE)
    cutter: Cutter | None = None
    keep_locked_joints: bool = declare(
        False,
        "Keep joints with lower = upper, held by an equality (default: weld their links).",
        kind=bool,
    )
    pose: Mapping[str, float] = declare({}, POSE)
    state: str = ""
    base_sensors: bool = declare(
        False,
        "Add missing sensors of a free base: linear velocity, gyro, accelerometer, orientation.",
        kind=bool,
    )
    actuator_config: Path | None = declare(None, make_file_option())
    armature: float | None = declare(
        None,
        "Rotor inertia reflected at every joint [kg·m², or kg for prismatic joints].",
        kind=float,
        metavar="VALUE",
        minimum=0,
    )
    exclude: Exclude = declare(
        "adjacent",
        "Link pairs without contacts: adjacent (joined by a joint), touching (also those that "
        "overlap at home), or none (only those of --srdf).",
        words=get_args(Exclude),
        metavar="PAIRS",
        offered="touching",  # compiles the model to find them
    )
    purpose: Purpose = declare(
        "",
        "Complete the model for a purpose: rl adds --base-sensors, --fuse, sensors of joints, "
        "servos in place of motors, armature and friction loss by effort limit, and contacts "
        "of feet with condim 6 and priority 1.",
        words=get_args(Purpose)[1:],
        flag="for",
        metavar="PURPOSE",
    )
    fuse: bool = declare(
        False,
        "Merge links of fixed joints into their parents; their frames become sites.",
        kind=bool,
    )
    overlap: Overlap | None = None
    proofs: Mapping[frozenset[str], str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raise ConfigError if a value is not allowed."""
        check_options(self)

    def complete(self) -> Options:
        """Return the options with those that the purpose switches on."""
        if self.purpose != "rl":
            return self
        return replace(self, base_sensors=True, fuse=True)

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return tuple(path for path in (self.srdf, self.actuator_config) if path is not None)
