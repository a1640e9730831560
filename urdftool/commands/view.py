"""``urdftool view``: the robot on a page with a slider a joint, or in a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .options import gltf_option, package_options, robot_argument
from .view_picture import picture_options

if TYPE_CHECKING:
    from ..model.elements import Robot


@click.command("view")
@robot_argument
@click.option(
    "--port",
    type=click.IntRange(1, 65535),
    help="Serve the page on that port; without it on 8733, or the next free one.",
)
@click.option(
    "--host",
    metavar="ADDRESS",
    help="Serve it on that address of this computer. Who can reach it sees and moves the robot.  "
    "[default: 127.0.0.1]",
)
@click.option("--open", "opened", is_flag=True, help="Open the page in the browser.")
@click.option("--no-lint", "unlinted", is_flag=True, help="Do not lint the robot on the page.")
@picture_options
@gltf_option
@package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    port: int | None,
    host: str | None,
    opened: bool,
    unlinted: bool,
    picture: str | None,
    contact_sheet: str | None,
    size: tuple[int, int] | None,
    camera: tuple[float, ...] | None,
    pose: dict[str, float],
    show: str,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Show IN, a robot or a mesh file, on a page in the browser, with a slider for each joint.

    Prints the page's address and serves it until Ctrl-C. Files that change are read again: the
    description, what it includes, its meshes. The page is for this computer alone, and fetches
    nothing from the network. With --picture or --contact-sheet there is no page and no browser.

    \b
        urdftool view arm.urdf.xacro prefix:=left_ --open
        urdftool view arm.urdf --pose elbow=1.2 --show both
        urdftool view arm.urdf --picture arm.png --camera 30,15
        urdftool view gripper.stl
    """  # noqa: D301 -- click reads the escape
    from .read_lax import read_lax
    from .view_mesh import is_mesh, read_mesh_robot

    path, arguments = robot

    def read() -> Robot:
        if is_mesh(path):
            return read_mesh_robot(console, path, package, package_path)
        return read_lax(console, path, arguments, package, package_path)

    if picture is not None or contact_sheet is not None:
        from .view_picture import check_pictures, write_pictures

        if port is not None or host is not None or opened:
            raise click.UsageError(
                "--port, --host and --open are for the page, which a picture is not"
            )
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
        )
    if size is not None or camera is not None:
        raise click.UsageError("--size and --camera are for --picture and --contact-sheet")
    from .view_page import serve_page

    serve_page(
        console,
        read,
        port=port,
        host=host,
        opened=opened,
        linted=not unlinted and not is_mesh(path),
        pose=pose,
        show=show,
    )
    return 0
