"""``urdftool.export_urdf``: conversion of SDF and MJCF to URDF."""

from __future__ import annotations

from pathlib import Path

from ..arguments import check_arguments
from ..formats.urdf.options import HARDWARE
from ..formats.written import Written
from ..model.elements import Robot


@check_arguments
def export_urdf(
    robot: Robot,
    output: str | Path | None = None,
    *,
    root: str = "",
    frames: bool = True,
    hardware: str = HARDWARE,
    srdf: bool = True,
    mesh_dir: str = "meshes",
    force: bool = False,
    verify: bool = False,
    overwrite: bool = False,
) -> Written:
    """Convert a robot in SDF or MJCF to URDF.

    Args:
        robot: A robot from ``load``.
        output: A folder, or a file that ends in .urdf; None writes nothing.
        root: Root link of the tree to write, of a model with several; empty for the one with most
            joints that move.
        frames: Whether sites, frames and optical frames of cameras become links without mass.
        hardware: Plugin of the hardware in ``<ros2_control>``, which holds the actuators; empty
            drops them.
        srdf: Whether to write an SRDF next to the URDF if the robot has excluded contacts or named
            joint positions.
        mesh_dir: Folder of the meshes, relative to the URDF.
        force: Whether to continue past errors if a robot remains.
        verify: Whether to read the result back and compare it; ``checks`` has the result.
        overwrite: Whether to replace files not written by urdftool.

    Raises:
        ConfigError: An option has a value that is not allowed.
        ModelError: The robot has errors that prevent writing it; ``notes`` lists the others.
        OutputError: A file cannot be written; previous contents are unchanged.
    """
    choices = {**locals()}  # the arguments by name
    from ..formats.common.option import make_options
    from ..formats.export import finish_export
    from ..formats.registry import format_named
    from ..formats.urdf.options import Options

    is_file = output is not None and Path(output).suffix.lower() == ".urdf"
    file = Path(output).name if output is not None and is_file else ""
    options = make_options(Options, choices, file=file, srdf=srdf)
    urdf = format_named("urdf")
    written = urdf.write(robot, options)
    written.checks = finish_export(
        urdf, robot, options, written, output, verify=verify, overwrite=overwrite
    )
    return written
