"""A file to a robot, in one step."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..errors import ModelError
from ..source.description import Description, GltfUp, read_description
from .elements import Robot
from .read import read_robot


def robot_of(description: Description) -> Robot:
    """The robot of a description.

    Raises:
        ModelError: Its root element is not ``<robot>``.
    """
    root = description.document.root
    if root.tag != "robot":
        raise ModelError(
            f"the root element is <{root.tag}>; a robot description starts with <robot>",
            at=root.place,
        )
    robot = read_robot(root)
    robot.source = description
    return robot


def read_again(robot: Robot) -> Robot:
    """Return a robot as its description has it, whatever became of this one since it was read."""
    return robot if robot.source is None else robot_of(robot.source)


def without_links(robot: Robot) -> str:
    """What is said of a robot that has no link, as a file of macros has none; else empty."""
    if robot.links:
        return ""
    macros = robot.source is not None and robot.source.expansion is not None
    what = "name a file that calls its macros" if macros else "write at least one"
    return f"the robot has no link; {what}"


def require_links(robot: Robot) -> Robot:
    """The robot, which is to have a link.

    Raises:
        ModelError: It has none.
    """
    if wrong := without_links(robot):
        raise ModelError(wrong, at=robot.place)
    return robot


def load(
    path: str | Path,
    *,
    args: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    gltf_up: GltfUp = "y",
) -> Robot:
    """Read a robot from a URDF or xacro file.

    The robot may be broken in any way that leaves its XML well-formed; :func:`urdftool.check` says
    what is wrong with it.

    Args:
        path: A ``.urdf`` or ``.xacro`` file, or ``-`` for standard input.
        args: Values for its xacro arguments.
        packages: Folders of ROS packages by name; others are found as on the command line.
        package_paths: Folders with ROS packages below.
        gltf_up: The axis that is up in glTF meshes: ``"y"`` by their standard, which RViz turns
            to Z; ``"z"`` where they are made for readers that keep the axes of the file.

    Raises:
        SourceError: The file cannot be read, parsed or expanded.
        ModelError: It is not a robot description.
    """
    description = read_description(
        path, args, packages=packages, package_paths=package_paths, gltf_up=gltf_up
    )
    return robot_of(description)
