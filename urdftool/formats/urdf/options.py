"""Options of an export to URDF."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Options:
    """Options of an export to URDF.

    Attributes:
        frames: Whether sites and frames become links without mass.
        force: Whether to continue in spite of defects of the source.
        file: Name of the output file; empty for a folder.
        mesh_dir: Folder of the meshes, relative to the output.
    """

    frames: bool = True
    force: bool = False
    file: str = ""
    mesh_dir: str = "meshes"

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return ()
