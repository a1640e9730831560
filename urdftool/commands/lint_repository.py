"""The robots of the folders given to ``urdftool lint``: which are checked, and which are listed."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import click

from ..console import Console
from ..lint.discover import describe_links, shorten_list
from ..report.counted import format_count

if TYPE_CHECKING:
    from ..lint.options import Options
    from ..lint.outcome import Report
    from ..lint.repository import Repository


def find_repository(paths: Sequence[str], options: Options) -> Repository:
    """Find the robots below the folders of the command line."""
    from ..lint.repository import Repository

    folders = [path for path in paths if os.path.isdir(path)]
    if not folders:  # avoids imports
        return Repository()
    from ..lint.robot_search import find_robots

    return find_robots(
        folders,
        config=options.config,
        packages=options.packages,
        package_paths=options.package_paths,
        workspace=options.workspace,
    )


def list_robot_files(paths: Sequence[str], found: Repository) -> list[str]:
    """Return the files to check, each once: named files, and the robots below named folders."""
    files: dict[str, str] = {}
    for path in paths:
        if path == "-" or not os.path.isdir(path):
            files.setdefault(path if path == "-" else os.path.realpath(path), path)
            continue
        inside = os.path.join(os.path.abspath(path), "")
        below = (i for i in found.robots.items() if os.path.abspath(i[1].path).startswith(inside))
        for real, robot in sorted(below, key=lambda item: item[1].path):
            files.setdefault(real, robot.path)
    return list(files.values())


def select_changed(
    console: Console,
    files: Sequence[str],
    found: Repository,
    revision: str,
    folders: Sequence[str],
) -> list[str]:
    """Return the files that changes since a revision of git concern.

    Raises:
        UrdftoolError: Git cannot list what changed.
    """
    from ..git_changes import Changes
    from ..lint.changes import list_changed_files, select_concerned

    changes = Changes()
    for folder in folders:
        one = list_changed_files(folder, revision)
        changes.changed |= one.changed
        changes.files |= one.files
    kept = select_concerned(files, found, changes, console.config)
    console.print_note(
        f"{format_count(len(changes.changed), 'file')} changed since {revision}: "
        f"{len(kept)} of {format_count(len(files), 'robot')} concerned"
    )
    return kept


def print_list(files: Sequence[str], found: Repository) -> None:
    """Print each robot with the reason, its variants, and the files that it includes."""
    from ..lint.variants import label

    shown = {os.path.realpath(path) for path in files}
    lines = []
    for path in files:
        real = os.path.realpath(path)
        robot = found.robots.get(real)
        lines.append(f"{path}  ({robot.why})" if robot else path)
        for variant in robot.variants if robot else ():
            lines.append(f"  with {label(variant)}")
        for name, place in robot.computed.items() if robot else ():
            lines.append(f"  {name}:= is computed in {place}, so it is not passed")
        for other in sorted(found.list_files(real) - {real}):
            lines.append(f"  includes {found.paths.get(other, other)}")
        if found.list_files(real) & found.computes:
            lines.append("  includes files by computed names, which are not listed")
    belonging = {file for real in found.robots for file in found.list_files(real)} | found.parts
    others = [path for real, path in found.paths.items() if real not in belonging | shown]
    lines += [f"{path}  (no robot includes it)" for path in sorted(others)]
    click.echo("".join(f"{line}\n" for line in lines), nl=False)
    parts = sorted(found.paths[real] for real in found.parts - shown)
    for path in parts:
        click.echo(f"{path}  (a part: it uses arguments that it does not declare)")
    _print_unknown(found)


def check_source(path: str, options: Options) -> Report:
    """Check a file of xacro as it is written; imports the rules only where a file needs it."""
    from ..lint.questions import find_cached_report

    known = find_cached_report(path, options)
    if known is not None:
        return known
    from ..lint.run import check_file

    return check_file(path, options)


def _print_unknown(found: Repository) -> None:
    for what, places in (
        ("paths of descriptions that are computed, and not followed", found.unknown),
        ("links elsewhere or to nowhere, which are not followed", sorted(set(found.links))),
    ):
        if places:
            click.echo(f"{what}: {shorten_list(places)}", err=True)


def _name_computed(path: str, found: Repository) -> str:
    """Return a path with the arguments that a launch file computes, which the robot may lack."""
    robot = found.robots.get(os.path.realpath(path))
    computed = robot.computed.items() if robot else ()
    words = ", ".join(f"{name}:= is computed in {place}" for name, place in computed)
    return f"{path} ({words})" if words else path


def summarize_robots(found: Repository, options: Options, reports: Collection[Report]) -> str:
    """Return ``checked 3 robots (4 variants), 12 files belong to them, 0 not checked``.

    Launch files that compute the path of a description, and links that are not followed, follow.
    """
    checked = [report.path for report in reports if report.checked]
    missing = [report.path for report in reports if report.not_checked or report.unexpanded]
    missing += dict.fromkeys(path for report in reports for path in report.unread_files)
    reals = {os.path.realpath(path) for path in checked}
    read = {os.path.realpath(path) for report in reports if report.checked for path in report.files}
    belonging = (read | {path for real in reals for path in found.list_belonging(real)}) - reals
    variants = sum(len(options.variants.get(real, ())) or 1 for real in reals)
    unknown = shorten_list(found.unknown)
    parts = (
        f"checked {format_count(len(checked), 'robot')} ({format_count(variants, 'variant')}), "
        f"{format_count(len(belonging), 'file')} {'belong' if len(belonging) != 1 else 'belongs'} "
        f"to {'it' if len(checked) == 1 else 'them'}, {len(missing)} not checked"
        + (f": {shorten_list([_name_computed(path, found) for path in missing])}" * bool(missing)),
        f"computed paths not followed: {unknown}" if unknown else "",
        describe_links(found.links),
    )
    return "; ".join(filter(None, parts))
