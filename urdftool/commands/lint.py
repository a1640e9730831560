"""``urdftool lint``: what is wrong with a robot, at the line that is."""

from __future__ import annotations

from pathlib import Path

import click

from ..console import Console
from .cache_options import cache_options, cache_place
from .options import gltf_option, package_options, split_arguments

FORMATS = ("full", "concise", "json", "sarif", "github", "junit", "html")
_WITH_FIXES = ("full", "json", "sarif", "html")
LEVELS = ("error", "warning", "info")


@click.command("lint")
@click.argument("words", nargs=-1, metavar="PATH... [name:=value ...]")
@click.option("--select", multiple=True, metavar="RULES", help="Only these rules.")
@click.option("--extend-select", multiple=True, metavar="RULES", help="These rules as well.")
@click.option("--ignore", multiple=True, metavar="RULES", help="Not these rules.")
@click.option(
    "--target",
    multiple=True,
    metavar="TARGET",
    help="What the robot is for: ros1, ros2, gazebo-classic, gz, mujoco, pybullet, moveit. "
    "Repeatable; without it, what the file shows.",
)
@click.option(
    "--format",
    "style",
    type=click.Choice(FORMATS),
    help="Format of the findings.  [default: full; concise at a terminal for more than 8 findings]",
)
@click.option(
    "--all",
    "whole",
    is_flag=True,
    help="Show every finding with all details, not at most 25 lines for each family of rules.",
)
@click.option("--output-file", metavar="FILE", help="Write the findings there, not to stdout.")
@click.option("--statistics", is_flag=True, help="Count findings by rule instead of showing them.")
@click.option("--fix", is_flag=True, help="Apply safe fixes to the files.")
@click.option(
    "--unsafe-fixes",
    is_flag=True,
    help="With --fix or --diff: also those that invent or remove physics.",
)
@click.option(
    "--fix-meshes",
    is_flag=True,
    help="With --fix or --diff: also those that write mesh files, which may be binary.",
)
@click.option("--diff", is_flag=True, help="Show what --fix would change, and write nothing.")
@click.option(
    "--exit-zero",
    is_flag=True,
    help="Exit 0 even if there are findings, but 2 if a robot was not checked.",
)
@click.option(
    "--fail-on",
    type=click.Choice(LEVELS),
    default="warning",
    show_default=True,
    help="Exit 1 from this severity on.",
)
@click.option("--baseline", metavar="FILE", help="Pass over the findings that FILE has.")
@click.option("--write-baseline", metavar="FILE", help="Write the findings to FILE, as a baseline.")
@click.option("-j", "--jobs", type=click.IntRange(1), metavar="N", help="Processes to use.")
@cache_options
@click.option("--explain", metavar="RULE", help="Show a rule's page and stop.")
@click.option("--list-rules", is_flag=True, help="List all rules and stop.")
@gltf_option
@package_options
@click.pass_obj
def command(
    console: Console,
    words: tuple[str, ...],
    select: tuple[str, ...],
    extend_select: tuple[str, ...],
    ignore: tuple[str, ...],
    target: tuple[str, ...],
    style: str | None,
    whole: bool,
    output_file: str | None,
    statistics: bool,
    fix: bool,
    unsafe_fixes: bool,
    fix_meshes: bool,
    diff: bool,
    exit_zero: bool,
    fail_on: str,
    baseline: str | None,
    write_baseline: str | None,
    jobs: int | None,
    cache_dir: str | None,
    no_cache: bool,
    explain: str | None,
    list_rules: bool,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Find what is wrong with robots, and point at the line that is.

    PATH is a .urdf or .xacro file, a folder to search for .urdf and .urdf.xacro files, or '-'.
    RULES are rule names, prefixes such as 'mesh-*' and families such as 'inertia', separated by
    commas. A comment <!-- urdftool-ignore[RULE] reason --> silences a rule for its own line or the
    next element.

    \b
        urdftool lint arm.urdf.xacro prefix:=left_
        urdftool lint src/ --target gz --format concise
        urdftool lint src/ --fix
        urdftool lint --explain zero-axis

    Exit 1 if there are findings of --fail-on or above that the baseline does not have (with --fix,
    those that are left; with --diff, if anything would be fixed), 2 if a robot could not be read or
    expanded and was therefore not checked, whatever the options say.
    """  # noqa: D301 -- click reads the escape
    from ..lint.discover import find_descriptions, nothing_below
    from ..lint.outcome import Options
    from ..lint.parallel import lint_files
    from ..lint.settings import Settings, check_selectors, check_targets
    from ..lint.skipped import with_parts, without_excluded
    from ..workspace import Workspace
    from .lint_report import Wanted, report

    if explain or list_rules:
        return _show_rules(explain)
    paths, arguments = split_arguments(words)
    if not paths:
        raise click.UsageError("a file or folder is wanted")
    files = find_descriptions(paths)
    if not files:
        raise click.UsageError(nothing_below(paths))
    workspace = Workspace()
    files, excluded = without_excluded(files, paths, console.config, workspace)
    settings = Settings(
        select=check_selectors(select) if select else None,
        extend_select=check_selectors(extend_select),
        ignore=check_selectors(ignore),
        targets=check_targets(target),
    )
    for option, given in (("--unsafe-fixes", unsafe_fixes), ("--fix-meshes", fix_meshes)):
        if given and not (fix or diff):
            raise click.UsageError(f"{option} goes with --fix or --diff")
    kept = cache_place("lint", cache_dir, no_cache)
    options = Options(settings, arguments, package, package_path, console.config)
    options.gltf_up, options.workspace = console.gltf_up, workspace
    if kept is not None:
        from ..lint.cache import Cache
        from ..storage import DiskCache

        options.cache = Cache(DiskCache(kept))
    options.fixes = style is None or style in _WITH_FIXES
    wanted = Wanted(style, output_file, statistics, exit_zero, fail_on, baseline, write_baseline)
    wanted.paths, wanted.whole = paths, whole
    if fix or diff:
        from .lint_fix import Kinds, fix_files

        kinds = Kinds(unsafe_fixes, fix_meshes)
        return fix_files(
            console, files, options, settings, wanted, jobs=jobs, kinds=kinds, diff=diff
        )
    reports = with_parts(lint_files(files, options, jobs), paths)
    return report(console, [*reports, *excluded], settings, wanted)


def _show_rules(explain: str | None) -> int:
    from ..report import rule_pages

    if explain is None:
        click.echo(rule_pages.rule_list(), nl=False)
    else:
        click.echo(rule_pages.page(explain), nl=False)
    return 0
