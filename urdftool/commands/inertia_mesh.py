"""``urdftool inertia mesh``: compute the mass properties of a mesh file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .inertia_options import add_amount_options, add_result_options, check_amount, check_pose
from .options import add_gltf_option, get_gltf_up, parse_scale

if TYPE_CHECKING:
    from ..inertia.bodies import MeshBody


class _Scaled(GroupedCommand):
    """Command whose ``--scale`` takes one factor or three."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments after joining the numbers that follow ``--scale`` into one."""
        words: list[str] = []
        rest = list(args)
        while rest:
            words.append(rest.pop(0))
            if words[-1] == "--scale":
                factors: list[str] = []
                while rest and len(factors) < 3 and _is_number(rest[0]):
                    factors.append(rest.pop(0))
                words += [" ".join(factors)] if factors else []
        return super().parse_args(ctx, words)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


_GROUPS = {
    "Input": "mass density scale surface origin_xyz origin_rpy",
    "Output": "style output",
}


@click.command("mesh", cls=_Scaled, groups=_GROUPS)
@click.argument("file", metavar="FILE")
@add_amount_options
@click.option(
    "--scale",
    default="1",
    callback=parse_scale,
    metavar="S | SX SY SZ",
    help="Scale factors, as in <mesh scale>; negative factors mirror.",
)
@click.option(
    "--surface", is_flag=True, help="Treat the mesh as a thin shell; --density is in kg/m²."
)
@add_result_options
@add_gltf_option
@click.pass_obj
def command(
    console: Console,
    file: str,
    mass: float | None,
    density: float | None,
    scale: tuple[float, float, float],
    surface: bool,
    origin_xyz: tuple[float, float, float],
    origin_rpy: tuple[float, float, float],
    style: str,
    output: str | None,
) -> int:
    """Compute the mass properties of the mesh FILE: STL, OBJ, DAE, PLY, glTF or GLB.

    A closed mesh is integrated exactly. An open mesh is repaired or estimated; the method, its
    error and its reliability are reported.

    \b
        urdftool inertia mesh link3.stl --mass 1.2 --scale 0.001
        urdftool inertia mesh link3.dae --density 2700 --format json
    """  # noqa: D301 -- \b is a character that click looks for
    check_amount(mass, density)
    check_pose(origin_xyz, origin_rpy)
    if mass is None and density is None:
        raise click.UsageError("missing option: --mass M [kg] or --density D [kg/m³]")
    from ..inertia.bodies import integrate_mesh_body, scale_to_mass
    from ..inertia.rounding import round_properties
    from ..model.pose import Pose, rotation_from_rpy
    from ..output import write_result

    up = get_gltf_up(console, file)
    body = integrate_mesh_body(Path(file), surface=surface, gltf_up=up).scale(scale)
    alone = scale_to_mass(body.unit, "mesh", mass=mass, density=density)
    pose = Pose(rotation_from_rpy(origin_rpy), origin_xyz)
    result = round_properties(alone.transform(pose), "the mesh")
    text = _format_text(style, file, result, body, alone.mass / body.measure, scale)
    write_result(text, output, inputs=[file])
    _report(console, file, body, result, style)
    return 0


def _format_text(
    style: str, file: str, result: Any, body: MeshBody, density: float, scale: tuple[float, ...]
) -> str:
    from ..report import inertia as report

    if style == "json":
        facts = {
            "mesh": file,
            "scale": list(scale),
            **body.as_dict(),
            "density": density,
        }
        return report.as_json(result, facts)
    if style == "table":
        unit = "m²" if body.surface else "m³"
        rows = {
            "area" if body.surface else "volume": f"{body.measure:.6g} {unit}",
            "density": f"{density:.6g} kg/{unit}",
            "method": _format_method(body),
        }
        return report.format_table(file, result, rows)
    if style == "xacro":
        from ..inertia.macros import get_mass_macro

        name = "".join(c if c.isalnum() and c.isascii() else "_" for c in Path(file).stem)
        return get_mass_macro(name if name[:1].isalpha() else f"mesh_{name}", result)
    text: str = {"urdf": report.format_urdf, "sdf": report.format_sdf, "mjcf": report.format_mjcf}[
        style
    ](result)
    return text


def _format_method(body: MeshBody) -> str:
    if body.method == "exact":
        return "exact"
    if body.surface:
        return "surface"
    sure = "" if body.reliable else ", not reliable"
    error = f", error about {body.error:.1%}" if body.error < 1 else ""
    hull = f", hull {body.hull_measure:.4g} m³" if body.hull_measure else ""
    return f"{body.method}{error}{hull}{sure}"


def _report(console: Console, file: str, body: MeshBody, result: Any, style: str) -> None:
    from ..report.inertia import format_summary

    if style != "table":
        console.print_note(format_summary(file, result))
        console.print_note(f"  method: {_format_method(body)}")
    for note in body.note_texts:
        console.print_note(f"  {note}")
    if not body.reliable:
        console.print_message(
            f"{file}: the mass properties are an estimate that is not reliable; close the mesh, or "
            "compute them from another geometry"
        )
