"""``urdftool lint``: check robot descriptions and report each finding at its line."""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .cache_options import add_cache_options, choose_cache_folder
from .grouped_help import GroupedCommand
from .options import (
    add_gltf_option,
    add_jobs_option,
    add_name_option,
    add_package_options,
    add_scheduler_option,
    split_arguments,
)

if TYPE_CHECKING:
    from ..lint.printed import Transcript
    from ..workspace import Workspace
    from .lint_watch import CheckFiles

FORMATS = ("full", "concise", "json", "sarif", "github", "junit", "html")
_WITH_FIXES = ("full", "json", "sarif", "html")
LEVELS = ("error", "warning", "info")
_GROUPS = {
    "What to do": "fix diff unsafe_fixes fix_meshes explain list_rules",
    "Rules": "select extend_select ignore target baseline write_baseline",
    "Output": "style whole output_file junit statistics fail_on exit_zero",
    "Input": "no_expand list_robots show_targets changed_since watch",
    "Performance": "jobs scheduler",
}


@click.command("lint", cls=GroupedCommand, groups=_GROUPS)
@click.argument("words", nargs=-1, metavar="PATH... [name:=value ...]")
@add_name_option
@click.option("--select", multiple=True, metavar="RULES", help="Check only these rules.")
@click.option(
    "--extend-select",
    multiple=True,
    metavar="RULES",
    help="Check these rules in addition to the default ones.",
)
@click.option("--ignore", multiple=True, metavar="RULES", help="Skip these rules.")
@click.option(
    "--target",
    multiple=True,
    metavar="TARGET",
    help="Target program: ros1, ros2, gazebo-classic, gz, mujoco, pybullet, moveit, newton or "
    "isaac. Repeatable.  "
    "[default: detected from the file]",
)
@click.option(
    "--format",
    "style",
    type=click.Choice(FORMATS),
    metavar="FORMAT",
    help=f"Output format: {', '.join(FORMATS)}.  [default: full; concise at a terminal with more "
    "than 8 findings]",
)
@click.option(
    "--all",
    "whole",
    is_flag=True,
    help="Print all findings in full (default: at most 25 lines per rule family).",
)
@click.option(
    "--output-file", metavar="FILE", help="Write the findings to FILE instead of standard output."
)
@click.option("--junit", metavar="FILE", help="Also write the findings as JUnit XML to FILE.")
@click.option(
    "--statistics", is_flag=True, help="Print the number of findings per rule, not the findings."
)
@click.option(
    "--no-expand",
    is_flag=True,
    help="Evaluate no xacro: check only the source of xacro files, without their robots.",
)
@click.option("--fix", is_flag=True, help="Apply safe fixes to the files.")
@click.option(
    "--unsafe-fixes",
    is_flag=True,
    help="With --fix or --diff: include fixes that change the robot's physics.",
)
@click.option(
    "--fix-meshes",
    is_flag=True,
    help="With --fix or --diff: include fixes that write mesh files.",
)
@click.option("--diff", is_flag=True, help="Print the changes of --fix as a diff; write no file.")
@click.option(
    "--exit-zero",
    is_flag=True,
    help="Exit with 0 despite findings, but with 2 if a robot was not checked.",
)
@click.option(
    "--fail-on",
    type=click.Choice(LEVELS),
    default="warning",
    show_default=True,
    metavar="SEVERITY",
    help="Lowest severity that causes exit code 1: error, warning, info.",
)
@click.option("--baseline", metavar="FILE", help="Ignore the findings that are listed in FILE.")
@click.option("--write-baseline", metavar="FILE", help="Write the findings to FILE as a baseline.")
@add_jobs_option
@add_scheduler_option
@add_cache_options
@click.option("--explain", metavar="RULE", help="Print the documentation of a rule and exit.")
@click.option(
    "--list",
    "list_robots",
    is_flag=True,
    help="Print the robots, their variants and the files that they include, and exit.",
)
@click.option(
    "--explain-targets",
    "show_targets",
    is_flag=True,
    help="Print which file and line names each target, the packages, launch arguments and "
    "controllers of each robot, and exit.",
)
@click.option(
    "--changed-since",
    metavar="REV",
    help="Check only robots to which files belong that changed since a revision of git.",
)
@click.option(
    "--watch", is_flag=True, help="Report again when a file of a robot changes, until Ctrl-C."
)
@click.option("--list-rules", is_flag=True, help="Print all rules and exit.")
@add_gltf_option
@add_package_options
@click.pass_obj
def command(console: Console, /, watch: bool, **given: Any) -> int:
    """Check robot descriptions for errors, and report each finding at its line.

    PATH is a file (URDF, xacro, SDF, MJCF or USD), a folder with files of the first four, or '-'
    (standard input). RULES are names, patterns ('mesh-*') or families ('inertia') of rules, with
    commas.

    \b
        urdftool lint arm.urdf.xacro prefix:=left_
        urdftool lint src/ --target gz --format concise
        urdftool lint src/ --fix
        urdftool lint --explain zero-axis

    A comment <!-- urdftool-ignore[RULE] reason --> suppresses a rule on its line or in the next
    element.

    Exit code 1: findings of severity --fail-on or above that are not in the baseline (with --fix:
    findings that remain; with --diff: something would be fixed). Exit code 2, with all options: a
    robot could not be read or expanded, and was not checked.
    """  # noqa: D301 -- click reads the escape
    if not watch:
        from .lint_printed import print_run

        return print_run(
            console, given, lambda done: _check_paths(console, **given, transcript=done)
        )
    from .lint_watch import watch_files

    if given["scheduler"] is not None:
        raise click.UsageError("--watch does not support --scheduler")
    paths, _ = split_arguments(given["words"])
    return watch_files(
        console, paths, given, lambda check: _check_paths(console, **given, check=check)
    )


def _check_paths(
    console: Console,
    words: tuple[str, ...],
    select: tuple[str, ...],
    extend_select: tuple[str, ...],
    ignore: tuple[str, ...],
    target: tuple[str, ...],
    style: str | None,
    whole: bool,
    output_file: str | None,
    junit: str | None,
    statistics: bool,
    no_expand: bool,
    fix: bool,
    unsafe_fixes: bool,
    fix_meshes: bool,
    diff: bool,
    exit_zero: bool,
    fail_on: str,
    baseline: str | None,
    write_baseline: str | None,
    jobs: int | None,
    scheduler: str | None,
    cache_dir: str | None,
    no_cache: bool,
    explain: str | None,
    list_rules: bool,
    list_robots: bool,
    show_targets: bool,
    changed_since: str | None,
    package: dict[str, Path],
    package_path: tuple[str, ...],
    transcript: Transcript | None = None,
    check: CheckFiles | None = None,
) -> int:
    """Check descriptions with the options of the command line, and return the exit code."""
    from ..formats.detect import read_other_format
    from ..formats.search import find_other_descriptions
    from ..lint.discover import explain_nothing_found
    from ..lint.options import Options
    from ..lint.outcome import Report
    from ..lint.parallel import WORTH_IT, check_files
    from ..lint.settings import Settings, check_selectors, check_targets
    from ..lint.skipped import add_skipped_parts, exclude_files
    from ..workspace import Workspace
    from .lint_report import OutputOptions, report
    from .lint_repository import (
        check_source,
        find_repository,
        list_robot_files,
        print_list,
        select_changed,
        summarize_robots,
    )
    from .progress import Progress

    if explain or list_rules:
        return _show_rules(console, explain, style)
    paths, arguments = split_arguments(words)
    if not paths:
        raise click.UsageError("missing argument PATH: a file or folder, or '-' for standard input")
    other = find_other_descriptions(paths)
    folders = [path for path in paths if os.path.isdir(path)]
    workspace = Workspace()
    if transcript is not None:
        workspace = workspace.with_record()
        for path in paths:
            workspace.is_file(path)
            workspace.resolve_links(path)
    options = Options(Settings(), arguments, package, package_path, config=console.config)
    options.workspace = workspace
    found = find_repository(paths, options)
    found.links += other.links
    files = list_robot_files([*paths, *other.files], found)
    if not files and not other.skipped:
        raise click.UsageError(explain_nothing_found(paths))
    files, excluded = exclude_files(files, paths, console.config, workspace)
    if changed_since is not None:
        files = select_changed(console, files, found, changed_since, folders or ["."])
    if list_robots:
        print_list(files, found)
        return 0
    options.variants = {real: robot.variants for real, robot in found.robots.items()}
    settings = Settings(
        select=check_selectors(select) if select else None,
        extend_select=check_selectors(extend_select),
        ignore=check_selectors(ignore),
        targets=check_targets(target),
    )
    if not settings.get_names():
        raise click.UsageError("--select and --ignore leave no rule; --list-rules lists all")
    _warn_of_old_names(console, (*select, *extend_select, *ignore), files, workspace)
    for option, given in (("--unsafe-fixes", unsafe_fixes), ("--fix-meshes", fix_meshes)):
        if given and not (fix or diff):
            raise click.UsageError(f"{option} requires --fix or --diff")
    if statistics and style not in (None, "full", "concise"):
        raise click.UsageError(f"--statistics and --format {style} exclude each other")
    folder = choose_cache_folder("lint", cache_dir, no_cache or no_expand)
    options.settings, options.gltf_up = settings, console.gltf_up
    options.read_other = read_other_format
    if folder is not None:
        from ..lint.cache import Cache
        from ..storage import DiskCache

        options.cache = Cache(DiskCache(folder))
    options.expand = not no_expand
    if show_targets:
        from .lint_targets import print_targets

        return print_targets(files, found, options, style)
    options.fixes = style is None or style in _WITH_FIXES
    output = OutputOptions(
        style, output_file, statistics, exit_zero, fail_on, baseline, write_baseline
    )
    output.paths, output.whole, output.arguments = paths, whole, tuple(arguments)
    output.junit = junit
    if style == "html":
        from .lint_pictures import draw_robots

        output.draw = partial(draw_robots, console, options)
    if folders:
        output.ending = partial(summarize_robots, found, options)
    if fix or diff:
        from .lint_fix import Kinds, fix_files

        kinds = Kinds(unsafe_fixes, fix_meshes)
        if scheduler is not None:
            raise click.UsageError("--fix and --diff do not support --scheduler")
        return fix_files(
            console, files, options, settings, output, jobs=jobs, kinds=kinds, diff=diff
        )
    belonging = {file for real in found.robots for file in found.list_files(real)}
    if scheduler is not None and "-" in files:
        raise click.UsageError("standard input cannot be checked with --scheduler")
    with Progress(console, "robots") as progress:
        shown = progress if scheduler is not None or len(files) >= WORTH_IT else None
        check_all = check or partial(check_files, scheduler=scheduler, on_progress=shown)
        checked = check_all(files, options, jobs)
        reports = list(add_skipped_parts(checked, paths, check_source, options, belonging))
    if transcript is not None:
        transcript.set_dependencies(reports, workspace.dependencies)
    skipped = [Report(path, skipped=reason) for path, reason in other.skipped.items()]
    skipped += [Report(path, skipped=why, stopped=why) for path, why in other.not_checked.items()]
    return report(console, [*reports, *skipped, *excluded], settings, output)


def _warn_of_old_names(
    console: Console, selectors: Iterable[str], files: Iterable[str], workspace: Workspace
) -> None:
    """Print each old name of a rule or threshold in the options and configurations once."""
    from ..configuration import find_configuration
    from ..rules.old_names import find_old_names, find_old_rules

    old_names = dict.fromkeys(find_old_rules(selectors))
    tables = {
        configuration.path: configuration.lint
        for file in files
        if (configuration := find_configuration(file, console.config, workspace)).lint
    }
    for old in old_names:
        console.print_note(f"urdftool: {old.message}")
    for path, table in tables.items():
        for old in dict.fromkeys(find_old_names(table)):
            console.print_note(f"{path}: {old.message}")


def _show_rules(console: Console, explain: str | None, style: str | None) -> int:
    """Print the page of a rule, or the list of all, as text or as JSON."""
    from ..report import rule_pages
    from ..rules import FAMILY_OF
    from ..rules.old_names import find_old_rules

    if style not in (None, "full", "json"):
        raise click.UsageError(f"rules are printed as text or JSON, not with --format {style}")
    for old in find_old_rules([explain] if explain else []):
        console.print_note(f"urdftool: {old.message}")
    if style == "json":
        text = rule_pages.format_pages_as_json([explain] if explain else FAMILY_OF)
    elif explain:
        text = rule_pages.format_page(explain)
    else:
        text = rule_pages.format_rule_list()
    click.echo(text, nl=False)
    return 0
