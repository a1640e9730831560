"""``urdftool export mjcf``: a MuJoCo model."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import click

from ..console import Console
from .export_options import export_options, fix_inertia_option
from .options import gltf_option, name_numbers, package_options, robot_argument
from .read_strict import read_strict, say_gltf


def _pose(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> tuple[str, dict[str, float]]:
    """The name of a group state, and the positions by joint."""
    names = [value for value in values if "=" not in value]
    if len(names) > 1:
        raise click.BadParameter(f"{' and '.join(names)}: one group state at most", ctx, parameter)
    positions = tuple(value for value in values if "=" in value)
    return "".join(names), name_numbers(ctx, parameter, positions)


@click.command("mjcf")
@robot_argument
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="A folder, or a file that ends in .xml or .mjcf; '-' is standard output.",
)
@click.option(
    "--actuators",
    type=click.Choice(("auto", "none", "position", "velocity", "motor")),
    default="auto",
    help="As transmissions, ros2_control and drive plugins say (auto), none, or one kind for all.",
)
@click.option(
    "--base",
    type=click.Choice(("auto", "fixed", "free")),
    default="auto",
    help="Whether the root is held; auto: free where the robot stands on legs or driven wheels, or "
    "where the description says so.",
)
@click.option("--scene", is_flag=True, help="Write also scene.xml, with a floor and light.")
@click.option(
    "--srdf",
    metavar="FILE",
    type=Path,
    help="Take over an SRDF's disabled collisions and its group state for the home position.",
)
@click.option(
    "--pose",
    multiple=True,
    metavar="JOINT=VALUE|NAME",
    callback=_pose,
    help="Position of a joint in the home position [rad or m], or the name of the SRDF's group "
    "state. Repeatable.",
)
@click.option(
    "--base-sensors",
    is_flag=True,
    help="Add linear velocity, gyro, accelerometer and orientation of a free base where the file "
    "has none.",
)
@click.option(
    "--exclude",
    type=click.Choice(("touching", "adjacent", "none")),
    default="touching",
    show_default=True,
    help="Links that never collide: those that a joint joins (adjacent), also those that overlap "
    "at home (touching), or none but those of --srdf.",
)
@click.option(
    "--fuse",
    is_flag=True,
    help="Merge links that are fixed to another into it; their frames become sites.",
)
@click.option(
    "--actuator-config",
    metavar="FILE",
    type=Path,
    help='TOML file: under [joints."NAME or PATTERN"] kp, kd, armature, damping, friction, '
    "force-range, type.",
)
@click.option(
    "--armature",
    metavar="VALUE",
    type=click.FloatRange(min=0),
    help="Rotor inertia reflected at every joint [kg·m²; kg of a slide].",
)
@click.option(
    "--keep-locked-joints",
    is_flag=True,
    help="Keep joints with lower = upper, held by an equality; without it their links are welded.",
)
@fix_inertia_option
@click.option(
    "--decompose", is_flag=True, help="Cut meshes that collide and are not convex into pieces."
)
@export_options(
    mesh_dir="assets",
    verify=(
        "Compile it in MuJoCo and prove by comparison with IN: tree, masses, limits, base, "
        "contacts, friction, gravity, springs, actuators, sensors, looks, home position."
    ),
)
@gltf_option
@package_options
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
    """Turn the robot IN into a MuJoCo model, and prove that it is the same robot.

    One body a link, with its mass, names and limits as they are; meshes are copied or converted.
    What is lost is said, with its place.

    \b
        urdftool export mjcf panda.urdf -o panda/ --scene --verify
        urdftool export mjcf quadruped.urdf.xacro -o q/ --scene --actuators position
    """  # noqa: D301 -- click's mark for lines it must not wrap
    from ..api.export import cut_meshes, measure_overlap
    from ..formats.mjcf.options import Options
    from ..formats.registry import format_named
    from ..model.load import robot_of
    from .export_report import run_export

    mjcf, place = format_named("mjcf"), output or "-"
    description = read_strict(console, robot, package, package_path)
    model = robot_of(description)
    say_gltf(console, model)
    options = Options(
        mesh_dir="" if mesh_dir == "." else mesh_dir,
        file=Path(place).name if mjcf.has_suffix(place) else "",
        cutter=partial(cut_meshes, gltf_up=description.gltf_up) if decompose else None,
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
