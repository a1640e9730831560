"""``urdftool view``: show a robot on a web page with joint sliders, or in a picture."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import add_gltf_option, add_package_options, add_robot_argument
from .view_picture import add_picture_options

if TYPE_CHECKING:
    from ..model.elements import Robot


_GROUPS = {
    "Page": "opened at port host srdf unlinted",
    "Picture": "picture findings contact_sheet size camera",
    "Robot": "pose show",
}


@click.command("view", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@click.option(
    "--port",
    type=click.IntRange(1, 65535),
    metavar="PORT",
    help="Port of the page.  [default: 8733, or the next free port]",
)
@click.option(
    "--host",
    metavar="ADDRESS",
    help="Network address of the page; everyone with access can move the robot.  "
    "[default: 127.0.0.1]",
)
@click.option("--open", "opened", is_flag=True, help="Open the page in the browser.")
@click.option(
    "--at",
    metavar="FILE:LINE",
    help="Select the link whose element, or whose joint, is at a line of the source.",
)
@click.option(
    "--srdf",
    metavar="FILE",
    help="SRDF: the page shows the joint positions at which pairs that it disables touch.",
)
@click.option("--no-lint", "unlinted", is_flag=True, help="Show no lint findings on the page.")
@add_picture_options
@add_gltf_option
@add_package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    port: int | None,
    host: str | None,
    opened: bool,
    at: str | None,
    srdf: str | None,
    unlinted: bool,
    picture: str | None,
    contact_sheet: str | None,
    findings: bool,
    size: tuple[int, int] | None,
    camera: tuple[float, ...] | None,
    pose: dict[str, float],
    show: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Show the robot or mesh file IN on a web page, with a slider for each joint.

    Prints the address of the page and serves it until Ctrl-C; reloads the description, included
    files and meshes when they change. The page loads nothing from the network. With --picture or
    --contact-sheet, a file is written and no page is served.

    \b
        urdftool view arm.urdf.xacro prefix:=left_ --open
        urdftool view arm.urdf --pose elbow=1.2 --show both
        urdftool view arm.urdf --srdf arm.srdf
        urdftool view arm.urdf --picture arm.png --camera 30,15
        urdftool view gripper.stl
    """  # noqa: D301 -- click reads the escape
    from .load_tolerant import load_tolerant
    from .view_mesh import is_mesh, read_mesh_robot

    path, arguments = robot

    def read() -> Robot:
        if is_mesh(path):
            return read_mesh_robot(console, path, package, package_path)
        return load_tolerant(console, path, arguments, package, package_path)

    if picture is not None or contact_sheet is not None:
        from .view_picture import check_pictures, write_pictures

        if port is not None or host is not None or opened or at is not None:
            raise click.UsageError(
                "--picture and --contact-sheet exclude --port, --host, --open and --at"
            )
        if srdf is not None:
            raise click.UsageError(
                "--srdf is for the page; 'srdf --check FILE --picture FILE.png' draws the pairs"
            )
        if findings and (picture is None or is_mesh(path)):
            raise click.UsageError("--findings requires --picture FILE.png of a robot")
        check_pictures(picture, contact_sheet)
        return write_pictures(
            console,
            read(),
            picture=picture,
            contact_sheet=contact_sheet,
            size=size,
            camera=camera,
            pose=pose,
            show=show,
            findings=findings,
        )
    if findings:
        raise click.UsageError("--findings requires --picture; the page shows them without it")
    if size is not None or camera is not None:
        raise click.UsageError("--size and --camera require --picture or --contact-sheet")
    from .view_page import serve_page

    serve_page(
        console,
        read,
        port=port,
        host=host,
        opened=opened,
        at=None if at is None else _read_line(at),
        linted=not unlinted and not is_mesh(path),
        pose=pose,
        show=show,
        srdf=srdf,
        arguments=arguments,
    )
    return 0


def _read_line(text: str) -> tuple[str, int]:
    """Return the file and line of ``FILE:LINE`` or ``FILE:LINE:COLUMN``.

    Raises:
        click.UsageError: It is written in another way.
    """
    match = re.fullmatch(r"(.+?):(\d{1,9})(?::\d+)?", text)
    if match is None:
        raise click.UsageError(f"--at requires FILE:LINE, such as arm.urdf.xacro:12, not '{text}'")
    return match[1], int(match[2])
