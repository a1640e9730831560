"""Methods of a robot that convert it for other libraries."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
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
            ModelError: The robot lacks a joint of ``positions``.
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

    def attach(self, other: RobotConversions, **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.attach``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("attach", self, other, **options)

    def prefix(self, text: str, **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.prefix``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("prefix", self, text, **options)

    def merge_fixed(self, **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.merge_fixed``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("merge_fixed", self, **options)

    def change_root(self, link: str, **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.change_root``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("change_root", self, link, **options)

    def mirror(self, plane: str = "xz", **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.mirror``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("mirror", self, plane, **options)

    def change_zero(self, positions: Mapping[str, float], **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.change_zero``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("change_zero", self, positions, **options)

    def reverse_sign(self, joints: Iterable[str], **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.reverse_sign``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("reverse_sign", self, joints, **options)

    def cut(self, link: str, **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.cut``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("cut", self, link, **options)

    def round_numbers(self, tolerance: float = 1e-9, **options: Any) -> Any:
        """Return the robot after ``urdftool.api.edit.round_numbers``, which lists the options.

        The result has the new ``robot``, ``is_proved``, ``proofs``, ``notes`` and ``write(path)``.
        """
        return _call_edit("round_numbers", self, tolerance, **options)


def _call(name: str, robot: object, *arguments: Any, **options: Any) -> Any:
    """Call a function of the Python API, which is above the model and imported on demand."""
    from importlib import import_module

    return getattr(import_module("urdftool.api.scene"), name)(robot, *arguments, **options)


def _call_edit(name: str, robot: object, *arguments: Any, **options: Any) -> Any:
    """Call an operation on robots, as :func:`_call`."""
    from importlib import import_module

    return getattr(import_module("urdftool.api.edit"), name)(robot, *arguments, **options)
