"""``urdftool collision --check``: measure existing collision geometry."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from ..collision.check import Checked, check_all, look_at
from ..collision.links import get_settings, list_selected
from ..console import Console
from ..report import collision_check as report
from ..report.counted import format_count
from ..report.json_text import format_json
from .load_strict import report_gltf_axes
from .progress import Progress

if TYPE_CHECKING:
    from ..collision.links import CollisionOptions
    from ..model.elements import Robot


def check(
    console: Console, robots: Sequence[tuple[Robot, CollisionOptions]], values: dict[str, Any]
) -> int:
    """Measure the collision geometry of robots, print the result, and return the exit code."""
    looks, owners = [], []
    for number, (robot, options) in enumerate(robots):
        for _, link, settings in list_selected(robot, options):
            look = look_at(robot, link, settings.max_error)
            if look is not None:
                looks.append(look)
                owners.append(number)
    with Progress(console, "links", patience=0) as progress:
        checks = check_all(looks, jobs=values["jobs"], progress=progress)
    results, code = [], 0
    for number, (robot, options) in enumerate(robots):
        own = [item for item, owner in zip(checks, owners, strict=True) if owner == number]
        assert robot.source is not None
        path = robot.source.path
        results.append(report.as_dict(path, own, get_settings("", options)[0].max_error))
        if values["style"] == "table":
            click.echo(report.format_table(own), nl=False)
        code = max(code, _report(console, robot, options, path, own))
    if values["style"] == "json":
        click.echo(format_json({"version": 1, "results": results}, 2))
    return code


def _explain_nothing(robot: Robot, options: CollisionOptions) -> str:
    """Explain why nothing was checked."""
    shapes = sum(bool(link.collisions) for link in robot.links)
    is_whole = len(list(list_selected(robot, options))) == len(robot.links)
    which = "no link" if is_whole else "none of the selected links"
    have = (
        f" ({format_count(shapes, 'link')} of the robot ha{'s' if shapes == 1 else 've'} "
        "collisions)"
    )
    return f"{which} has visual geometry to compare with{have if shapes else ''}"


def _report(
    console: Console, robot: Robot, options: CollisionOptions, path: str, found: Sequence[Checked]
) -> int:
    for line in report.format_remarks(found):
        console.print_message(line)
    if not found:
        console.print_message(
            f"{path}: nothing was checked, because {_explain_nothing(robot, options)}"
        )
        return 2
    report_gltf_axes(console, robot)
    console.print_note(f"{path}: {report.summarize(found)}")
    if any(item.is_unmeasured for item in found):
        return 2
    return int(not all(item.is_good for item in found))
