"""Report visuals whose mesh was not read: the checks of a run have not looked at them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ...diagnostic import Severity
from ...errors import UrdftoolError
from ...model.elements import Link, Mesh, Robot
from ...source.location import Place
from ..fault import Fault
from ..mesh_cache import explain_unread

_CAUSE = "no check looked at it: whether it reaches the ground, or is where its collision is"


class _Unread(NamedTuple):
    """A visual that was not read: its mesh, place, and the reason."""

    filename: str
    place: Place | None
    error: UrdftoolError


def report_unread_visuals(robot: Robot) -> Iterator[Fault]:
    """Report each link with a visual mesh that was not read."""
    for link in robot.links:
        if unread := list(_list_unread(robot, link)):
            first, count = unread[0], len(unread)
            more = f" and {count - 1} more" if count > 1 else ""
            yield Fault(
                "visual-not-read",
                Severity.INFO,
                f"link '{link.name}': visual mesh '{first.filename}'{more} was not read: "
                f"{first.error.message}",
                first.place,
                "link",
                link.name,
                _CAUSE,
            )


def _list_unread(robot: Robot, link: Link) -> Iterator[_Unread]:
    """List the visuals of a link whose mesh was not read."""
    for visual in link.visuals:
        geometry = visual.geometry
        if isinstance(geometry, Mesh) and (error := explain_unread(robot, geometry)) is not None:
            yield _Unread(geometry.filename, visual.place, error)
