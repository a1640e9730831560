"""Options of an MJCF export."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ...model.elements import Robot
from ..common.base import Base
from ..common.cut import Cutter
from ..common.inertia_repair import FixInertia

Actuators = Literal["auto", "none", "position", "velocity", "motor"]
Exclude = Literal["touching", "adjacent", "none"]

Overlap = Callable[[Robot, Mapping[str, float], str, str], float | None]
"""Measures the penetration depth [m] of the authored collision geometry of two links in a pose.

It returns None if neither link has a mesh, so that MuJoCo's own depth is exact.
"""


@dataclass(frozen=True)
class Options:
    """Options of an MJCF export.

    Attributes:
        actuators: Kind of actuators; ``auto`` uses transmissions, ros2_control and drive plugins.
        base: Whether the root is fixed; ``auto`` uses the description, then what supports the
            robot.
        scene: Also write a scene with floor and light around the robot.
        srdf: A MoveIt SRDF, for disabled collisions, group states and virtual joint.
        fix_inertia: Repair method for physically inconsistent tensors.
        force: Continue in spite of defects of the source if a robot remains.
        mesh_dir: Folder of the meshes, relative to the model.
        file: Name of the model file; empty for the robot's name, with ``scene.xml`` next to it.
        cutter: Decomposes collision meshes that are not convex; None leaves them whole.
        keep_locked_joints: Keep a joint with equal limits, held by an equality, instead of welding
            its link.
        pose: Joint positions by name [rad, m] at home.
        base_sensors: Add velocity, gyro, accelerometer and orientation sensors of a free base.
        state: SRDF group state for the home configuration; empty for the likeliest.
        actuator_config: TOML file with gains, armature and damping of joints.
        exclude: Pairs of links that never collide: ``adjacent`` for those that a joint connects,
            ``touching`` also for those that overlap at home in MuJoCo.
        fuse: Merge each rigidly attached link into its parent, and keep its frame as a site.
        overlap: Measures authored geometry, to distinguish overlaps of convex hulls; None skips the
            search for overlaps unless ``exclude`` requires it.
        armature: Rotor inertia [kg·m² or kg] of every joint for which the file sets none.
    """

    actuators: Actuators = "auto"
    base: Base = "auto"
    scene: bool = False
    srdf: Path | None = None
    fix_inertia: FixInertia = "none"
    force: bool = False
    mesh_dir: str = "assets"
    file: str = ""
    cutter: Cutter | None = None
    keep_locked_joints: bool = False
    pose: Mapping[str, float] = field(default_factory=dict)
    state: str = ""
    base_sensors: bool = False
    actuator_config: Path | None = None
    armature: float | None = None
    exclude: Exclude = "adjacent"
    fuse: bool = False
    overlap: Overlap | None = None

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return tuple(path for path in (self.srdf, self.actuator_config) if path is not None)
