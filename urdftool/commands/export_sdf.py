"""``urdftool export sdf``: the robot for Gazebo."""

from __future__ import annotations

from pathlib import Path

import click

from ..console import Console
from .options import package_options, robot_argument


@click.command("sdf")
@robot_argument
@click.option("-o", "--output", metavar="OUT", required=True, help="OUT.sdf, or a folder.")
@click.option(
    "--target",
    type=click.Choice(["gz", "gazebo-classic"]),
    default="gz",
    show_default=True,
    help="The Gazebo it is for.",
)
@click.option(
    "--sdf-version",
    type=click.Choice(["1.6", "1.7", "1.9", "1.10", "1.11", "1.12"]),
    help="Of SDF: 1.9 to 1.12 for gz (default 1.11), 1.6 and 1.7 for gazebo-classic (default 1.7).",
)
@click.option(
    "--fixed-joints",
    type=click.Choice(["keep", "lump"]),
    help="Keep them (default for gz), or make one link of what they join (for gazebo-classic).",
)
@click.option(
    "--uri",
    type=click.Choice(["relative", "model", "package", "file"]),
    help="How meshes are named; with package and file none is copied.",
)
@click.option("--mesh-dir", default="meshes", show_default=True, help="Where meshes go.")
@click.option("--world", is_flag=True, help="Write a world with ground and sun around it.")
@click.option("--overwrite", is_flag=True, help="Replace what is there and not ours.")
@click.option("--verify", is_flag=True, help="Read it back and compare it with the source.")
@click.option("--strict", is_flag=True, help="What can't be carried is an error.")
@click.option("--force", is_flag=True, help="Go on past errors in the source where one can.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
@package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    output: str,
    target: str,
    sdf_version: str | None,
    fixed_joints: str | None,
    uri: str | None,
    mesh_dir: str,
    world: bool,
    overwrite: bool,
    verify: bool,
    strict: bool,
    force: bool,
    form: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    r"""Turn the robot IN into SDF for Gazebo.

    OUT is one file where it ends in .sdf or .world, with its meshes beside it; else it is a folder
    with model.config, model.sdf and meshes. What is lost or changed is said, each with its place.

    \b
        urdftool export sdf arm.urdf.xacro -o arm --verify
        urdftool export sdf mira.urdf -o mira.sdf --target gazebo-classic
    """
    from ..formats.defects import Refused
    from ..formats.sdf.job import Job, options_for, run

    path, arguments = robot
    try:
        options = options_for(
            output,
            target=target,
            version=sdf_version or "",
            fixed_joints=fixed_joints or "",
            uri=uri or "",
            mesh_dir=mesh_dir,
            world=world,
            force=force,
        )
    except ValueError as error:
        raise click.UsageError(str(error)) from None
    job = Job(path, arguments, output, overwrite, verify, strict, form == "json")
    try:
        return run(console, job, options, package, package_path)
    except Refused as refused:
        for finding in refused.findings:
            click.echo(str(finding), err=True)
        return 2
