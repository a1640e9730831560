"""Serve the page of ``urdftool view`` until Ctrl-C."""

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
    from ..model.pair_pose import PairPose
    from ..viewer.page import Page


def serve_page(
    console: Console,
    read: Callable[[], Robot],
    *,
    port: int | None,
    host: str | None,
    opened: bool,
    at: tuple[str, int] | None = None,
    linted: bool,
    pose: Mapping[str, float],
    show: str,
    srdf: str | None = None,
    arguments: Mapping[str, str] | None = None,
) -> None:
    """Serve the page until Ctrl-C.

    Raises:
        UrdftoolError: The robot has no links, a joint of the pose does not exist, the address
            cannot be used, or viser is not installed.
    """
    from ..model.kinematics import check_positions
    from ..viewer.page import Page, require_viewable
    from ..viewer.server import LOOPBACK, choose_port, is_loopback, make_token, make_url, start

    robot = require_viewable(read())
    check_positions(robot, pose)
    if srdf is not None:
        _check_srdf(robot, srdf, dict(arguments or {}))
    host = host or LOOPBACK
    port = choose_port(host, port)
    if not is_loopback(host):
        console.print_message(
            f"warning: everyone with network access to {host} and the address below can see and "
            "move the robot; the connection is not encrypted"
        )
    pages: list[Page] = []
    token = make_token()
    server = start(host, port, token, lambda: pages[0].title if pages else "urdftool")
    try:
        page = Page(
            server,
            robot,
            read,
            partial(_load, console),
            partial(_check, console) if linted else None,
            start=pose,
            shown=("errors", *(("visual", "collision") if show == "both" else (show,))),
            compare=partial(_compare, srdf, dict(arguments or {})) if srdf is not None else None,
            more=() if srdf is None else (srdf,),
        )
        pages.append(page)
        if at is not None:
            _select_link(console, page, robot, *at)
        where = make_url(host, port, token)
        write_result(f"{where}\n", None)
        console.print_note("press Ctrl-C to stop")
        if opened and not webbrowser.open(where):
            console.print_message("warning: the browser cannot be opened; open the address above")
        page.run()
    finally:
        server.stop()


def _select_link(console: Console, page: Page, robot: Robot, path: str, line: int) -> None:
    from ..viewer.source_position import find_link_at

    link = find_link_at(robot, path, line)
    if link is None:
        console.print_message(f"{path}:{line}: no link or joint of the robot begins by this line")
    else:
        page.select(link)
        console.print_note(f"{path}:{line}: link '{link}'")


def _load(console: Console, robot: Robot, kind: str) -> Shapes:
    from ..drawing.shapes import read_robot_shapes

    with Progress(console, "meshes") as progress:
        return read_robot_shapes(robot, show=kind, progress=progress)


def _check(console: Console, robot: Robot) -> list[Finding]:
    from ..api.lint import check

    return check(robot, config=console.config)


def _check_srdf(robot: Robot, srdf: str, arguments: dict[str, str]) -> None:
    """Check that an SRDF can be read, and that its pairs can be compared."""
    from ..extras import require
    from ..srdf.contact_poses import read_srdf_of

    require("--srdf", "fcl", "manifold3d")
    read_srdf_of(robot, srdf, arguments)


def _compare(srdf: str, arguments: dict[str, str], robot: Robot) -> list[PairPose]:
    """Find the disabled pairs that can touch, in this process, which has threads."""
    from ..srdf.contact_poses import find_disabled_contacts
    from ..srdf.verdicts import Options

    return find_disabled_contacts(robot, srdf, arguments, Options(jobs=1))
