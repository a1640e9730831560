"""What one can choose of an MJCF export."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ...model.elements import Robot
from ..common.inertia_repair import FixInertia
from .cut import Cutter

Actuators = Literal["auto", "none", "position", "velocity", "motor"]
Base = Literal["auto", "fixed", "free"]
Exclude = Literal["touching", "adjacent", "none"]

Overlap = Callable[[Robot, Mapping[str, float], str, str], float | None]
"""Measures how deep the collision geometry of two links, as written, overlaps [m] in a pose."""


@dataclass(frozen=True)
class Options:
    """The choices of one export.

    Attributes:
        actuators: Of what kind; ``auto`` is what transmissions and ros2_control say.
        base: Whether the root is held; ``auto`` is what the description says, else held.
        scene: Write also a scene with floor and light around the robot.
        srdf: A MoveIt SRDF whose disabled collisions are taken over.
        fix_inertia: What becomes of a tensor that no rigid body has.
        force: Go past defects of the source where a robot is left.
        mesh_dir: Folder of the meshes, relative to the model.
        file: Name of the model's file; empty for the robot's with ``scene.xml`` beside it.
        cutter: Cuts meshes that collide and are not convex into pieces; None leaves them whole.
        keep_locked_joints: Keep a joint with equal limits, held by an equality, where its link
            would be welded.
        pose: Positions of joints by name [rad, m] in the home position.
        base_sensors: Add the velocity, gyro, accelerometer and orientation of a free base.
        state: The group state of the SRDF that is the home position; empty for the likeliest.
        actuator_config: A TOML file with gains, armature and losses of joints.
        exclude: Pairs of links that never collide: ``adjacent`` are those that a joint joins,
            ``touching`` also those that overlap at home, which MuJoCo is asked for.
        fuse: Merge each link that is fixed to another into it, and keep its frame as a site.
        overlap: Measures authored geometry, to tell an overlap of convex hulls; None does not
            look for overlaps unless ``exclude`` asks for them.
        armature: Rotor inertia [kg·m² or kg] added to every joint that the file says nothing of.
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
        """Return the files that are read beside the robot."""
        return tuple(path for path in (self.srdf, self.actuator_config) if path is not None)
