"""``urdftool export mjcf``: convert a robot to a MuJoCo model."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..console import Console
from ..formats.mjcf.options import Options
from .export_many import ExportCommand, add_robots_argument
from .export_options import add_declared_options, add_output_option, make_export_options
from .export_pairs import prove_pairs
from .load_strict import report_gltf_axes
from .options import add_gltf_option, add_package_options, parse_pose
from .read_other import read_any

_GROUPS = {
    "Output": "output purpose scene mesh_dir overwrite style",
    "Robot": "base pose srdf base_sensors exclude fuse keep_locked_joints fix_inertia decompose",
    "Actuators": "actuators timestep actuator_config armature",
    "Verification": "verified strict force",
}


@click.command("mjcf", cls=ExportCommand, groups=_GROUPS)
@add_robots_argument
@add_output_option(".xml or .mjcf")
@add_declared_options(Options, pose={"multiple": True, "callback": parse_pose})
@make_export_options(
    "Compile the result in MuJoCo and compare it with IN: tree, masses, limits, base, "
    "contacts, friction, gravity, springs, actuators, sensors, visuals, home position."
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
    """Convert the robot IN to a MuJoCo model (MJCF).

    Each link becomes a body with the same name, mass and joint limits; meshes are copied or
    converted. Every loss is reported with its place; --verify compares the model with IN.

    \b
        urdftool export mjcf panda.urdf -o panda/ --scene --verify
        urdftool export mjcf quadruped.urdf.xacro -o q/ --scene --for rl
    """  # noqa: D301 -- click's mark for lines it must not wrap
    from ..api.export import make_mjcf_options
    from ..api.plugin_checks import check_plugin_names
    from ..formats.registry import format_named
    from ..model.world import weld_base
    from .export_report import run_export

    mjcf, place = format_named("mjcf"), output or "-"
    model = weld_base(read_any(console, robot, package, package_path, quiet=True))
    report_gltf_axes(console, model)
    choices["state"], choices["pose"] = choices["pose"]
    proofs = prove_pairs(console, model, choices["srdf"])
    options = make_mjcf_options(model, place, choices, proofs)
    return run_export(
        console,
        mjcf,
        model,
        options,
        place,
        choices,
        more_checks=lambda robot: [*proofs.findings, *check_plugin_names(robot)],
    )
