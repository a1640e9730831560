"""``urdftool export sdf``: convert a robot to SDF for Gazebo."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import click

from ..console import Console
from ..formats.common.option import make_options
from ..formats.sdf.options import MODEL, Options, get_folder_and_file
from .export_many import ExportCommand, add_robots_argument
from .export_options import add_declared_options, add_output_option, make_export_options
from .load_strict import report_gltf_axes
from .options import add_gltf_option, add_package_options
from .read_other import read_any

_GROUPS = {
    "Output": "output world uri mesh_dir overwrite style",
    "Conversion": "target version base fixed_joints fix_inertia actuator_config",
    "Verification": "verified strict force",
}


@click.command("sdf", cls=ExportCommand, groups=_GROUPS)
@add_robots_argument
@add_output_option(".sdf, .xml or .world")
@add_declared_options(Options)
@make_export_options(
    "Read the result and compare it with IN: tree, masses, limits, base, contacts, friction, "
    "flags, springs, sensors, plugins, visuals."
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
    **choices: Any,
) -> int:
    """Convert the robot IN to SDF for Gazebo.

    A folder OUT contains model.config, model.sdf and meshes; meshes of a file OUT are written next
    to it. Every loss is reported with its place; --verify compares the model with IN.

    \b
        urdftool export sdf arm.urdf.xacro -o arm/ --verify
        urdftool export sdf mira.urdf -o mira.sdf --target gazebo-classic
    """  # noqa: D301 -- click reads the escape
    from ..api.overlaps import find_overlaps
    from ..api.plugin_checks import check_plugins
    from ..formats.registry import format_named
    from ..model.world import weld_base
    from .export_report import run_export

    place = output or "-"
    if place == "-" and not choices["uri"]:
        choices["uri"] = "file"  # standard output has no folder for relative URIs
    folder, file = get_folder_and_file(MODEL if place == "-" else place)
    options = make_options(Options, choices, folder=folder, file=file, overlaps=find_overlaps)
    model = read_any(console, robot, package, package_path, quiet=True)
    model = model if options.base == "free" else weld_base(model)
    report_gltf_axes(console, model)
    return run_export(
        console,
        format_named("sdf"),
        model,
        options,
        place,
        choices,
        more_checks=partial(check_plugins, target=options.target),
    )
