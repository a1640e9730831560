"""What a robot tells MuJoCo's compiler."""

from __future__ import annotations

from ..model.elements import Robot


def keeps_visuals(robot: Robot) -> bool:
    """Return whether MuJoCo compiles the visuals of a robot, which it discards otherwise."""
    return any(
        (compiler.get("discardvisual") or "").strip() == "false"
        for mujoco in robot.element.all("mujoco")
        for compiler in mujoco.all("compiler")
    )
