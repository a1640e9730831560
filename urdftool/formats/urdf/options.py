"""Options of an export to URDF."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

HARDWARE = "mock_components/GenericSystem"
"""Plugin of ros2_control without hardware, whose states follow the commands."""


@dataclass(frozen=True)
class Options:
    """Options of an export to URDF.

    Attributes:
        frames: Whether sites and frames become links without mass.
        force: Whether to continue in spite of defects of the source.
        file: Name of the output file; empty for a folder.
        mesh_dir: Folder of the meshes, relative to the output.
        hardware: Plugin of the hardware in ``<ros2_control>``; empty to write no such block.
        srdf: Whether to write an SRDF file next to the URDF if the robot has content for it.
    """

    frames: bool = True
    force: bool = False
    file: str = ""
    mesh_dir: str = "meshes"
    hardware: str = HARDWARE
    srdf: bool = True

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return ()
