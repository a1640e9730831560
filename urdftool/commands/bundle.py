"""``urdftool bundle``: a robot with all its files in one folder or zip file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import FiniteRange, add_gltf_option, add_package_options, add_robot_argument
from .read_other import read_any

if TYPE_CHECKING:
    from ..bundle.defect import Defect
    from ..bundle.make import Bundle, BundleOptions
    from ..finding import Finding
    from ..model.elements import Robot

PRESET_NAMES = ("mujoco", "pybullet", "drake", "isaac", "genesis", "web", "foxglove")

_LONG = 5.0
"""Time [s] of a check from which it is printed. Chosen, no source."""

_GROUPS = {
    "Output": "output formats srdf preset uri package_name meshes overwrite as_json",
    "Size": "max_triangles max_error max_texture",
    "Verification": "check force",
}


@click.command("bundle", cls=GroupedCommand, groups=_GROUPS)
@add_robot_argument
@click.option("-o", "--output", metavar="OUT", help="Output folder, or .zip file.")
@click.option(
    "--format",
    "formats",
    multiple=True,
    type=click.Choice(("urdf", "sdf", "mjcf", "json")),
    metavar="FORMAT",
    help="Add the robot as sdf or mjcf to the URDF; json prints the report as JSON. Repeatable.",
)
@click.option("--srdf", type=Path, metavar="FILE", help="Add a MoveIt SRDF; xacro is expanded.")
@click.option(
    "--uri",
    type=click.Choice(("relative", "package", "file")),
    metavar="FORM",
    help="Form of mesh URIs: relative to the URDF, package:// (OUT is a ROS 2 package), file://."
    "  [default: relative, or that of --for]",
)
@click.option(
    "--package-name",
    metavar="NAME",
    help="Name of the ROS package with --uri package.  [default: ROBOT_description]",
)
@click.option(
    "--for",
    "preset",
    type=click.Choice(PRESET_NAMES),
    metavar="READER",
    help="Options for one reader; meshes that it cannot read are converted: "
    f"{', '.join(PRESET_NAMES)}.",
)
@click.option(
    "--meshes",
    type=click.Choice(("keep", "stl", "obj", "dae", "glb")),
    default="keep",
    show_default=True,
    metavar="FORMAT",
    help="Format of all meshes: keep, stl (without colors), obj, dae, glb.",
)
@click.option(
    "--max-triangles",
    type=click.IntRange(min=4),
    metavar="N",
    help="Maximum number of triangles of a visual mesh. Sharp edges and texture seams are kept.",
)
@click.option(
    "--max-error",
    type=FiniteRange(min=0, min_open=True, max=1),
    metavar="E",
    help="Maximum distance between a visual mesh and its reduction, as a fraction of the diagonal "
    "of the mesh's bounding box.  [default: 0.05 with --max-triangles]",
)
@click.option(
    "--max-texture",
    type=click.IntRange(min=1),
    metavar="N",
    help="Maximum width and height of images [pixels].",
)
@click.option("--overwrite", is_flag=True, help="Overwrite files not written by urdftool.")
@click.option(
    "--check", is_flag=True, help="Verify the bundle IN, or the new bundle: all files are in it."
)
@click.option(
    "--force", is_flag=True, help="Leave out visuals and collisions whose mesh file is missing."
)
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON, as --format json.")
@add_gltf_option
@add_package_options
@click.pass_obj
def command(
    console: Console,
    /,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    check: bool,
    package: dict[str, Path],
    package_path: tuple[str, ...],
    overwrite: bool,
    formats: tuple[str, ...],
    srdf: Path | None,
    as_json: bool,
    **choices: Any,
) -> int:
    """Write the robot IN with all meshes, textures and licenses into one folder or zip file.

    The result requires no ROS, environment variable or option. File names are portable, equal files
    are stored once, and bundle.json lists each file with its digest and source.

    \b
        urdftool bundle arm.urdf.xacro prefix:=left_ -o arm/
        urdftool bundle arm.urdf -o arm.zip
        urdftool bundle arm.zip --check
    """  # noqa: D301 -- click reads the escape
    from ..bundle.check import is_bundle
    from ..bundle.make import make_bundle
    from ..bundle.output import write_bundle
    from ..lint.validate import require as require_purpose
    from ..refusal import Refused
    from .export_report import report_refused, restore_output
    from .progress import Progress

    as_json = as_json or "json" in formats
    formats = tuple(name for name in formats if name != "json")
    if output is None:
        if check and (is_bundle(robot[0]) or os.path.isdir(robot[0])):
            return _finish(console, robot[0], None, check=True, as_json=as_json)
        raise click.UsageError("missing option -o OUT: a folder or a .zip file")
    options = _make_options(output, choices)
    model = require_purpose(read_any(console, robot, package, package_path), "links")
    with TemporaryDirectory(prefix="urdftool-") as folder:
        try:
            original, model, losses = _convert(model, Path(os.path.realpath(folder)), options.force)
            with Progress(console, "files") as progress:
                bundle = make_bundle(model, options, original, progress)
            bundle.notes[:0] = losses
            if formats or srdf is not None:
                from ..bundle.add_formats import add_formats, add_srdf  # imports numpy

                if srdf is not None:
                    add_srdf(bundle, model, srdf)
                force = options.force
                add_formats(bundle, formats, force=force, srdf=srdf, original=original)
        except Refused as refused:
            if as_json:
                _print_json(None, {}, refused.findings, None)
            return report_refused(console, refused.findings, as_json=False)
        _report_notes(console, bundle)
        if options.limits.is_set:
            _report_sizes(console, bundle)
        restore_output(console, output)
        write_bundle(output, bundle, overwrite=overwrite)
        _report(console, bundle, output)
        return _finish(console, output, bundle, check=check, as_json=as_json, source=model)


def _convert(robot: Robot, folder: Path, force: bool) -> tuple[Robot | None, Robot, list[Finding]]:
    """Return the original if it is not URDF, the robot as URDF, and the losses between them.

    Raises:
        Refused: The robot has defects that prevent the conversion.
    """
    if robot.format == "urdf":
        return None, robot, []
    from ..bundle.from_other import convert_to_urdf

    converted = convert_to_urdf(robot, folder, force=force)
    return robot, converted.robot, converted.losses


def _make_options(output: str, choices: dict[str, Any]) -> BundleOptions:
    """Make the options of the bundle from those of the command line.

    Raises:
        UsageError: Options exclude each other.
    """
    from ..bundle.limits import Limits
    from ..bundle.make import BundleOptions
    from ..bundle.output import is_zip
    from ..extras import require

    limits = Limits(choices["max_triangles"], choices["max_error"], choices["max_texture"])
    if limits.reduces_meshes:
        require("--max-triangles and --max-error", "scipy")
    if limits.max_texture is not None:
        require("--max-texture", "PIL")
    name = choices["package_name"]
    options = BundleOptions(
        choices["uri"] or "",
        name or "",
        Path(output).absolute(),
        choices["force"],
        choices["meshes"],
        choices["preset"] or "",
        limits,
    )
    uri = options.uri_form
    if uri == "file" and is_zip(output):
        raise click.UsageError("--uri file requires a folder, since its URIs contain the path")
    if name and uri != "package":
        raise click.UsageError("--package-name requires --uri package")
    return options


def _report_notes(console: Console, bundle: Bundle) -> None:
    from ..diagnostic import Severity
    from ..formats.common.loss_report import format_lines

    shown = [f for f in bundle.notes if f.severity > Severity.INFO or console.verbosity > 0]
    for line in format_lines(shown):
        console.print_note(line)


def _report_sizes(console: Console, bundle: Bundle) -> None:
    """Print a table of the files that the limits changed, with sizes before and after."""
    from ..report.bundle import format_sizes

    for line in format_sizes(bundle.manifest.files, bundle.size_before, bundle.size_after):
        console.print_note(line)


def _report(console: Console, bundle: Bundle, output: str) -> None:
    """Print the number and size of the files."""
    from ..report.counted import format_count

    total = sum(entry["bytes"] for entry in bundle.manifest.files.values())
    count = format_count(len(bundle.files), "file")
    console.print_note(f"{output}: {bundle.description}, {count}, {total / 1e6:.1f} MB")
    large = {f.data["file"]: f.data["triangles"] for f in bundle.notes if f.code == "large-mesh"}
    if large:
        listed = ", ".join(f"{file} ({number:,})" for file, number in sorted(large.items()))
        meshes = format_count(len(large), "mesh", "meshes")
        console.print_note(f"more triangles than --max-triangles in {meshes}: {listed}")


def _finish(
    console: Console,
    output: str,
    bundle: Bundle | None,
    *,
    check: bool,
    as_json: bool,
    source: Robot | None = None,
) -> int:
    """Verify a bundle if that is asked, print its defects or the report; return the exit code."""
    start = perf_counter()
    defects = _find_defects(console, output, source) if check else []
    if as_json:
        findings, files = (bundle.notes, bundle.manifest.files) if bundle else ([], {})
        _print_json(output, files, findings, defects if check else None)
    elif check:
        _report_defects(console, output, defects, perf_counter() - start)
    return int(not all(defect.is_of_source for defect in defects))


def _print_json(
    output: str | None,
    files: Mapping[str, Mapping[str, Any]],
    findings: Sequence[Finding],
    defects: Sequence[Defect] | None,
) -> None:
    from ..report.bundle import to_json

    click.echo(to_json(output, files, findings, defects), nl=False)


def _find_defects(console: Console, path: str, source: Robot | None) -> list[Defect]:
    """Verify a bundle, and compare it with its source if that is given and yourdfpy is there."""
    from ..bundle.check import check_bundle
    from ..extras import install_command, is_installed

    if source is not None and not is_installed("yourdfpy"):
        why = f"yourdfpy is not installed: {install_command('mesh')}"
        console.print_note(f"{path}: not compared with the source; {why}")
        source = None
    return check_bundle(path, source)


def _report_defects(console: Console, path: str, defects: Sequence[Defect], seconds: float) -> None:
    """Print the defects of a bundle, and its verdict with the time if that is long."""
    from ..report.counted import format_count

    for defect in defects:
        if defect.is_of_source:
            console.print_note(f"{path}/{defect}")
        else:
            click.echo(defect)
    count = sum(not defect.is_of_source for defect in defects)
    verdict = format_count(count, "defect") if count else "complete"
    time = f" (checked in {seconds:.1f} s)" if seconds >= _LONG or console.verbosity > 0 else ""
    console.print_note(f"{path}: {verdict}{time}")
