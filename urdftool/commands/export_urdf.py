"""``urdftool export urdf``: convert a robot in SDF, MJCF or USD to URDF."""

from __future__ import annotations

from pathlib import Path

import click

from ..console import Console
from .export_options import make_export_options
from .grouped_help import GroupedCommand
from .options import add_gltf_option, add_package_options, add_robot_argument

_GROUPS = {
    "Output": "output mesh_dir overwrite style",
    "Conversion": "frames hardware",
    "Verification": "verified strict force",
}


@click.command("urdf", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="Output folder, or .urdf file.  [default: standard output]",
)
@click.option(
    "--frames",
    type=click.Choice(("keep", "none")),
    default="keep",
    show_default=True,
    help="Sites and frames: keep as links without mass, or none.",
)
@click.option(
    "--hardware",
    metavar="PLUGIN",
    default="mock_components/GenericSystem",
    show_default=True,
    help="Hardware plugin in <ros2_control>, which holds the actuators; none drops them.",
)
@make_export_options(
    mesh_dir="meshes",
    verify=(
        "Read the result and compare it with IN as urdftool verify does: tree, frames, limits, "
        "masses, shapes."
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
    frames: str,
    hardware: str,
    mesh_dir: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
    overwrite: bool,
    strict: bool,
    verified: bool,
    force: bool,
    style: str,
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
    from ..formats.urdf.options import Options
    from .export_report import run_export
    from .read_other import read_any

    place = output or "-"
    file = Path(place).name if place == "-" or Path(place).suffix.lower() == ".urdf" else ""
    options = Options(
        frames == "keep",
        force,
        "robot.urdf" if place == "-" else file,
        mesh_dir,
        "" if hardware == "none" else hardware,
        srdf=place != "-",
    )
    model = read_any(console, robot, package, package_path)
    return run_export(
        console,
        format_named("urdf"),
        model,
        options,
        place,
        strict=strict,
        verify=verified,
        overwrite=overwrite,
        as_json=style == "json",
    )
