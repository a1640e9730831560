"""Check of a robot by the rules."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..arguments import check_arguments
from ..errors import ConfigError
from ..finding import Finding
from ..formats.detect import read_other_format
from ..lint.group import group
from ..lint.options import Options
from ..lint.run import check_file, check_robot, warn_of_renamed
from ..lint.settings import Settings, check_selectors, check_targets
from ..model.elements import Robot
from ..source.description import GltfUp
from .places import check_places, list_words


@check_arguments
def check(
    robot: Robot | str | Path,
    *,
    args: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    select: Iterable[str] | None = None,
    ignore: Iterable[str] = (),
    targets: Iterable[str] = (),
    config: str | None = None,
    fixes: bool = False,
    gltf_up: GltfUp | None = None,
    grouped: bool = False,
) -> list[Finding]:
    """Check a robot and return the findings in the order of the source.

    Args:
        robot: A robot from :func:`urdftool.load`, or the path of a description in any format that
            can be read. For a URDF, a file that is not well-formed or cannot be expanded is a
            finding too, an error with ``unchecked`` if nothing else of the robot could be checked.
        args: Values of xacro arguments, for a path.
        packages: Folders of ROS packages by name, for a path.
        package_paths: Folders that contain ROS packages, for a path.
        select: Rule names, prefixes with ``*`` and families; None selects the default rules.
        ignore: Rule names, prefixes and families to exclude.
        targets: Simulators and middleware; if empty, they are inferred.
        config: Configuration file; None uses the nearest one above the description.
        fixes: Whether to compute the ``fix`` of each finding, as bytes of the source.
        gltf_up: Up axis of glTF meshes, for a path; None uses the configuration.
        grouped: Whether to merge equal findings of many links or files to one with ``members``,
            and to nest ``consequences`` of another finding, as in ``urdftool lint``.

    Raises:
        SourceError: The file cannot be read.
        ModelError: A file of another format than URDF is not a robot description.
        ConfigError: A rule, target or option is unknown.
    """
    paths = check_places(packages, package_paths, gltf_up=gltf_up)
    chosen = None if select is None else list_words("select", select)
    ignored = list_words("ignore", ignore)
    line = Settings(
        select=None if chosen is None else check_selectors(chosen),
        ignore=check_selectors(ignored),
        targets=check_targets(list_words("targets", targets)),
    )
    if isinstance(robot, Robot):
        if robot.source is None:
            raise ConfigError("the robot was not read from a description; use urdftool.load")
        report = check_robot(robot, Options(line, config=config, fixes=fixes))
    else:
        options = Options(line, args or {}, packages or {}, paths, config)
        options.fixes, options.gltf_up, options.read_other = fixes, gltf_up, read_other_format
        report = check_file(robot, options)
        if report.error is not None:
            raise report.error
    warn_of_renamed((*(chosen or ()), *ignored), report.path, config)
    if not grouped:
        return report.findings
    return group(report.findings)
