"""``urdftool export usd``: convert a robot to a stage of OpenUSD."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..console import Console
from ..formats.usd.options import Options
from .export_many import ExportCommand, add_robots_argument
from .export_options import add_declared_options, add_output_option, make_export_options
from .export_pairs import prove_pairs
from .load_strict import report_gltf_axes
from .options import add_gltf_option, add_package_options, parse_pose
from .read_other import read_any

_GROUPS = {
    "Output": "output target layers isaaclab isaaclab_version overwrite style",
    "Robot": "base pose srdf self_collision approximation fix_inertia decompose",
    "Actuators": "actuators timestep actuator_config",
    "Verification": "verified strict force",
}


@click.command("usd", cls=ExportCommand, groups=_GROUPS)
@add_robots_argument
@add_output_option(".usda (text), .usdc (binary) or .usdz (package)")
@add_declared_options(Options, pose={"multiple": True, "callback": parse_pose})
@click.option(
    "--isaaclab",
    metavar="FILE",
    type=Path,
    help="Also write an ArticulationCfg for Isaac Lab to FILE (.py).",
)
@click.option(
    "--isaaclab-version",
    type=click.Choice(("2", "3")),
    default="3",
    show_default=True,
    help="Major version of Isaac Lab; versions differ in names and in the order of quaternions.",
)
@make_export_options(
    "Read the result back, with Newton too if it is installed, and compare it with IN: tree, "
    "masses, inertia, frames, limits, drives, friction, mimic, shapes, contacts."
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
    isaaclab: Path | None,
    isaaclab_version: str,
    **choices: Any,
) -> int:
    """Convert the robot IN to a stage of OpenUSD, for Isaac Sim, Isaac Lab and Newton.

    Each link with mass becomes a rigid body with the same mass, frame and joint limits. Every loss
    is reported with its place; --verify compares the stage with IN.

    \b
        urdftool export usd panda.urdf -o panda.usdc --verify
        urdftool export usd quadruped.urdf.xacro -o q/ --base free --target isaac
    """  # noqa: D301 -- click's mark for lines it must not wrap
    from ..api.export_usd import make_usd_options
    from ..api.plugin_checks import check_plugin_names
    from ..extras import require
    from ..formats.registry import format_named
    from .export_report import run_export

    require("'urdftool export usd'", "pxr")
    usd, place = format_named("usd"), output or "-"
    model = read_any(console, robot, package, package_path, quiet=True)
    report_gltf_axes(console, model)
    proofs = prove_pairs(console, model, choices["srdf"])
    if isaaclab is not None and place == "-":
        raise click.UsageError("--isaaclab requires -o OUT, the stage to which it refers")
    choices["state"], choices["pose"] = choices["pose"]
    options = make_usd_options(model, place, choices, proofs)
    code = run_export(
        console,
        usd,
        model,
        options,
        place,
        choices,
        more_checks=lambda robot: [*proofs.findings, *check_plugin_names(robot)],
    )
    if isaaclab is not None and code < 2:
        from ..formats.usd.isaaclab import write_config
        from ..formats.usd.write import get_stage_name

        stage = Path(place) if options.file else Path(place) / get_stage_name(model)
        assumed = write_config(
            model,
            options,
            stage,
            isaaclab,
            version=int(isaaclab_version),
            overwrite=choices["overwrite"],
        )
        for sentence in assumed:
            console.print_note(f"{isaaclab}: assumed: {sentence}")
    return code
