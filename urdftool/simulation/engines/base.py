"""The interface of a physics engine: capabilities, model files, and a world that is stepped."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from ..capabilities import Capabilities as Capabilities

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...model.elements import Robot
    from ..recording import Array, Contact, ReadBack
    from ..rigid_bodies import RigidBodyModel
    from ..settings import Settings

UNLIMITED_EFFORT = 1e6
"""Effort limit of a motor whose joint has none in the file [N·m, N]."""

Sample = dict[str, Any]
"""One value for each column of a recording, by name."""


class ModelFiles(Protocol):
    """An export of a robot, in memory."""

    @property
    def main(self) -> str:
        """Return the path of the model."""

    @property
    def files(self) -> Mapping[str, bytes | Path]:
        """Return the content of each file."""


class ExportMjcf(Protocol):
    """A function that exports a robot as MJCF."""

    def __call__(self, robot: Robot, fixed: bool) -> ModelFiles:
        """Export a robot."""


class World(Protocol):
    """A robot above a plane in an engine.

    Attributes:
        version: Version of the engine.
        bodies: Rigid bodies of the robot.
        settings: Settings of the simulation.
        read_back: Values that the engine loaded differently than the file has them.
        capped: Viscous resistance of joints for which it is less than in the file, because that is
            unstable at the time step [N·m·s/rad, N·s/m].
    """

    version: str
    bodies: RigidBodyModel
    settings: Settings
    read_back: list[ReadBack]
    capped: dict[str, float]

    def set_gravity(self, gravity: tuple[float, float, float], poses: Array) -> None:
        """Set gravity [m/s²] until the next sample; ``poses`` are those of the last sample."""

    def step(self) -> None:
        """Advance by one timestep."""

    def sample(self, time: float) -> Sample:
        """Measure one value for each column of the recording at a time [s]."""

    def has_diverged(self) -> bool:
        """Tell whether the engine reports that the simulation diverged: a value is not finite."""

    def list_contacts(self) -> list[Contact]:
        """List the contacts with the plane."""

    def find_overlaps(self, *, ground: bool = True) -> list[Contact]:
        """Find the interpenetration of each pair of bodies, whether or not contacts are enabled."""

    def set_joint_position(self, joint: int, value: float) -> None:
        """Set the position of a joint [rad, m], and of those that mimic it, without a step."""

    def clear_ground(self) -> None:
        """Move the robot away from the plane, if that affects :meth:`find_overlaps`."""


class Engine(ABC):
    """A physics engine; creating one imports no library."""

    capabilities: ClassVar[Capabilities]

    @abstractmethod
    def has_wheel(self) -> bool:
        """Tell whether the library has a wheel for this Python and machine."""

    @abstractmethod
    def write_model(
        self,
        robot: Robot,
        bodies: RigidBodyModel,
        settings: Settings,
        folder: Path,
        export_mjcf: ExportMjcf,
    ) -> None:
        """Write the files that :meth:`open_world` reads.

        Args:
            robot: The robot.
            bodies: Its rigid bodies.
            settings: Settings of the simulation.
            folder: Empty folder.
            export_mjcf: Exports a robot as MJCF, for an engine that reads it.

        Raises:
            UrdftoolError: The robot cannot be written in a format of the engine.
        """

    @abstractmethod
    def open_world(self, bodies: RigidBodyModel, settings: Settings, folder: Path) -> World:
        """Load the robot in this process.

        Args:
            bodies: Rigid bodies of the robot.
            settings: Settings of the simulation.
            folder: Folder with the files of :meth:`write_model`.

        Raises:
            MissingDependency: The library is not installed.
            ModelError: The engine cannot load the robot.
        """
