"""``urdftool export mjcf``: convert a robot to a MuJoCo model."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import click

from ..console import Console
from .export_options import add_fix_inertia_option, make_export_options
from .grouped_help import GroupedCommand
from .load_strict import report_gltf_axes
from .options import add_gltf_option, add_package_options, add_robot_argument, parse_name_numbers
from .read_other import read_any


def _parse_pose(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> tuple[str, dict[str, float]]:
    """Parse the name of an SRDF group state, and joint positions by name."""
    names = [value for value in values if "=" not in value]
    if len(names) > 1:
        raise click.BadParameter(
            f"{' and '.join(names)}: only one group state is possible", ctx, parameter
        )
    positions = tuple(value for value in values if "=" in value)
    return "".join(names), parse_name_numbers(ctx, parameter, positions)


_GROUPS = {
    "Output": "output scene mesh_dir overwrite style",
    "Robot": "base pose srdf base_sensors exclude fuse keep_locked_joints fix_inertia decompose",
    "Actuators": "actuators actuator_config armature",
    "Verification": "verified strict force",
}


@click.command("mjcf", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="Output folder, or .xml or .mjcf file.  [default: standard output]",
)
@click.option(
    "--actuators",
    type=click.Choice(("auto", "none", "position", "velocity", "motor")),
    default="auto",
    show_default=True,
    metavar="KIND",
    help="Actuators: none, position, velocity or motor for all joints, or auto (from "
    "transmissions, ros2_control and drive plugins).",
)
@click.option(
    "--base",
    type=click.Choice(("auto", "fixed", "free")),
    default="auto",
    show_default=True,
    help="Base of the robot; auto: free for robots with legs or driven wheels, or if the file "
    "defines it so.",
)
@click.option("--scene", is_flag=True, help="Also write scene.xml with a floor and a light.")
@click.option(
    "--srdf",
    metavar="FILE",
    type=Path,
    help="SRDF file with disabled collisions and group states for the home position.",
)
@click.option(
    "--pose",
    multiple=True,
    metavar="JOINT=VALUE|NAME",
    callback=_parse_pose,
    help="Home position of a joint [rad or m], or name of an SRDF group state. Repeatable.",
)
@click.option(
    "--base-sensors",
    is_flag=True,
    help="Add missing sensors of a free base: linear velocity, gyro, accelerometer, orientation.",
)
@click.option(
    "--exclude",
    type=click.Choice(("touching", "adjacent", "none")),
    default="touching",
    show_default=True,
    metavar="PAIRS",
    help="Link pairs without contacts: adjacent (joined by a joint), touching (also those that "
    "overlap at home), or none (only those of --srdf).",
)
@click.option(
    "--fuse",
    is_flag=True,
    help="Merge links of fixed joints into their parents; their frames become sites.",
)
@click.option(
    "--actuator-config",
    metavar="FILE",
    type=Path,
    help="TOML file with kp, kd, armature, damping, friction, force-range and type under "
    '[joints."NAME or PATTERN"].',
)
@click.option(
    "--armature",
    metavar="VALUE",
    type=click.FloatRange(min=0),
    help="Rotor inertia reflected at every joint [kg·m², or kg for prismatic joints].",
)
@click.option(
    "--keep-locked-joints",
    is_flag=True,
    help="Keep joints with lower = upper, held by an equality (default: weld their links).",
)
@add_fix_inertia_option
@click.option("--decompose", is_flag=True, help="Decompose collision meshes into convex pieces.")
@make_export_options(
    mesh_dir="assets",
    verify=(
        "Compile the result in MuJoCo and compare it with IN: tree, masses, limits, base, "
        "contacts, friction, gravity, springs, actuators, sensors, visuals, home position."
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
    mesh_dir: str,
    decompose: bool,
    overwrite: bool,
    strict: bool,
    verified: bool,
    style: str,
    pose: tuple[str, dict[str, float]],
    **choices: Any,
) -> int:
    """Convert the robot IN to a MuJoCo model (MJCF).

    Each link becomes a body with the same name, mass and joint limits; meshes are copied or
    converted. Every loss is reported with its place; --verify compares the model with IN.

    \b
        urdftool export mjcf panda.urdf -o panda/ --scene --verify
        urdftool export mjcf quadruped.urdf.xacro -o q/ --scene --actuators position
    """  # noqa: D301 -- click's mark for lines it must not wrap
    from ..api.export import cut_meshes, measure_overlap
    from ..formats.mjcf.options import Options
    from ..formats.registry import format_named
    from ..model.world import weld_base
    from .export_report import run_export

    mjcf, place = format_named("mjcf"), output or "-"
    model = weld_base(read_any(console, robot, package, package_path, quiet=True))
    report_gltf_axes(console, model)
    axes = "y" if model.source is None else model.source.gltf_up
    options = Options(
        mesh_dir="" if mesh_dir == "." else mesh_dir,
        file=Path(place).name if mjcf.has_suffix(place) else "",
        cutter=partial(cut_meshes, gltf_up=axes) if decompose else None,
        state=pose[0],
        pose=pose[1],
        overlap=measure_overlap,
        **choices,
    )
    return run_export(
        console,
        mjcf,
        model,
        options,
        place,
        strict=strict,
        verify=verified,
        overwrite=overwrite,
        as_json=style == "json",
    )
