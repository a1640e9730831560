"""Read a robot from a file of any format."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..arguments import check_arguments
from ..errors import ConfigError
from ..formats.detect import read_other_format
from ..model.elements import Robot
from ..model.load import make_robot
from ..source.description import GltfUp, read_description
from ..source.document import STDIN, read_file
from ..source.packages import Packages
from .places import check_places


@check_arguments
def load(
    path: str | Path,
    *,
    args: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    gltf_up: GltfUp = "y",
    name: str = "",
) -> Robot:
    """Read a robot from a file: URDF, xacro, SDF, MJCF or USD, by its first bytes.

    The robot may be invalid in any way that leaves its XML well-formed; :func:`urdftool.check`
    reports its defects. SDF and MJCF are stricter: a joint must name links that exist, and MuJoCo
    must compile the model. ``robot.unread`` lists what the robot does not hold of such a file.

    Args:
        path: A description, or ``-`` for standard input.
        args: Values of xacro arguments.
        packages: Folders of ROS packages by name; others are searched as on the command line.
            A folder that does not exist is a ``UserWarning``.
        package_paths: Folders that contain ROS packages.
        gltf_up: Up axis of glTF meshes: ``"y"`` as in their standard, rotated to Z as in RViz;
            ``"z"`` for files made for readers that keep the axes of the file.
        name: Model of an SDF file, or articulation of a USD stage, that has several; empty for
            that with most joints or bodies.

    Raises:
        ConfigError: An option has a value that is not allowed.
        SourceError: The file cannot be read, parsed or expanded.
        ModelError: It is not a robot description.
        MissingDependency: It is MJCF, and MuJoCo is not installed.
    """
    paths = check_places(packages, package_paths, gltf_up=gltf_up)
    file = read_file(path)
    finder = Packages(None if file.path == STDIN else file.path, named=packages or {}, paths=paths)
    robot = read_other_format(file, finder, name)
    if robot is None:
        if name:
            raise ConfigError("name is for SDF and USD files; a URDF has one robot", path=path)
        return make_robot(
            read_description(
                path, args, packages=packages, package_paths=paths, file=file, gltf_up=gltf_up
            )
        )
    if robot.source is not None:
        robot.source.gltf_up = gltf_up
    return robot
