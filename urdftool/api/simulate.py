"""``urdftool.simulate``: simulation of a robot that settles on a plane."""

from __future__ import annotations

from ..model.elements import Robot
from ..simulation.settings import Settings
from ..simulation.verdict import Verdict


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
    from ..simulation.run import simulate as run
    from ..simulation.scene import take_robot
    from ..simulation.settings import Settings
    from ..simulation.verdict import judge

    engine = engine or choose_default_engine()
    if engine not in REGISTRY:
        raise ConfigError(f"there is no engine '{engine}'; there are {' and '.join(REGISTRY)}")
    check_engines((engine,))
    require("simulate", "scipy", "manifold3d")
    robot, _ = take_robot(robot)
    runs = run(robot, settings or Settings(), engine=engine, precompute=precompute_overlaps)
    return [judge(robot, one) for one in runs]
