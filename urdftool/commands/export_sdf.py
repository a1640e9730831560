"""``urdftool export sdf``: convert a robot to SDF for Gazebo."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .export_options import add_fix_inertia_option, make_export_options
from .grouped_help import GroupedCommand
from .load_strict import report_gltf_axes
from .options import add_gltf_option, add_package_options, add_robot_argument
from .read_other import read_any

if TYPE_CHECKING:
    from ..formats.sdf.options import Options


_GROUPS = {
    "Output": "output world uri mesh_dir overwrite style",
    "Conversion": "target version fixed_joints fix_inertia actuator_config",
    "Verification": "verified strict force",
}


@click.command("sdf", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="Output folder, or .sdf, .xml or .world file.  [default: standard output]",
)
@click.option(
    "--target",
    type=click.Choice(("gz", "gazebo-classic")),
    default="gz",
    show_default=True,
    help="Target simulator.",
)
@click.option(
    "--sdf-version",
    "version",
    type=click.Choice(("1.6", "1.7", "1.9", "1.10", "1.11", "1.12")),
    metavar="VERSION",
    help="SDF version: 1.9 to 1.12 for gz, 1.6 or 1.7 for gazebo-classic.  [default: 1.11 for gz, "
    "1.7 for gazebo-classic]",
)
@click.option(
    "--fixed-joints",
    type=click.Choice(("keep", "lump")),
    metavar="METHOD",
    help="Fixed joints: keep, or lump their links into one.  [default: keep for gz, lump for "
    "gazebo-classic]",
)
@click.option(
    "--uri",
    type=click.Choice(("relative", "model", "package", "file")),
    metavar="FORM",
    help="Form of mesh URIs: relative, model, package or file; meshes are copied for relative and "
    "model only.",
)
@click.option("--world", is_flag=True, help="Write a world with the model, a ground and a sun.")
@click.option(
    "--actuator-config",
    metavar="FILE",
    type=Path,
    help='TOML file with damping, friction and force-range under [joints."NAME or PATTERN"]; '
    "the same file as for export mjcf.",
)
@add_fix_inertia_option
@make_export_options(
    mesh_dir="meshes",
    verify=(
        "Read the result and compare it with IN: tree, masses, limits, base, contacts, friction, "
        "flags, springs, sensors, plugins, visuals."
    ),
)
@add_gltf_option
@add_package_options
@click.pass_obj
def command(
    console: Console,
    /,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    package: dict[str, Path],
    package_path: tuple[str, ...],
    overwrite: bool,
    strict: bool,
    verified: bool,
    style: str,
    **choices: Any,
) -> int:
    """Convert the robot IN to SDF for Gazebo.

    A folder OUT contains model.config, model.sdf and meshes; meshes of a file OUT are written next
    to it. Every loss is reported with its place; --verify compares the model with IN.

    \b
        urdftool export sdf arm.urdf.xacro -o arm/ --verify
        urdftool export sdf mira.urdf -o mira.sdf --target gazebo-classic
    """  # noqa: D301 -- click reads the escape
    from ..api.export import check_plugins
    from ..formats.registry import format_named
    from ..model.world import weld_base
    from .export_report import run_export

    place = output or "-"
    options = _make_options(place, choices)
    model = weld_base(read_any(console, robot, package, package_path, quiet=True))
    report_gltf_axes(console, model)
    return run_export(
        console,
        format_named("sdf"),
        model,
        options,
        place,
        strict=strict,
        verify=verified,
        overwrite=overwrite,
        as_json=style == "json",
        more_checks=partial(check_plugins, target=options.target),
    )


def _make_options(output: str, choices: dict[str, Any]) -> Options:
    """Make the options of the writer from those of the command line and the output path."""
    from ..formats.sdf.options import MODEL, VERSIONS, Options, get_folder_and_file

    target, version = choices["target"], choices.pop("version") or ""
    if version and version not in VERSIONS[target]:
        known = ", ".join(VERSIONS[target])
        raise click.UsageError(f"{target} supports SDF {known}, not {version}")
    folder, file = get_folder_and_file(MODEL if output == "-" else output)
    config = choices.pop("actuator_config")
    choices = {name: value or "" if value is None else value for name, value in choices.items()}
    if output == "-" and not choices["uri"]:
        choices["uri"] = "file"  # standard output has no folder for relative URIs
    return Options(
        version=version,
        folder=folder,
        file=file,
        actuator_config=config,
        **choices,
    )
