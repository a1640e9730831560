"""``urdftool collision``: simpler shapes for contact, measured."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..console import Console
from .collision_options import one_thread_each, require_libraries, settings_options
from .general_options import accept_general_options
from .options import gltf_option, package_options, split_arguments
from .picture_file import checked_picture


class _OrMesh(click.Command):
    """A robot, unless the first word is ``mesh``."""

    def make_context(
        self,
        info_name: str | None,
        args: list[str],
        parent: click.Context | None = None,
        **extra: Any,
    ) -> click.Context:
        """The context of the robot's command, or of the mesh's."""
        if args and args[0] == "mesh":
            from .collision_mesh import command as mesh

            return accept_general_options(mesh).make_context(
                f"{info_name} mesh", args[1:], parent=parent, **extra
            )
        return super().make_context(info_name, args, parent=parent, **extra)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """The mesh's command, for those who write help pages."""
        from .collision_mesh import command as mesh

        return mesh if name == "mesh" else None


@click.command("collision", cls=_OrMesh)
@click.argument("words", nargs=-1, metavar="IN [name:=value ...]")
@click.option("-o", "--output", metavar="OUT", help="The new URDF; for folders, a folder.")
@click.option("--in-place", is_flag=True, help="Edit the source itself, only where it changes.")
@click.option("--check", is_flag=True, help="Measure the collisions that are there instead.")
@settings_options
@click.option(
    "--from",
    "source",
    type=click.Choice(["visual", "collision"]),
    help="The meshes to simplify; without it visuals, or collisions where there are none.",
)
@click.option("--link", "only", multiple=True, metavar="NAME", help="This link. Repeatable.")
@click.option("--skip-link", "skip", multiple=True, metavar="NAME", help="Not this. Repeatable.")
@click.option(
    "--keep-primitives/--replace-primitives",
    default=True,
    help="Leave collisions that are primitives already.  [default: keep]",
)
@click.option("--mesh-dir", metavar="DIR", help="Folder of the pieces; default: beside OUT.")
@click.option(
    "--uri",
    type=click.Choice(["auto", "package", "relative", "file"]),
    default="auto",
    help="How pieces are named; auto: as the robot names its own meshes. relative holds for "
    "its own, too, so that engines without ROS find them.",
)
@click.option(
    "--mesh-format", type=click.Choice(["stl", "obj"]), default="stl", help="Files of the pieces."
)
@click.option("-j", "--jobs", type=click.IntRange(1), metavar="N", help="Processes to use.")
@click.option("--scheduler", metavar="ADDRESS", help="A Dask scheduler that does the work.")
@gltf_option
@package_options
@click.pass_context
def command(ctx: click.Context, /, words: tuple[str, ...], **values: Any) -> int:
    """Give the links of IN collision geometry that is cheap, tight and measured.

    IN is a .urdf or .xacro file; folders are searched for robots. OUT is the robot with one
    <collision> a piece, its mesh files in --mesh-dir. 'urdftool collision mesh IN.stl -o OUT.stl'
    simplifies one mesh.

    \b
        urdftool collision arm.urdf -o arm_sim.urdf --max-error 0.01
        urdftool collision arm.urdf.xacro --in-place --link forearm
        urdftool collision robots/ -o simulated/ -j 8
        urdftool collision arm.urdf --check

    Exit 1 if --check finds an error above --max-error, 2 if a mesh cannot be used or there
    is nothing to check.
    """  # noqa: D301 -- \b is a character that click looks for
    console: Console = ctx.obj
    paths, arguments = split_arguments(words)
    if not paths:
        raise click.UsageError("a robot is wanted: a .urdf or .xacro file, or a folder of them")
    output, in_place, check = values["output"], values["in_place"], values["check"]
    if sum((output is not None, in_place, check)) != 1:
        raise click.UsageError("one of -o OUT, --in-place and --check is wanted")
    if in_place and "-" in paths:
        raise click.UsageError("standard input cannot be edited in place; use -o OUT")
    if check and values["scheduler"]:
        raise click.UsageError("--check measures here; --scheduler is for making collisions")
    checked_picture(values["picture"])
    require_libraries(values["method"], check=check)
    one_thread_each()
    from . import collision_robot as robots

    several = len(paths) > 1 or Path(paths[0]).is_dir()
    if several:
        return robots.fleet(ctx, console, paths, arguments, values)
    return robots.one(ctx, console, paths[0], arguments, values)
