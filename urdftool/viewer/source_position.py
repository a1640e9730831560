"""The link of a robot at a line of its source."""

from __future__ import annotations

import os
from collections.abc import Iterator

from ..model.elements import Joint, Link, Robot
from ..source.location import SourceFile


def find_link_at(robot: Robot, path: str, line: int) -> str | None:
    """Return the link whose element, or that of its joint, is the last one to begin by a line.

    A line with a macro call or an include leads to the first link that it makes.

    Returns:
        Name of the link, for a joint that of its child; None if nothing begins by the line.
    """
    real = os.path.realpath(path)
    best: tuple[int, int, str] | None = None
    parts: list[Link | Joint] = [*robot.links, *robot.joints]
    for part in parts:
        for depth, (file, start) in enumerate(_list_sites(part)):
            if os.path.realpath(file.path) != real or file.position(start)[0] > line:
                continue
            link = part.child if isinstance(part, Joint) else part.name
            if (best is None or (start, -depth) > best[:2]) and link in robot.link:
                best = start, -depth, link
    return None if best is None else best[2]


def _list_sites(part: Link | Joint) -> Iterator[tuple[SourceFile, int]]:
    """Yield the file and first byte of an element, then those of the calls that led to it."""
    element = part.xml
    if element is None:
        return
    yield element.file, element.start
    for call in element.calls:
        yield call.file, call.start
