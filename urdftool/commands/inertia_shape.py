"""``urdftool inertia SHAPE``: compute the mass properties of a shape."""

from __future__ import annotations

from typing import Any

import click

from ..console import Console
from ..inertia.shapes import THICKNESS, Shape, Size
from .grouped_help import GroupedCommand
from .inertia_options import add_amount_options, add_result_options, check_amount, check_pose

_INPUT = "mass density size radius length radii thickness closed origin_xyz origin_rpy"
_GROUPS = {"Input": _INPUT, "Output": "style output"}


def make_shape_command(shape: Shape) -> click.Command:
    """Make the command of a shape."""

    @click.pass_obj
    def callback(console: Console, /, **given: Any) -> int:
        return _run(console, shape, given)

    callback.__doc__ = _format_help(shape)
    function: Any = add_result_options(callback)
    if shape.ends:
        function = click.option(
            "--closed", is_flag=True, help="Hollow: add end plates, as thick as the wall."
        )(function)
    if shape.hollow:
        function = _make_size_option(THICKNESS, "Hollow: thickness ")(function)
    for size in reversed(shape.sizes):
        function = _make_size_option(size, f"{size.name.capitalize()} ")(function)
    made = click.command(shape.name, cls=GroupedCommand, groups=_GROUPS)
    command: click.Command = made(add_amount_options(function))
    return command


def _format_help(shape: Shape) -> str:
    article = "an" if shape.name.startswith("e") else "a"
    return (
        f"Compute the mass properties of {article} {shape.name} ({shape.what}).\n\n"
        "Numbers have six significant digits, and more where a thin plate needs them. At a "
        "terminal, missing values are asked for."
    )


def _make_size_option(size: Size, label: str) -> Any:
    return click.option(
        f"--{size.name}",
        type=float,
        nargs=size.numbers,
        default=None,
        metavar=size.metavar,
        help=label + size.what + ".",
    )


def _run(console: Console, shape: Shape, given: dict[str, Any]) -> int:
    mass, density = given["mass"], given["density"]
    thickness, closed = given.get("thickness"), bool(given.get("closed"))
    check_amount(mass, density)
    check_pose(given["origin_xyz"], given["origin_rpy"])
    if closed and thickness is None:
        raise click.UsageError("--closed requires --thickness; a solid body has no end plates")
    mass = _get_mass(shape, mass, density)
    sizes = {size.name: _get_size(shape, size, given[size.name]) for size in shape.sizes}

    from ..inertia.rounding import round_properties
    from ..inertia.shapes import compute_shape_properties
    from ..model.pose import Pose, rotation_from_rpy
    from ..output import write_result

    def properties(**amount: float | None) -> Any:
        return compute_shape_properties(shape, sizes, thickness=thickness, closed=closed, **amount)

    alone = properties(mass=mass, density=density)
    what = shape.name if thickness is None else f"hollow {shape.name}"
    pose = Pose(rotation_from_rpy(given["origin_rpy"]), given["origin_xyz"])
    result = round_properties(alone.transform(pose), f"the {what}")
    facts: dict[str, Any] = {"shape": shape.name, **sizes}
    if thickness is not None:
        facts |= {"thickness": thickness} | ({"closed": closed} if shape.ends else {})
    volume = properties(density=1.0).mass
    facts |= {"volume": volume, "density": alone.mass / volume}
    facts |= {"origin": {"xyz": given["origin_xyz"], "rpy": given["origin_rpy"]}}
    text = _format_text(given["style"], what, result, facts)
    if text is None:
        from ..inertia.macros import get_shape_call, get_shape_macro

        place = {"xyz": given["origin_xyz"], "rpy": given["origin_rpy"]}
        text = get_shape_macro(shape, hollow=thickness is not None)
        text += get_shape_call(
            shape, sizes, alone.mass, thickness=thickness, closed=closed, **place
        )
    write_result(text, given["output"])
    if given["style"] != "table":
        from ..report.inertia import format_summary

        console.print_note(format_summary(what, result))
    return 0


def _format_text(style: str, what: str, result: Any, facts: dict[str, Any]) -> str | None:
    """Format the result; None for xacro."""
    from ..report import inertia as report

    if style == "json":
        return report.as_json(result, facts)
    if style == "table":
        volume, density = facts["volume"], facts["density"]
        shown = {"volume": f"{volume:.6g} m³", "density": f"{density:.6g} kg/m³"}
        return report.format_table(what, result, shown)
    if style == "xacro":
        return None
    text: str = {"urdf": report.format_urdf, "sdf": report.format_sdf, "mjcf": report.format_mjcf}[
        style
    ](result)
    return text


def _get_mass(shape: Shape, mass: float | None, density: float | None) -> float | None:
    from .inertia_ask import ask_mass, is_at_terminal

    if mass is not None or density is not None:
        return mass
    if is_at_terminal():
        return ask_mass()
    raise click.UsageError(f"{shape.title} requires --mass M [kg] or --density D [kg/m³]")


def _get_size(shape: Shape, size: Size, value: Any) -> Any:
    from .inertia_ask import ask_size, is_at_terminal

    if value is not None:
        return value
    if is_at_terminal():
        return ask_size(size)
    raise click.UsageError(f"{shape.title} requires --{size.name} {size.metavar}: {size.what}")
