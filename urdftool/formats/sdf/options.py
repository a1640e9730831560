"""Options of an export to SDF."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from ..common.inertia_repair import FixInertia
from ..registry import format_named

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
    """Options of an export to SDF.

    Attributes:
        target: ``gz`` or ``gazebo-classic``.
        version: SDF version; empty for the target's default.
        fixed_joints: ``keep`` or ``lump``; empty for the target's default.
        uri: Style of mesh URIs: ``relative``, ``model``, ``package`` or ``file``; empty for the
            target's default.
        world: Whether to write a world around the robot.
        force: Whether to continue in spite of defects of the source.
        folder: Name of the output folder, which is the model's in ``model://`` URIs.
        file: Name of the output file; empty for a folder.
        mesh_dir: Folder of the meshes, relative to the output.
        fix_inertia: Repair method for physically inconsistent tensors.
        actuator_config: TOML file with damping, friction and force range of joints.
    """

    target: str = "gz"
    version: str = ""
    fixed_joints: str = ""
    uri: str = ""
    world: bool = False
    force: bool = False
    folder: str = ""
    file: str = ""
    mesh_dir: str = "meshes"
    fix_inertia: FixInertia = "none"
    actuator_config: Path | None = None

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
        return _collect_parts(self.sdf_version) >= _collect_parts(version)


def _collect_parts(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))
