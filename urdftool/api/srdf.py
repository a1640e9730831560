"""``urdftool.make_srdf``: the semantic description of a robot."""

from __future__ import annotations

from ..model.elements import Robot
from ..suggestions import require_number
from .places import check_jobs


def make_srdf(
    robot: Robot,
    *,
    visual: bool = False,
    default: bool = False,
    boxes: int | None = None,
    jobs: int | None = None,
) -> str:
    """Return the text of an SRDF for a robot, with the pairs that are proved never to touch.

    Args:
        robot: A robot from ``load``.
        visual: Whether the visual geometry is compared.
        default: Whether pairs that touch at the default pose are disabled.
        boxes: Largest number of boxes of joint values for each two bodies.
        jobs: Number of processes; None is one per core.

    Raises:
        ConfigError: A number is not at least 1.
        MissingDependency: python-fcl is not installed.
    """
    check_jobs(jobs)
    if boxes is not None:
        require_number("boxes", boxes, 1)
    from ..srdf.content import list_comments, make_semantic
    from ..srdf.verdicts import Options, decide
    from ..srdf.write import format_srdf

    options = Options(boxes=boxes, visual=visual, default=default, jobs=jobs)
    verdicts = decide(robot, options)
    return format_srdf(make_semantic(robot, verdicts), tuple(list_comments(robot, verdicts)))
