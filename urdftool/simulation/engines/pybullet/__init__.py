"""PyBullet, without its silent defaults.

``world`` steps the URDF that ``urdf`` writes. Turned off are: tensors computed from shapes instead
of the file, a motor on every joint, resistance that is not in the file, faceted cylinders, a fixed
base if the base has no mass, locked joints without limits, and limits that heavy loads exceed.
"""

from __future__ import annotations

import platform
import sys
from typing import TYPE_CHECKING, ClassVar

from ..base import Capabilities, Engine, World

if TYPE_CHECKING:
    from pathlib import Path

    from ....model.elements import Robot
    from ...rigid_bodies import RigidBodyModel
    from ...settings import Settings
    from ..base import ExportMjcf


class PyBullet(Engine):
    """PyBullet 3."""

    capabilities: ClassVar[Capabilities] = Capabilities(
        name="pybullet",
        title="PyBullet",
        library="pybullet",
        wheels="Linux on x86-64 with Python 3.10 and 3.11",
        closes_loops=False,
        max_joints=120,  # its messages hold 128 degrees of freedom; the root has seven
        lumps_fixed_joints=True,
        hull_per_object=True,
        uses_contact_stiffness=True,
        creeps=True,
        holds_massless_root=True,
        loads_leaders=False,
        holds_by="position motors",
    )

    def has_wheel(self) -> bool:
        """Tell whether PyBullet has a wheel for this Python and machine."""
        is_linux = sys.platform == "linux" and platform.machine() == "x86_64"
        return is_linux and sys.version_info[:2] < (3, 12)

    def write_model(
        self,
        robot: Robot,
        bodies: RigidBodyModel,
        settings: Settings,
        folder: Path,
        export_mjcf: ExportMjcf,
    ) -> None:
        """Write the rigid bodies as URDF, and their hulls as OBJ."""
        from .urdf import write_folder

        write_folder(bodies, folder)

    def open_world(self, bodies: RigidBodyModel, settings: Settings, folder: Path) -> World:
        """Load the URDF."""
        from .world import PyBulletWorld, import_pybullet

        return PyBulletWorld(import_pybullet(), bodies, settings, folder)


ENGINE = PyBullet()
