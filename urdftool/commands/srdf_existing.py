"""``urdftool srdf --check`` and ``--update``: an existing SRDF."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console
from .srdf_picture import write_contacts

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..model.semantic import SemanticDescription
    from ..srdf.verdicts import Verdicts

F = TypeVar("F", bound=Callable[..., Any])


def add_existing_options(function: F) -> F:
    """Add ``--check FILE`` and ``--update FILE``."""
    function = click.option(
        "--update",
        metavar="FILE",
        help="Update the pairs of an SRDF, also in xacro; all other bytes stay. With -o, write the "
        "result there.",
    )(function)
    return click.option(
        "--check",
        metavar="FILE",
        help="Check the pairs of an SRDF; exit code 1 if one can touch that is disabled as Never "
        "or Adjacent. The reasons User, Default and Always count as right.",
    )(function)


def read_existing(
    console: Console, robot: Robot, arguments: dict[str, str], values: dict[str, Any]
) -> SemanticDescription | None:
    """Read the SRDF of ``--check`` or ``--update``; None without one.

    Raises:
        UsageError: Both options are given.
        UrdftoolError: The file cannot be read, or is of another robot.
    """
    from ..srdf.existing import check_robot, read_srdf

    if values["check"] and values["update"]:
        raise click.UsageError("--check and --update exclude each other")
    _check_style(values)
    path = values["check"] or values["update"]
    if not path:
        return None
    packages = robot.source.packages if robot.source is not None else None
    content = read_srdf(path, _select_arguments(path, arguments), packages)
    check_robot(robot, content)
    if content.name != robot.name:
        console.print_message(
            f"{content.element.place}: warning: the SRDF is for robot '{content.name}', but the "
            f"robot is '{robot.name}'"
        )
    return content


def _check_style(values: dict[str, Any]) -> None:
    """Refuse a format that the report on an existing SRDF does not have."""
    option = "--check" if values["check"] else "--update"
    if (values["check"] or values["update"]) and values["style"] not in ("srdf", "table", "json"):
        raise click.UsageError(f"{option} has no --format {values['style']}; json is possible")
    if values["update"] and values["style"] == "json" and values["output"] == "-":
        raise click.UsageError("--format json and -o - exclude each other")


def _select_arguments(path: str, arguments: dict[str, str]) -> dict[str, str]:
    """Return the xacro arguments for an SRDF: all, if it is xacro."""
    return arguments if path.endswith(".xacro") else {}


def check(
    console: Console,
    robot: Robot,
    content: SemanticDescription,
    verdicts: Verdicts,
    values: dict[str, Any],
) -> int:
    """Print what is known of the pairs of an SRDF; return 1 if one is wrong."""
    from ..output import write_result
    from ..report import srdf_existing as report
    from ..srdf.contact_poses import list_disabled_contacts
    from ..srdf.existing import judge

    found = list(judge(content, robot, verdicts))
    write_contacts(console, robot, list_disabled_contacts(found), values)
    text = report.to_json(found) if values["style"] == "json" else report.format_check(found)
    write_result(text, values["output"])
    console.print_note(f"{values['check']}: {report.format_summary(found)}")
    return int(report.is_wrong(found))


def update(
    console: Console,
    robot: Robot,
    content: SemanticDescription,
    verdicts: Verdicts,
    values: dict[str, Any],
) -> int:
    """Update the pairs of an SRDF, and list the changes.

    Returns:
        1 if a pair that can touch stays, or a proved pair could not be added.
    """
    from ..output import write_file, write_result
    from ..report import srdf_existing as report
    from ..srdf.contact_poses import list_disabled_contacts
    from ..srdf.existing import judge
    from ..srdf.update import update as update_pairs

    found = list(judge(content, robot, verdicts))
    changes = update_pairs(content, found)
    if values["style"] == "json":
        write_result(report.format_changes_as_json(changes), None)
    else:
        for line in report.list_changes(changes):
            console.print_message(line)
    target = values["output"] or values["update"]
    if target == "-":
        write_result(changes.data.decode("utf-8"), "-")
    elif changes.data != content.element.file.data or not Path(target).exists():
        write_file(target, changes.data)
    console.print_note(f"{target}: {report.format_update(changes, found)}")
    write_contacts(console, robot, list_disabled_contacts(found), values)
    return int(bool(changes.refused or changes.kept))
