"""Options of an export to URDF."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..common.option import FORCE, MESH_FOLDER, check_options, declare

HARDWARE = "mock_components/GenericSystem"
"""Plugin of ros2_control without hardware, whose states follow the commands."""


@dataclass(frozen=True)
class Options:
    """Options of an export to URDF.

    Attributes:
        file: Name of the output file; empty for a folder.
        srdf: Whether to write an SRDF file next to the URDF if the robot has content for it.
    """

    frames: bool = declare(
        True, "Sites and frames: keep as links without mass, or none.", kind=bool
    )
    force: bool = declare(False, FORCE)
    file: str = ""
    mesh_dir: str = declare("meshes", MESH_FOLDER)
    hardware: str = declare(
        HARDWARE,
        "Hardware plugin in <ros2_control>, which holds the actuators; none drops them.",
        metavar="PLUGIN",
    )
    root: str = declare(
        "",
        "Root link of the tree to write, of a model with several.  [default: the tree with "
        "most joints]",
        metavar="LINK",
    )
    srdf: bool = True

    def __post_init__(self) -> None:
        """Raise ConfigError if a value is not allowed."""
        check_options(self)

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return ()
