"""Pictures of the robots of ``urdftool lint --format html``, with their findings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..console import Console

if TYPE_CHECKING:
    from ..finding import Finding
    from ..lint.options import Options
    from ..lint.outcome import Outcome

MOST = 4
"""Robots that are drawn in one report. Chosen, no source: a drawing takes seconds."""

_SIZE = (1280, 960)  # pixels


def draw_robots(console: Console, options: Options, outcome: Outcome) -> dict[str, bytes | str]:
    """Draw the first robots with findings.

    Returns:
        PNG file by path of the description, or the reason why there is none.
    """
    pictures: dict[str, bytes | str] = {}
    for report in outcome.reports:
        files = {report.path, *report.files}
        found = [finding for finding in outcome.findings if finding.location.path in files]
        if not report.checked or not found or report.path == "-":
            continue
        if len(pictures) < MOST:
            pictures[report.path] = _draw(console, options, report.path, found)
        else:
            pictures[report.path] = f"only the first {MOST} robots with findings are drawn"
    return pictures


def _draw(console: Console, options: Options, path: str, findings: list[Finding]) -> bytes | str:
    """Return the PNG file of one robot, or why it cannot be drawn."""
    from ..drawing.png_file import encode_png
    from ..drawing.shapes import read_robot_shapes
    from ..errors import UrdftoolError
    from ..extras import require
    from ..model.kinematics import compute_link_poses
    from ..viewer.findings_picture import draw_findings
    from .load_tolerant import load_tolerant

    quiet = Console(config=console.config, verbosity=-1)
    named = {name: Path(folder) for name, folder in options.packages.items()}
    paths = [str(folder) for folder in options.package_paths]
    try:
        require("a picture of the findings", "PIL")
        robot = load_tolerant(quiet, path, options.arguments, named, paths, many=True)
        shapes = read_robot_shapes(robot, pixels=max(_SIZE))
    except UrdftoolError as error:
        return error.message
    if not len(shapes):
        return "the robot has no visual geometry that can be read"
    poses = compute_link_poses(robot)
    return encode_png(draw_findings(robot, shapes, poses, findings, size=_SIZE))
