"""Options of an export to SDF."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from ...errors import ConfigError
from ...model.settings import RESISTANCE_OF_URDF
from ..common.actuator_config import make_file_option
from ..common.option import (
    FIX_INERTIA,
    FORCE,
    MESH_FOLDER,
    FixInertia,
    Overlaps,
    check_options,
    declare,
)
from ..registry import format_named

Target = Literal["gz", "gazebo-classic"]
FixedJoints = Literal["", "keep", "lump"]
ChosenBase = Literal["", "auto", "fixed", "free"]
Uri = Literal["", "relative", "model", "package", "file"]

VERSIONS: dict[str, tuple[str, ...]] = {
    "gz": ("1.9", "1.10", "1.11", "1.12"),
    "gazebo-classic": ("1.6", "1.7"),
}
"""SDF versions that each target reads, oldest first."""

DEFAULT_VERSION = {"gz": "1.11", "gazebo-classic": "1.7"}

RELEASES = {
    "1.6": "Gazebo Classic 9",
    "1.7": "Gazebo Classic 11",
    "1.9": "Gazebo Fortress",
    "1.10": "Gazebo Garden",
    "1.11": "Gazebo Harmonic",
    "1.12": "Gazebo Ionic and Jetty",
}
"""Oldest Gazebo release that reads each version."""

MODEL = "model.sdf"


def get_folder_and_file(output: str | Path) -> tuple[str, str]:
    """Return the name of an output's folder, and of its file; no file name for a folder."""
    path = Path(os.path.abspath(output))
    single = format_named("sdf").has_suffix(path)
    return (path.parent if single else path).name, path.name if single else ""


@dataclass(frozen=True)
class Options:
    """Options of an export to SDF; an empty word is the target's default.

    Attributes:
        folder: Name of the output folder, which is the model's in ``model://`` URIs.
        file: Name of the output file; empty for a folder.
        overlaps: Finds links that overlap at the start, which is reported; None reports no start.
    """

    target: Target = declare("gz", "Target simulator.", words=get_args(Target))
    version: str = declare(
        "",
        "SDF version: 1.9 to 1.12 for gz, 1.6 or 1.7 for gazebo-classic.  [default: 1.11 for "
        "gz, 1.7 for gazebo-classic]",
        words=tuple(RELEASES),
        flag="sdf-version",
        metavar="VERSION",
    )
    fixed_joints: FixedJoints = declare(
        "",
        "Fixed joints: keep, or lump their links into one.  [default: keep for gz, lump for "
        "gazebo-classic]",
        words=get_args(FixedJoints)[1:],
        metavar="METHOD",
    )
    uri: Uri = declare(
        "",
        "Form of mesh URIs: relative, model, package or file; meshes are copied for relative "
        "and model only.",
        words=get_args(Uri)[1:],
        metavar="FORM",
    )
    base: ChosenBase = declare(
        "",
        "Base of the robot: fixed by a joint to the world, free, or auto: free for robots with "
        "legs or driven wheels, or if the file defines it so, as for export mjcf.",
        words=get_args(ChosenBase)[1:],
        offered="auto",
    )
    world: bool = declare(False, "Write a world with the model, a ground and a sun.", kind=bool)
    force: bool = declare(False, FORCE)
    folder: str = ""
    file: str = ""
    overlaps: Overlaps | None = None
    mesh_dir: str = declare("meshes", MESH_FOLDER)
    fix_inertia: FixInertia = declare("none", FIX_INERTIA)
    actuator_config: Path | None = declare(
        None,
        make_file_option(
            (*RESISTANCE_OF_URDF, "force-range"), "; the same file as for export mjcf."
        ),
    )

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            ConfigError: One is not allowed, or the target does not read the version.
        """
        check_options(self)
        if self.version and self.version not in VERSIONS[self.target]:
            known = ", ".join(VERSIONS[self.target])
            raise ConfigError(f"'{self.target}' does not read SDF {self.version}; it reads {known}")

    @property
    def classic(self) -> bool:
        """Tell whether the target is Gazebo Classic."""
        return self.target == "gazebo-classic"

    @property
    def sdf_version(self) -> str:
        """Return the exported SDF version."""
        return self.version or DEFAULT_VERSION[self.target]

    @property
    def lump(self) -> bool:
        """Tell whether links that fixed joints connect become one link."""
        return (self.fixed_joints or ("lump" if self.classic else "keep")) == "lump"

    @property
    def uri_style(self) -> str:
        """Return the style of mesh URIs; Classic resolves relative paths only for world files."""
        if self.uri:
            return self.uri
        if not self.classic:
            return "relative"
        return "file" if self.file else "model"

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read in addition to the robot."""
        return () if self.actuator_config is None else (self.actuator_config,)

    def is_at_least(self, version: str) -> bool:
        """Tell whether the exported version is this one or newer."""
        return _parse_version(self.sdf_version) >= _parse_version(version)


def _parse_version(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))
