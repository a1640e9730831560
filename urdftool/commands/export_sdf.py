"""``urdftool export sdf``: the robot for Gazebo."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .export_options import export_options, fix_inertia_option
from .options import gltf_option, package_options, robot_argument
from .read_strict import read_strict, say_gltf

if TYPE_CHECKING:
    from ..formats.sdf.options import Options


@click.command("sdf")
@robot_argument
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="A folder, or a file that ends in .sdf, .xml or .world; '-' is standard output.",
)
@click.option(
    "--target",
    type=click.Choice(("gz", "gazebo-classic")),
    default="gz",
    show_default=True,
    help="The Gazebo it is for.",
)
@click.option(
    "--sdf-version",
    "version",
    type=click.Choice(("1.6", "1.7", "1.9", "1.10", "1.11", "1.12")),
    help="1.9 to 1.12 for gz (default 1.11), 1.6 and 1.7 for gazebo-classic (default 1.7).",
)
@click.option(
    "--fixed-joints",
    type=click.Choice(("keep", "lump")),
    help="Keep them (default for gz), or make one link of what they join (for gazebo-classic).",
)
@click.option(
    "--uri",
    type=click.Choice(("relative", "model", "package", "file")),
    help="How meshes are named; with package and file none is copied.",
)
@click.option("--world", is_flag=True, help="Write a world with ground and sun around it.")
@click.option(
    "--actuator-config",
    metavar="FILE",
    type=Path,
    help='TOML file: under [joints."NAME or PATTERN"] damping, friction, force-range; the same '
    "file as for export mjcf.",
)
@fix_inertia_option
@export_options(
    mesh_dir="meshes",
    verify=(
        "Read it back and prove by comparison with IN: tree, masses, limits, base, contacts, "
        "friction, flags, springs, sensors, plugins, looks."
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
    overwrite: bool,
    strict: bool,
    verified: bool,
    style: str,
    **choices: Any,
) -> int:
    """Turn the robot IN into SDF for Gazebo, and prove that it is the same robot.

    A folder has model.config, model.sdf and meshes; a file its meshes beside it. Links, joints and
    what <gazebo> says of them stay under their names. What is lost is said, with its place.

    \b
        urdftool export sdf arm.urdf.xacro -o arm/ --verify
        urdftool export sdf mira.urdf -o mira.sdf --target gazebo-classic
    """  # noqa: D301 -- click reads the escape
    from ..api.export import check_plugins
    from ..formats.registry import format_named
    from ..model.load import robot_of
    from .export_report import run_export

    place = output or "-"
    options = _options(place, choices)
    model = robot_of(read_strict(console, robot, package, package_path))
    say_gltf(console, model)
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


def _options(output: str, choices: dict[str, Any]) -> Options:
    """The choices, with those that follow from where it goes."""
    from ..formats.sdf.options import MODEL, VERSIONS, Options, folder_and_file

    target, version = choices["target"], choices.pop("version") or ""
    if version and version not in VERSIONS[target]:
        known = ", ".join(VERSIONS[target])
        raise click.UsageError(f"{target} reads SDF {known}; {version} is for the other Gazebo")
    folder, file = folder_and_file(MODEL if output == "-" else output)
    config = choices.pop("actuator_config")
    choices = {name: value or "" if value is None else value for name, value in choices.items()}
    if output == "-" and not choices["uri"]:
        choices["uri"] = "file"  # nothing can lie beside standard output
    return Options(
        version=version,
        folder=folder,
        file=file,
        actuator_config=config,
        **choices,
    )
