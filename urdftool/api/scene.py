"""``Robot.to_scene`` and ``Robot.to_yourdfpy``: robots for other libraries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..arguments import check_arguments
from ..model.elements import Robot

if TYPE_CHECKING:
    import trimesh


@check_arguments
def to_scene(
    robot: Robot, positions: Mapping[str, float] | None = None, *, collision: bool = False
) -> trimesh.Scene:
    """Return a robot as a scene of trimesh, with a node named after each link.

    Args:
        robot: The robot.
        positions: Joint positions by name [rad, m]; mimic joints follow. 0 by default.
        collision: Whether the scene has the collision geometry in place of the visual one.

    Raises:
        ModelError: The robot lacks a joint of ``positions``, or a position is not a finite number.
        UrdftoolError: A mesh cannot be found or read.
    """
    from ..geometry.scene import make_scene

    return make_scene(robot, positions, collision=collision)


def to_yourdfpy(robot: Robot, **options: Any) -> Any:
    """Return a robot as a ``yourdfpy.URDF``, with xacro expanded and every mesh resolved.

    Args:
        robot: A robot that was read from URDF or xacro.
        options: Arguments of ``yourdfpy.URDF``, such as ``load_collision_meshes=True``.

    Raises:
        ModelError: The robot was read from another format.
        MissingDependency: yourdfpy is not installed.
    """
    from ..bundle.yourdfpy_reader import load_robot

    return load_robot(robot, **options)
