"""MuJoCo, with the MJCF export of the robot.

``world`` steps the model that ``scene`` writes. Contacts are as stiff as the time step allows,
friction does not creep, a diverged state is not reset, and no log is written to the current folder.
"""

from __future__ import annotations

import platform
import sys
from typing import TYPE_CHECKING, ClassVar

from ....mujoco_library import import_mujoco
from ..base import Capabilities, Engine, World

if TYPE_CHECKING:
    from pathlib import Path

    from ....model.elements import Robot
    from ...rigid_bodies import RigidBodyModel
    from ...settings import Settings
    from ..base import ExportMjcf

_MACHINES = {
    "linux": ("x86_64", "aarch64"),
    "darwin": ("x86_64", "arm64"),
    "win32": ("AMD64",),
}


class MuJoCo(Engine):
    """MuJoCo 3 and 4."""

    capabilities: ClassVar[Capabilities] = Capabilities(
        name="mujoco",
        title="MuJoCo",
        library="mujoco",
        wheels="Linux and macOS on x86-64 and ARM, and Windows on x86-64",
        closes_loops=True,
        max_joints=None,
        lumps_fixed_joints=False,
        hull_per_object=False,
        uses_contact_stiffness=False,
        creeps=False,
        holds_massless_root=False,
        loads_leaders=True,
        holds_by="dry friction, then a servo,",
    )

    def has_wheel(self) -> bool:
        """Tell whether MuJoCo has a wheel for this machine; it has wheels for every Python."""
        return platform.machine() in _MACHINES.get(sys.platform, ())

    def write_model(
        self,
        robot: Robot,
        bodies: RigidBodyModel,
        settings: Settings,
        folder: Path,
        export_mjcf: ExportMjcf,
    ) -> None:
        """Write the MJCF export of the robot, in a scene with a plane."""
        from .scene import write_model

        write_model(robot, bodies, settings, folder, export_mjcf)

    def open_world(self, bodies: RigidBodyModel, settings: Settings, folder: Path) -> World:
        """Load the scene, which compiles it."""
        from .world import MuJoCoWorld

        return MuJoCoWorld(import_mujoco("--engine mujoco"), bodies, settings, folder)


ENGINE = MuJoCo()
