"""``urdftool srdf --moveit``: a MoveIt configuration package, checked before it is written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console
from ..srdf.moveit.distributions import DEFAULT, DISTRIBUTIONS
from .srdf_groups import describe_group

if TYPE_CHECKING:
    from ..finding import Finding
    from ..model.elements import Robot
    from ..srdf.groups import GivenGroup
    from ..srdf.moveit.configuration import Configuration
    from ..srdf.moveit.existing_srdf import DecidePairs, SrdfChanges
    from ..srdf.moveit.package import PackageFiles
    from ..srdf.moveit.plan import MakeSrdf

F = TypeVar("F", bound=Callable[..., Any])

_PAIR_RULES = ("disabled-pair-can-touch", "adjacent-through-bare-link", "pair-never-touches")
"""Rules that decide the pairs of an SRDF."""


def add_moveit_options(function: F) -> F:
    """Add ``--moveit``, the folder of a package, and ``--ros``, a distribution."""
    function = click.option(
        "--ros",
        "distribution",
        type=click.Choice(list(DISTRIBUTIONS)),
        default=DEFAULT,
        show_default=True,
        help="ROS 2 distribution of the MoveIt package; it decides the controller of a gripper.",
    )(function)
    return click.option(
        "--moveit",
        type=click.Path(file_okay=False, path_type=Path),
        metavar="DIR",
        help="Write a MoveIt configuration package. Files that exist are kept; parameter files get "
        "the keys that they lack, and the SRDF is updated.",
    )(function)


def write_package(
    console: Console,
    robot: Robot,
    folder: Path,
    distribution: str,
    makers: tuple[MakeSrdf, DecidePairs],
    given: tuple[GivenGroup, ...],
    packages: Mapping[str, str | Path],
    package_paths: tuple[str, ...],
) -> int:
    """Write a MoveIt configuration package, check it with the rules, and report both.

    Returns:
        The exit code: 1 if the rules find an error or a warning, or the SRDF is not complete.
    """
    from ..output import check_folder
    from ..srdf.moveit.plan import plan_package
    from ..storage import write_files

    check_folder(folder.resolve(), folder)
    configuration, files = plan_package(robot, folder, distribution, *makers, given)
    findings = check_package(configuration, files, packages, package_paths)
    changed = {folder / file.path: file.data for file in files.files if file.data != file.before}
    write_files(changed)
    _report(console, configuration, files)
    incomplete = files.srdf is not None and files.srdf.is_incomplete
    return max(_report_findings(console, findings), int(incomplete))


def check_package(
    configuration: Configuration,
    files: PackageFiles,
    packages: Mapping[str, str | Path],
    package_paths: tuple[str, ...],
) -> list[Finding]:
    """Check the robot, the SRDF and the parameter files of a package that is not written yet."""
    from ..lint.group import group
    from ..lint.options import Options
    from ..lint.run import check_file
    from ..lint.settings import Settings, check_selectors, check_targets
    from ..workspace import Workspace

    folder = files.folder.resolve()
    overlay = {str(folder / file.path): file.data for file in files.files}
    settings = Settings(
        select=check_selectors(["moveit", "control"]),
        ignore=check_selectors(_PAIR_RULES if _has_decided_pairs(files) else ()),
        targets=check_targets(["moveit", "ros2"]),
    )
    known = {**packages, **_find_description_package(configuration)}
    options = Options(settings, {}, known, package_paths)
    options.workspace = Workspace(overlay)
    path = folder / "config" / f"{configuration.stem}.urdf.xacro"
    report = check_file(path, options)
    if report.error is not None:
        raise report.error
    return group(report.findings)


def _has_decided_pairs(files: PackageFiles) -> bool:
    """Tell whether the pairs of the SRDF were decided now."""
    return files.srdf is None or files.srdf.pairs is not None


def _find_description_package(configuration: Configuration) -> dict[str, str | Path]:
    """Return the folder of the description by its package; its own folder counts as one."""
    source = configuration.robot.source
    if source is None:
        return {}
    name, folder = source.packages.own or ("description", Path(source.path).resolve().parent)
    return {name: folder}


def _report(console: Console, configuration: Configuration, files: PackageFiles) -> None:
    new = [file for file in files.files if file.before is None]
    edited = [file for file in files.files if file.before not in (None, file.data)]
    kept = [file for file in files.files if file.before == file.data]
    console.print_note(
        f"{files.folder}: {len(new)} files are new, {len(edited)} completed, {len(kept)} kept"
    )
    for file in edited:
        for key in file.added:
            console.print_note(f"{files.folder / file.path}: added {key}")
    if files.srdf is not None:
        _report_srdf(console, files.folder / files.files[0].path, files.srdf)
    if not configuration.description.package:
        console.print_message(
            f"warning: {configuration.description.path} is in no ROS package, so "
            f"config/{configuration.stem}.urdf.xacro includes it by its absolute path, which "
            "exists only here; put a package.xml above it"
        )


def _report_srdf(console: Console, path: Path, changes: SrdfChanges) -> None:
    """Print the changes of an existing SRDF, and what could not be changed."""
    from ..report.srdf_existing import list_changes

    for group in changes.groups:
        console.print_note(f"{path}: added group '{group.name}', {describe_group(group)}")
    for name in changes.refused:
        console.print_message(
            f"{path}: not added: group '{name}', because the file has expressions or macros"
        )
    for line in list_changes(changes.pairs) if changes.pairs is not None else ():
        console.print_message(f"{path}: {line}")


def _report_findings(console: Console, findings: list[Finding]) -> int:
    from ..diagnostic import Severity
    from ..report.findings import format_concise

    bad = [one for one in findings if one.severity >= Severity.WARNING]
    for line in format_concise(bad):
        console.print_note(line, -1)
    if not bad:
        console.print_note("checked: the rules of MoveIt and of ros2_control find nothing")
    return 1 if bad else 0
