"""Reading a robot from a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..errors import ModelError
from ..source.description import Description, GltfUp, read_description
from ..source.document import Element
from .elements import Robot
from .read import read_robot


def make_robot(description: Description) -> Robot:
    """Return the robot of a description.

    Raises:
        ModelError: The root element is not ``<robot>``.
    """
    root = description.document.root
    if root.tag != "robot":
        raise ModelError(describe_root(root), at=root.place)
    robot = read_robot(root)
    robot.source = description
    return robot


def describe_root(root: Element) -> str:
    """Describe a root that is not ``<robot>``, and the probable format of the file."""
    remedy = "a robot description starts with <robot>"
    if is_old_sdf(root):
        remedy = OLD_SDF
    return f"the root element is <{root.tag}>; {remedy}"


OLD_SDF = "that is SDF before 1.4, which is not read; later versions start with <sdf>"


def is_old_sdf(root: Element) -> bool:
    """Tell whether a root is that of SDF before 1.4: ``<gazebo version="1.0">``."""
    return root.tag == "gazebo" and root.get("version") is not None


def read_again(robot: Robot) -> Robot:
    """Return the robot as its description defines it, without later modifications.

    A robot in another format than URDF is returned as it is.
    """
    if robot.source is None or robot.format != "urdf":
        return robot
    return make_robot(robot.source)


def load(
    path: str | Path,
    *,
    args: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    gltf_up: GltfUp = "y",
) -> Robot:
    """Read a robot from a URDF or xacro file; the arguments are those of :func:`urdftool.load`.

    Raises:
        SourceError: The file cannot be read, parsed or expanded.
        ModelError: It is not a robot description.
    """
    description = read_description(
        path, args, packages=packages, package_paths=package_paths, gltf_up=gltf_up
    )
    return make_robot(description)
