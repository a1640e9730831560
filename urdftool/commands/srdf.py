"""``urdftool srdf``: write the SRDF of a robot, with proved pairs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import (
    FiniteRange,
    add_gltf_option,
    add_jobs_option,
    add_package_options,
    add_robot_argument,
    make_output_option,
)
from .progress import Progress
from .srdf_existing import add_existing_options, check, read_existing, update
from .srdf_groups import add_group_option, report_groups
from .srdf_moveit import add_moveit_options, write_package
from .srdf_picture import add_picture_option, check_picture_target, write_contacts

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..model.semantic import SemanticDescription
    from ..srdf.groups import GivenGroup
    from ..srdf.verdicts import Verdicts

_GROUPS = {
    "Existing SRDF": "check update",
    "Pairs": "visual default",
    "Content": "given_groups",
    "MoveIt": "moveit distribution",
    "Output": "style output picture",
    "Performance": "boxes time_limit jobs",
}

_STYLES = ("srdf", "mjcf", "curobo", "pyroki", "usd", "table", "json")


@click.command("srdf", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@click.option(
    "--visual", is_flag=True, help="Compare the visual geometry instead of the collision geometry."
)
@click.option(
    "--default",
    is_flag=True,
    help="Disable pairs that touch at the default pose: 0, or the middle of a range without 0.",
)
@click.option(
    "--format",
    "style",
    type=click.Choice(_STYLES),
    default="srdf",
    show_default=True,
    help="Output format: SRDF; the disabled pairs for MuJoCo, cuRobo, pyroki or OpenUSD; or all "
    "pairs with their verdicts.",
)
@make_output_option("Output file.  [default: standard output]")
@add_picture_option
@add_group_option
@add_moveit_options
@add_existing_options
@click.option(
    "--boxes",
    type=click.IntRange(1),
    metavar="N",
    help="Largest number of boxes of joint values for each two bodies.  [default: 40000, or fewer "
    "for a robot of more than 20 bodies]",
)
@click.option(
    "--time",
    "time_limit",
    type=FiniteRange(0.0),
    metavar="S",
    help="Time after which no proof begins; the pairs left stay enabled [s].  [default: no limit]",
)
@add_jobs_option
@add_gltf_option
@add_package_options
@click.pass_context
def command(
    ctx: click.Context,
    /,
    robot: tuple[str, dict[str, str]],
    package: dict[str, Path],
    package_path: tuple[str, ...],
    **values: Any,
) -> int:
    """Write the SRDF of the robot IN, which MoveIt reads, with proved pairs.

    A pair of links is disabled if one joint connects the two, or if a proof shows that they touch
    at no joint values within the limits. For a pair that can touch, the report has joint positions
    at which it does. A pair that is not decided stays enabled.

    \b
        urdftool srdf arm.urdf.xacro -o arm.srdf
        urdftool srdf arm.urdf.xacro --group manipulator=base_link:flange
        urdftool srdf arm.urdf.xacro --check arm.srdf --picture contacts.png
        urdftool srdf arm.urdf --format table
        urdftool srdf arm.urdf.xacro --moveit arm_moveit_config
    """  # noqa: D301 -- click reads the escape
    from ..output import check_targets, write_result
    from ..srdf.contact_poses import list_contact_poses
    from ..srdf.groups import find_groups
    from .load_tolerant import load_tolerant

    console, (path, arguments) = ctx.obj, robot
    model = load_tolerant(console, path, arguments, package, package_path)
    inputs = [file.path for file in model.source.files] if model.source else []
    existing = read_existing(console, model, arguments, values)
    check_targets([values["output"], values["picture"]], inputs=inputs)
    check_picture_target(model, values)
    find_groups(model, values["given_groups"])  # an error of a group comes before the proof
    if values["moveit"] is not None:
        return write_moveit(console, model, values, package, package_path)
    verdicts = decide_pairs(console, model, values)
    if existing is not None:
        run = check if values["check"] else update
        return run(console, model, existing, verdicts, values)
    text = format_result(console, model, verdicts, values)
    write_result(text, values["output"], inputs=inputs)
    write_contacts(console, model, list_contact_poses(verdicts), values)
    return 0


def write_moveit(
    console: Console,
    robot: Robot,
    values: dict[str, Any],
    packages: dict[str, Path],
    package_paths: tuple[str, ...],
) -> int:
    """Write a MoveIt package, and return the exit code."""
    if values["output"] is not None or values["style"] != "srdf":
        raise click.UsageError("--moveit writes files to its package; leave out --output, --format")
    folder, given = values["moveit"], values["given_groups"]

    def make_srdf() -> tuple[SemanticDescription, str]:
        return make_content(console, robot, decide_pairs(console, robot, values), given)

    def decide() -> Verdicts | None:
        from ..srdf.verdicts import list_shaped_links

        if list_shaped_links(robot, visual=values["visual"]):
            return decide_pairs(console, robot, values)
        console.print_message("warning: no link has geometry, so the pairs are not compared")
        return None

    makers = (make_srdf, decide)
    distribution = values["distribution"]
    return write_package(
        console, robot, folder, distribution, makers, given, packages, package_paths
    )


def decide_pairs(console: Console, robot: Robot, values: dict[str, Any]) -> Verdicts:
    """Decide the pairs of a robot, and print the summary and what is open."""
    from ..report import srdf as report
    from ..srdf.verdicts import Options, decide

    check_shapes(robot, visual=values["visual"])
    options = Options(
        boxes=values["boxes"],
        visual=values["visual"],
        time_limit=values["time_limit"],
        jobs=values["jobs"],
        default=values["default"],
    )
    with Progress(console, "pairs of bodies") as progress:
        verdicts = decide(robot, options, progress)
    for line in (*report.list_problems(verdicts), *report.list_open(verdicts)):
        console.print_message(line)
    console.print_note(report.format_summary(verdicts))
    return verdicts


def check_shapes(robot: Robot, *, visual: bool) -> None:
    """Check that there is something to compare.

    Raises:
        ModelError: No link has the geometry.
    """
    from ..errors import ModelError
    from ..srdf.verdicts import list_shaped_links

    if list_shaped_links(robot, visual=visual):
        return
    advice = ""
    if not visual and list_shaped_links(robot, visual=True):
        advice = "; use --visual to compare the visual geometry"
    kind = "visual" if visual else "collision"
    raise ModelError(f"no link has {kind} geometry, so no pair can be compared{advice}")


def format_result(
    console: Console, robot: Robot, verdicts: Verdicts, values: dict[str, Any]
) -> str:
    """Format the result."""
    from ..report import srdf as report
    from ..srdf.content import list_disabled
    from ..srdf.other_formats import FORMATS

    style = values["style"]
    if style == "table":
        return report.format_table(verdicts)
    if style == "json":
        return report.to_json(verdicts)
    if style in FORMATS:
        return FORMATS[style](robot, list_disabled(verdicts))
    return make_content(console, robot, verdicts, values["given_groups"])[1]


def make_content(
    console: Console, robot: Robot, verdicts: Verdicts, given: tuple[GivenGroup, ...]
) -> tuple[SemanticDescription, str]:
    """Make the content of an SRDF and its text, and print its groups."""
    from ..srdf.content import list_comments, make_semantic
    from ..srdf.write import format_srdf

    content = make_semantic(robot, verdicts, given)
    report_groups(console, content)
    return content, format_srdf(content, tuple(list_comments(robot, verdicts)))
