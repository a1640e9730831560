"""``urdftool collision mesh``: simplify one mesh file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from ..output import check_targets
from .collision_options import (
    add_settings_options,
    check_sphere_options,
    limit_threads,
    make_settings,
    open_cache,
    require_libraries,
)
from .grouped_help import GroupedCommand
from .options import add_gltf_option, get_gltf_up, parse_scale
from .picture_file import check_picture_name

if TYPE_CHECKING:
    from ..collision.compute import Result

SUFFIXES = (".stl", ".obj")
_GROUPS = {
    "Input": "scale",
    "Geometry": "method quality max_error max_hulls max_vertices max_triangles threshold "
    "count cover",
    "Output": "output style overwrite picture",
    "Performance": "time_limit",
}


@click.command("mesh", cls=GroupedCommand, groups=_GROUPS)
@click.argument("file", metavar="IN")
@click.option(
    "-o", "--output", metavar="OUT", help="Mesh file to write, .stl or .obj.  [default: none]"
)
@click.option(
    "--scale",
    default="1",
    callback=parse_scale,
    metavar="S | 'SX SY SZ'",
    help="Scale factors, as in <mesh scale>; negative factors mirror.",
)
@add_settings_options
@add_gltf_option
@click.pass_obj
def command(
    console: Console,
    /,
    file: str,
    output: str | None,
    scale: tuple[float, float, float],
    **values: Any,
) -> int:
    """Simplify the mesh IN: STL, OBJ, DAE, PLY, glTF or GLB.

    OUT contains all convex pieces. If there are several, each piece is also written to a numbered
    file next to OUT, because most physics engines use the convex hull of a whole file.

    \b
        urdftool collision mesh gripper.stl -o gripper_col.obj --method coacd --max-hulls 16
        urdftool collision mesh wheel.dae --method primitive
    """  # noqa: D301 -- \b is a character that click looks for
    check_picture_name(values["picture"])
    check_targets([output, values["picture"]], inputs=[file])
    if output is not None and not output.lower().endswith(SUFFIXES):
        raise click.UsageError(f"OUT must end in .stl or .obj, but is '{output}'")
    check_sphere_options(values)
    require_libraries(values["method"])
    limit_threads()
    from ..collision.cache import compute_key, read_cached_result
    from ..collision.compute import Task, parse_result, try_compute
    from ..errors import UrdftoolError
    from ..parallel import count_cores
    from ..report import collision as report

    task = Task(Path(file), scale, make_settings(values), get_gltf_up(console, file))
    cache = open_cache(values)
    key = compute_key(task)
    result = read_cached_result(cache, key) if key is not None else None
    if result is None:
        outcome = try_compute(task, count_cores())
        if isinstance(outcome, UrdftoolError):
            raise outcome
        result = parse_result(outcome)
        if key is not None and result.lasting:
            cache.put(key, outcome)
    files = _write(file, result, output, values["overwrite"])
    settings = task.settings
    row = report.Row(
        Path(file).name, file, scale, result, settings.max_error, files, requested=settings.method
    )
    mesh_report = report.Report(file, output or "", [row])
    style = values["style"]
    if style == "json":
        text = report.as_json([mesh_report], timings=console.verbosity > 0)
    else:
        text = report.format_table([row])
    click.echo(text, nl=False)
    if values["picture"]:
        _draw(task, result, values["picture"], file)
    if style == "table":
        for piece in result.pieces:
            if piece.is_primitive:
                click.echo(_format_primitive(piece))
    for line in report.format_remarks([row]):
        console.print_message(line)
    for line in report.format_failures([row]):
        console.print_message(line)
    for line in report.format_notes([row]):
        console.print_note(line, level=1)
    if len(files) > 1 and files[0] != files[1]:
        console.print_note(
            f"{output} contains all pieces; {files[0]} … {Path(files[-1]).name} one piece each"
        )
    if cache.trouble:
        console.print_note(f"the result was not stored in the cache: {cache.trouble}")
    return 0


def _format_primitive(piece: Any) -> str:
    from ..collision.rewrite import format_geometry_tag
    from ..model.pose import rpy_from_rotation

    xyz = " ".join(f"{value:.6g}" for value in piece.center)
    x, y, z = piece.rotation.tolist()
    rpy = " ".join(f"{value + 0.0:.6g}" for value in rpy_from_rotation((x, y, z)))
    return f'<origin xyz="{xyz}" rpy="{rpy}"/> <geometry>{format_geometry_tag(piece)}</geometry>'


def _write(file: str, result: Result, output: str | None, overwrite: bool) -> tuple[str, ...]:
    """Write the pieces, and return the names of their files in the same order."""
    if output is None:
        return ()
    from ..collision.mesh_files import encode_mesh, write_all

    suffix = Path(output).suffix.lower()
    target = Path(output)
    files: dict[Path, bytes] = {}
    names = [output]
    if len(result.pieces) > 1:
        names = []
        for index, piece in enumerate(result.pieces):
            path = target.with_name(f"{target.stem}_{index}{target.suffix}")
            files[path] = encode_mesh([piece], suffix)
            names.append(str(path))
    files[target] = encode_mesh(result.pieces, suffix)
    write_all(files, overwrite=overwrite, inputs=[file])
    return tuple(names)


def _draw(task: Any, result: Result, picture: str, file: str | Path) -> None:
    from ..collision.picture import draw_mesh
    from ..output import write_file

    write_file(picture, draw_mesh(task, result), inputs=[file])
