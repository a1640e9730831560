"""Each joint moved through its limits in MuJoCo."""

from __future__ import annotations

from pathlib import Path

from .bodies import Bodies
from .bullet_sweep import sweep_world
from .mj import World, mujoco_module
from .settings import Settings
from .sweep import Swept


def sweep(bodies: Bodies, settings: Settings, folder: Path) -> list[Swept]:
    """Sweep a robot in MuJoCo.

    Args:
        bodies: The robot; ``folder`` holds it as ``mj_file.write_model`` wrote it.
        settings: Where the others are.
        folder: Where the scene is.
    """
    return sweep_world(World(mujoco_module(), bodies, settings, folder), bodies)
