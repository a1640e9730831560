"""The page of ``urdftool view``, from its address to Ctrl-C."""

from __future__ import annotations

import webbrowser
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from ..console import Console
from ..output import write_result
from .progress import Progress

if TYPE_CHECKING:
    from ..drawing.shapes import Shapes
    from ..finding import Finding
    from ..model.elements import Robot


def serve_page(
    console: Console,
    read: Callable[[], Robot],
    *,
    port: int | None,
    host: str | None,
    opened: bool,
    linted: bool,
    pose: Mapping[str, float],
    show: str,
) -> None:
    """Serve the page until somebody stops it.

    Raises:
        UrdftoolError: There is no robot that could be shown, no joint that was named, no such
            address, or viser is not installed.
    """
    from ..model.kinematics import check_positions
    from ..viewer.page import Page, worthy
    from ..viewer.server import LOOPBACK, address, choose_port, is_loopback, start

    robot = worthy(read())
    check_positions(robot, pose)
    host = host or LOOPBACK
    port = choose_port(host, port)
    if not is_loopback(host):
        console.say(f"warning: whoever can reach {host} sees the robot, and may move it")
    pages: list[Page] = []
    server = start(host, port, lambda: pages[0].title if pages else "urdftool")
    try:
        page = Page(
            server,
            robot,
            read,
            partial(_load, console),
            partial(_check, console) if linted else None,
            start=pose,
            shown=("errors", *(("visual", "collision") if show == "both" else (show,))),
        )
        pages.append(page)
        where = address(host, port)
        write_result(f"{where}\n", None)
        console.note("Ctrl-C ends it")
        if opened and not webbrowser.open(where):
            console.say("warning: no browser could be opened")
        page.run()
    finally:
        server.stop()


def _load(console: Console, robot: Robot, kind: str) -> Shapes:
    from ..drawing.shapes import robot_shapes

    with Progress(console, "meshes") as progress:
        return robot_shapes(robot, show=kind, progress=progress)


def _check(console: Console, robot: Robot) -> list[Finding]:
    from ..lint.run import check

    return check(robot, config=console.config)
