"""``urdftool.make_srdf``: the semantic description of a robot."""

from __future__ import annotations

from ..model.elements import Robot


def make_srdf(robot: Robot) -> str:
    """Return the text of an SRDF for a robot.

    Args:
        robot: A robot from ``load``.
    """
    from ..srdf.content import make_semantic
    from ..srdf.write import format_srdf

    return format_srdf(make_semantic(robot))
