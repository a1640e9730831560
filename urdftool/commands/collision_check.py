"""``urdftool collision --check``: how good the collisions are that are there."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import click

from ..collision.check import check_link
from ..console import Console

if TYPE_CHECKING:
    from ..collision.links import Wishes
    from ..model.elements import Robot


def check(console: Console, robot: Robot, wishes: Wishes, values: dict[str, Any]) -> int:
    """Measure a robot's collisions; the exit code."""
    from ..collision.links import check_names
    from ..report import collision_check as report

    check_names(robot, (*wishes.only, *wishes.skip))
    found = []
    for link in robot.links:
        if (wishes.only and link.name not in wishes.only) or link.name in wishes.skip:
            continue
        checked = check_link(robot, link)
        if checked is not None:
            found.append(checked)
    assert robot.source is not None
    limit = wishes.settings.max_error
    if values["style"] == "json":
        click.echo(json.dumps(report.as_dict(robot.source.path, found, limit), indent=2))
    else:
        click.echo(report.table(found, limit), nl=False)
    for line in report.remarks(found, limit):
        console.say(line)
    bad = sum(not report.is_good(item, limit) for item in found)
    console.note(
        f"{robot.source.path}: {len(found)} links with visuals, {bad} not within {limit:.2%}"
    )
    return int(bad > 0)
