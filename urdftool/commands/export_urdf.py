"""``urdftool export urdf``: convert a robot in SDF, MJCF or USD to URDF."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..console import Console
from ..formats.common.option import make_options
from ..formats.urdf.options import Options
from .export_many import ExportCommand, add_robots_argument
from .export_options import add_declared_options, add_output_option, make_export_options
from .options import add_gltf_option, add_package_options

_GROUPS = {
    "Output": "output mesh_dir overwrite style",
    "Conversion": "root frames hardware",
    "Verification": "verified strict force",
}

_FRAMES = {
    "type": click.Choice(("keep", "none")),
    "is_flag": False,
    "default": "keep",
    "show_default": True,
}


@click.command("urdf", cls=ExportCommand, groups=_GROUPS)
@add_robots_argument
@add_output_option(".urdf")
@add_declared_options(Options, frames=_FRAMES)
@make_export_options(
    "Read the result and compare it with IN as urdftool verify does: tree, frames, limits, "
    "masses, shapes."
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
    """Convert the robot IN, in SDF, MJCF or USD, to URDF.

    A folder OUT contains ROBOT.urdf, meshes and, for excluded contacts and named joint positions,
    ROBOT.srdf; files of a file OUT are written next to it. Several joints between two bodies become
    links without mass with one joint each. Every loss is reported with its place; --verify compares
    the result with IN.

    \b
        urdftool export urdf arm.xml -o arm/ --verify
        urdftool export urdf model.sdf -o model.urdf
    """  # noqa: D301 -- click reads the escape
    from ..formats.registry import format_named
    from .export_report import run_export
    from .read_other import read_any

    place = output or "-"
    file = Path(place).name if Path(place).suffix.lower() == ".urdf" else ""
    choices["frames"] = choices["frames"] == "keep"
    if choices["hardware"] == "none":
        choices["hardware"] = ""
    file = "robot.urdf" if place == "-" else file
    options = make_options(Options, choices, file=file, srdf=place != "-")
    model = read_any(console, robot, package, package_path, quiet=True)
    return run_export(
        console,
        format_named("urdf"),
        model,
        options,
        place,
        choices,
    )
