"""``urdftool collision``: simplify collision geometry and measure its error."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..collision.settings import MESH_FORMATS, PER, SOURCES, URIS
from ..console import Console
from .collision_options import (
    add_settings_options,
    check_sphere_options,
    check_spheres_file,
    limit_threads,
    require_libraries,
)
from .general_options import accept_general_options
from .grouped_help import GroupedCommand
from .options import (
    add_gltf_option,
    add_jobs_option,
    add_name_option,
    add_package_options,
    add_scheduler_option,
    split_arguments,
)
from .picture_file import check_picture_name


class _OrMesh(GroupedCommand):
    """Command for a robot that delegates to the command for a mesh if the first word is so."""

    def make_context(
        self,
        info_name: str | None,
        args: list[str],
        parent: click.Context | None = None,
        **extra: Any,
    ) -> click.Context:
        """Make the context of the command for a robot or, after ``mesh``, for a mesh file."""
        if args and args[0] == "mesh":
            from .collision_mesh import command as mesh

            return accept_general_options(mesh).make_context(
                f"{info_name} mesh", args[1:], parent=parent, **extra
            )
        return super().make_context(info_name, args, parent=parent, **extra)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Return the command for a mesh file, which the generated documentation includes."""
        from .collision_mesh import command as mesh

        return mesh if name == "mesh" else None


_GROUPS = {
    "What to do": "output in_place check",
    "Geometry": "method quality max_error per source only skip keep_primitives "
    "max_hulls max_vertices max_triangles threshold count cover",
    "Output": "style mesh_dir mesh_format uri spheres_file overwrite picture",
    "Performance": "jobs time_limit scheduler",
}


@click.command("collision", cls=_OrMesh, groups=_GROUPS)
@click.argument("words", nargs=-1, metavar="IN [name:=value ...]")
@add_name_option
@click.option("-o", "--output", metavar="OUT", help="Write a new URDF; for folders, a folder.")
@click.option("--in-place", is_flag=True, help="Edit the collision geometry in the source files.")
@click.option("--check", is_flag=True, help="Measure the existing collision geometry; write none.")
@add_settings_options
@click.option(
    "--spheres-file",
    metavar="FILE",
    help="Write the spheres of --method spheres also for planners: .yml for cuRobo, .json for "
    "pyroki.",
)
@click.option(
    "--from",
    "source",
    type=click.Choice(SOURCES),
    help="Meshes to simplify.  [default: visual; collision for links without visuals]",
)
@click.option(
    "--link", "only", multiple=True, metavar="NAME", help="Process only this link. Repeatable."
)
@click.option(
    "--skip-link", "skip", multiple=True, metavar="NAME", help="Skip this link. Repeatable."
)
@click.option(
    "--per",
    type=click.Choice(PER),
    help="Decompose the meshes of a link together, or each of them. --max-error and --max-hulls "
    "are those of one result.  [default: link with --method auto and cuts; mesh with --in-place "
    "of a xacro file]",
)
@click.option(
    "--keep-primitives/--replace-primitives",
    default=True,
    help="Keep or replace collisions that are primitives.  [default: keep]",
)
@click.option(
    "--mesh-dir", metavar="DIR", help="Folder of the new mesh files.  [default: next to OUT]"
)
@click.option(
    "--uri",
    type=click.Choice(URIS),
    default="auto",
    show_default=True,
    metavar="FORM",
    help="URIs of new meshes: package, relative (also rewrites the URIs of existing meshes), file, "
    "or auto (the form of the robot's meshes).",
)
@click.option(
    "--mesh-format",
    type=click.Choice(MESH_FORMATS),
    default="stl",
    show_default=True,
    help="Format of the new mesh files.",
)
@add_jobs_option
@add_scheduler_option
@add_gltf_option
@add_package_options
@click.pass_context
def command(ctx: click.Context, /, words: tuple[str, ...], **values: Any) -> int:
    """Replace the collision geometry of the robot IN by simple shapes of known error.

    IN is a .urdf or .xacro file, or a folder with robots. In OUT, each convex piece is a
    <collision>. To simplify a single mesh file: 'urdftool collision mesh IN.stl -o OUT.stl'.

    \b
        urdftool collision arm.urdf -o arm_sim.urdf --quality tight
        urdftool collision arm.urdf.xacro --in-place --link forearm
        urdftool collision robots/ -o simulated/ -j 8
        urdftool collision arm.urdf --check

    Exit code 1: --check measures an error above --max-error. Exit code 2: a mesh cannot be used, or
    there is nothing to check.
    """  # noqa: D301 -- \b is a character that click looks for
    console: Console = ctx.obj
    paths, arguments = split_arguments(words)
    if not paths:
        raise click.UsageError("missing argument IN: a .urdf or .xacro file, or a folder")
    output, in_place, check = values["output"], values["in_place"], values["check"]
    if sum((output is not None, in_place, check)) != 1:
        raise click.UsageError("exactly one of -o OUT, --in-place and --check is required")
    if in_place and "-" in paths:
        raise click.UsageError("standard input cannot be edited in place; use -o OUT")
    if check and values["scheduler"]:
        raise click.UsageError("--check does not support --scheduler")
    check_picture_name(values["picture"])
    check_sphere_options(values)
    check_spheres_file(values["spheres_file"], values["method"])
    require_libraries(values["method"], check=check)
    limit_threads()
    from . import collision_robot as robots

    several = len(paths) > 1 or Path(paths[0]).is_dir()
    if several:
        return robots.process_fleet(ctx, console, paths, arguments, values)
    return robots.process_one(ctx, console, paths[0], arguments, values)
