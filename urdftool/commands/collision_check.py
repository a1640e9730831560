"""``urdftool collision --check``: measure existing collision geometry."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from ..collision.check import Checked, check_all, look_at
from ..collision.links import check_names
from ..console import Console
from ..report import collision_check as report
from ..report.counted import counted
from .progress import Progress
from .read_strict import say_gltf

if TYPE_CHECKING:
    from ..collision.links import Wishes
    from ..model.elements import Robot


def check(console: Console, robots: Sequence[tuple[Robot, Wishes]], values: dict[str, Any]) -> int:
    """Measure the collision geometry of robots, print the result, and return the exit code."""
    looks, owners = [], []
    for number, (robot, wishes) in enumerate(robots):
        check_names(robot, (*wishes.only, *wishes.skip))
        for link in robot.links:
            if (wishes.only and link.name not in wishes.only) or link.name in wishes.skip:
                continue
            look = look_at(robot, link, wishes.settings.max_error)
            if look is not None:
                looks.append(look)
                owners.append(number)
    with Progress(console, "links", patience=0) as progress:
        found = check_all(looks, jobs=values["jobs"], progress=progress)
    results, code = [], 0
    for number, (robot, wishes) in enumerate(robots):
        own = [item for item, owner in zip(found, owners, strict=True) if owner == number]
        assert robot.source is not None
        path, limit = robot.source.path, wishes.settings.max_error
        results.append(report.as_dict(path, own, limit))
        if values["style"] == "table":
            click.echo(report.table(own, limit), nl=False)
        code = max(code, _tell(console, robot, wishes, path, own))
    if values["style"] == "json":
        click.echo(json.dumps({"version": 1, "results": results}, indent=2))
    return code


def _nothing(robot: Robot, wishes: Wishes) -> str:
    """Explain why nothing was checked."""
    shapes = sum(bool(link.collisions) for link in robot.links)
    which = "none of the selected links" if wishes.only or wishes.skip else "no link"
    have = f" ({counted(shapes, 'link')} of the robot ha{'s' if shapes == 1 else 've'} collisions)"
    return f"{which} has visual geometry to compare with{have if shapes else ''}"


def _tell(
    console: Console, robot: Robot, wishes: Wishes, path: str, found: Sequence[Checked]
) -> int:
    limit = wishes.settings.max_error
    for line in report.remarks(found, limit):
        console.say(line)
    if not found:
        console.say(f"{path}: nothing was checked, because {_nothing(robot, wishes)}")
        return 2
    say_gltf(console, robot)
    bad = sum(not report.is_good(item, limit) for item in found)
    console.note(
        f"{path}: {counted(len(found), 'link')} with visuals, {bad} with an error above {limit:.2%}"
    )
    return int(bad > 0)
