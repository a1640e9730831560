"""``urdftool srdf``: write the SRDF of a robot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import (
    add_gltf_option,
    add_package_options,
    add_robot_argument,
    make_output_option,
)
from .srdf_groups import add_group_option, report_groups

if TYPE_CHECKING:
    from ..srdf.groups import GivenGroup


@click.command("srdf", cls=GroupedCommand, groups={"Output": "output", "Content": "given_groups"})
@add_robot_argument
@make_output_option("Output file.  [default: standard output]")
@add_group_option
@add_gltf_option
@add_package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    given_groups: tuple[GivenGroup, ...],
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Write the SRDF of the robot IN, which MoveIt reads.

    \b
        urdftool srdf arm.urdf.xacro -o arm.srdf
        urdftool srdf arm.urdf.xacro --group manipulator=base_link:flange
    """  # noqa: D301 -- click reads the escape
    from ..output import write_result
    from ..srdf.content import make_semantic
    from ..srdf.write import format_srdf
    from .load_tolerant import load_tolerant

    path, arguments = robot
    model = load_tolerant(console, path, arguments, package, package_path)
    inputs = [file.path for file in model.source.files] if model.source else []
    content = make_semantic(model, given_groups)
    report_groups(console, content)
    write_result(format_srdf(content), output, inputs=inputs)
    return 0
