"""Robots in formats other than URDF, as URDF that can be bundled."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from ..finding import Finding
from ..formats.registry import format_named
from ..formats.urdf.options import Options
from ..model.elements import Robot
from ..model.load import make_robot
from ..source.description import read_description
from ..source.location import SourceFile
from .description import rewrite

FOLDER = "meshes"


@dataclass(frozen=True)
class Converted:
    """A robot as URDF."""

    robot: Robot
    losses: list[Finding]


def convert_to_urdf(robot: Robot, folder: Path, *, force: bool = False) -> Converted:
    """Convert a robot to URDF whose meshes are the files of the source.

    ``folder`` is empty, and must exist as long as the robot is used.

    Raises:
        Refused: The robot has defects that prevent the conversion.
    """
    written = format_named("urdf").write(robot, Options(force=force, mesh_dir=FOLDER))
    uris = {}
    for name, content in written.files.items():
        path = folder / name
        if isinstance(content, bytes):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        else:
            path = Path(os.path.abspath(content))
        uris[name] = f"file://{path.as_posix()}"  # readers of URDF do not decode %20
    main = folder / written.main
    file = SourceFile(str(main), main.read_bytes())
    file = SourceFile(str(main), rewrite(file, uris, set()))
    gltf_up = "y" if robot.source is None else robot.source.gltf_up
    made = read_description(main, file=file, gltf_up=gltf_up)
    if robot.source is not None:  # its meshes are files that the source may read
        made.packages.access.include(robot.source.packages.access)
    return Converted(make_robot(made), written.losses)
