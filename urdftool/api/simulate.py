"""``urdftool.simulate``: simulation of a robot that settles on a plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..arguments import check_arguments
from ..model.elements import Robot
from ..simulation.settings import Settings
from ..simulation.verdict import Verdict
from .places import check_settings
from .start import choose_start

if TYPE_CHECKING:
    from ..simulation.engines.base import ModelFiles
    from ..simulation.run import Run


@check_arguments
def simulate(
    robot: Robot, settings: Settings | None = None, *, engine: str | None = None
) -> list[Verdict]:
    """Spawn a robot above a plane, let it settle, and evaluate the result.

    Args:
        robot: A robot from ``load``. Of a scene in SDF or MJCF, the free part with most joints is
            simulated, without other parts and planes of the world.
        settings: Spawn pose, duration and other settings; None simulates 5 s with each joint held
            at zero.
        engine: ``"pybullet"`` or ``"mujoco"``; None uses PyBullet, or MuJoCo where PyBullet has no
            binary package.

    Returns:
        A verdict for each trial.

    Raises:
        ConfigError: The engine is unknown.
        MissingDependency: The engine is not installed.
        ModelError: The robot cannot be simulated: it has two roots or no link with mass, or the
            settings name an unknown joint or link.
        MeshError: A collision mesh cannot be read.
    """
    from ..errors import ConfigError
    from ..extras import require
    from ..simulation.checks.interpenetration import precompute_overlaps
    from ..simulation.engines.registry import REGISTRY, check_engines, choose_default_engine
    from ..simulation.scene import take_robot
    from ..simulation.settings import Settings
    from ..simulation.verdict import judge
    from ..suggestions import suggest_name

    check_settings(settings, Settings)
    engine = engine or choose_default_engine()
    if engine not in REGISTRY:
        hint = suggest_name(engine, REGISTRY)
        raise ConfigError(
            f"there is no engine '{engine}'; there are {' and '.join(REGISTRY)}{hint}"
        )
    check_engines((engine,))
    require("simulate", "scipy", "manifold3d")
    robot, _ = take_robot(robot)
    runs = run_trials(robot, settings or Settings(), engine=engine, precompute=precompute_overlaps)
    return [judge(robot, one) for one in runs]


def run_trials(robot: Robot, settings: Settings, **options: Any) -> list[Run]:
    """Run the trials of a robot from its home, in MuJoCo with its export as MJCF.

    Args:
        robot: The robot, read from a description.
        settings: Settings of the simulation.
        options: Other arguments of ``simulation.run.simulate``.
    """
    from ..simulation.run import simulate

    settings, _ = choose_start(robot, settings)
    return simulate(robot, settings, export_mjcf=export_mjcf, **options)


def export_mjcf(robot: Robot, fixed: bool) -> ModelFiles:
    """Export a robot as MJCF without actuators, with a position of each joint.

    Raises:
        Refused: It has defects past which no MJCF can be written.
    """
    from ..formats.mjcf.options import Options
    from ..formats.mjcf.write import write

    options = Options(
        actuators="none",
        base="fixed" if fixed else "free",
        file="robot.xml",
        force=True,
        keep_locked_joints=True,  # each joint of the file has a position to record
    )
    return write(robot, options)
