"""What one can choose about an export to SDF."""

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
"""The versions of SDF that each target reads, oldest first."""

DEFAULT_VERSION = {"gz": "1.11", "gazebo-classic": "1.7"}

RELEASES = {
    "1.6": "Gazebo Classic 9",
    "1.7": "Gazebo Classic 11",
    "1.9": "Gazebo Fortress",
    "1.10": "Gazebo Garden",
    "1.11": "Gazebo Harmonic",
    "1.12": "Gazebo Ionic and Jetty",
}
"""What reads each version, the oldest that does."""

MODEL = "model.sdf"


def folder_and_file(output: str | Path) -> tuple[str, str]:
    """The name of the folder an output goes to, and that of the file where it is one file."""
    path = Path(os.path.abspath(output))
    single = format_named("sdf").has_suffix(path)
    return (path.parent if single else path).name, path.name if single else ""


@dataclass(frozen=True)
class Options:
    """The choices.

    Attributes:
        target: ``gz`` or ``gazebo-classic``.
        version: The version of SDF; the target's default if empty.
        fixed_joints: ``keep`` or ``lump``; the target's default if empty.
        uri: How meshes are named: ``relative``, ``model``, ``package`` or ``file``; the usual of
            the target if empty.
        world: Whether a world is written around the robot.
        force: Whether to go on past defects of the source.
        folder: The name of the folder it goes to, which is the model's in ``model://`` URIs.
        file: The name of the file, where it is one file; empty for a folder.
        mesh_dir: Where meshes go, relative to the output.
        fix_inertia: What becomes of a tensor that no rigid body has.
        actuator_config: A TOML file with damping, friction and force range of joints.
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
        """Whether it is for Gazebo Classic."""
        return self.target == "gazebo-classic"

    @property
    def sdf_version(self) -> str:
        """The version that is written."""
        return self.version or DEFAULT_VERSION[self.target]

    @property
    def lump(self) -> bool:
        """Whether what fixed joints join becomes one link."""
        return (self.fixed_joints or ("lump" if self.classic else "keep")) == "lump"

    @property
    def uri_style(self) -> str:
        """How meshes are named; Classic finds relative paths only beside a world file."""
        if self.uri:
            return self.uri
        if not self.classic:
            return "relative"
        return "file" if self.file else "model"

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Return the files that are read beside the robot."""
        return () if self.actuator_config is None else (self.actuator_config,)

    def since(self, version: str) -> bool:
        """Whether the version written is this one or newer."""
        return _parts(self.sdf_version) >= _parts(version)


def _parts(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))
