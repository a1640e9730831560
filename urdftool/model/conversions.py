"""Methods of a robot that convert it for other libraries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import trimesh


class RobotConversions:
    """Base of ``Robot`` with its conversions."""

    def to_scene(
        self, positions: Mapping[str, float] | None = None, *, collision: bool = False
    ) -> trimesh.Scene:
        """Return a scene of trimesh, with a node named after each link.

        Args:
            positions: Joint positions by name [rad, m]; mimic joints follow. 0 by default.
            collision: Whether the scene has the collision geometry in place of the visual one.

        Raises:
            UrdftoolError: A mesh cannot be found or read.
        """
        scene: trimesh.Scene = _call("to_scene", self, positions, collision=collision)
        return scene

    def to_yourdfpy(self, **options: Any) -> Any:
        """Return a ``yourdfpy.URDF``, with xacro expanded and every mesh resolved.

        Args:
            options: Arguments of ``yourdfpy.URDF``, such as ``load_collision_meshes=True``.

        Raises:
            ModelError: The robot was read from another format.
            MissingDependency: yourdfpy is not installed.
        """
        return _call("to_yourdfpy", self, **options)


def _call(name: str, robot: object, *arguments: Any, **options: Any) -> Any:
    """Call a function of the Python API, which is above the model and imported on demand."""
    from importlib import import_module

    return getattr(import_module("urdftool.api.scene"), name)(robot, *arguments, **options)
