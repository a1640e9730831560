"""The interface of a physics engine: capabilities, model files, and a world that is stepped."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

if TYPE_CHECKING:
    from pathlib import Path

    from ...model.elements import Robot
    from ..recording import Array, Contact, ReadBack
    from ..rigid_bodies import RigidBodyModel
    from ..settings import Settings

UNLIMITED_EFFORT = 1e6
"""The effort of a motor whose joint has no effort limit in the file [N·m, N]."""

Sample = dict[str, Any]
"""One value for each column of a recording, by name."""


@dataclass(frozen=True)
class Capabilities:
    """What an engine can do, and what it does differently from others.

    Attributes:
        name: The value of ``--engine``.
        title: The name in messages.
        library: The Python package to import; ``extras.EXTRA_OF`` has the extra that installs it.
        wheels: Where that package has wheels.
        closes_loops: Whether joints that close a kinematic loop are simulated.
        max_joints: The most moving joints of a robot; None without a limit.
        lumps_fixed_joints: Whether links on fixed joints are one body of its model file.
        hull_per_object: Whether each object of a mesh file collides as a hull of its own; otherwise
            the file is one hull.
        uses_contact_stiffness: Whether ``<kp>`` and ``<kd>`` of the file apply.
        creeps: Whether contacts may let a robot at rest creep.
        holds_massless_root: Whether a root without mass stays where it starts.
    """

    name: str
    title: str
    library: str
    wheels: str
    closes_loops: bool
    max_joints: int | None
    lumps_fixed_joints: bool
    hull_per_object: bool
    uses_contact_stiffness: bool
    creeps: bool
    holds_massless_root: bool


class World(Protocol):
    """A robot above a plane in an engine.

    Attributes:
        version: Version of the engine.
        bodies: The robot.
        settings: How it is spawned.
        read_back: Values that the engine loaded differently than the file has them.
        capped: Damping of the joints whose damping the timestep does not allow
            [N·m·s/rad, N·s/m].
    """

    version: str
    bodies: RigidBodyModel
    settings: Settings
    read_back: list[ReadBack]
    capped: dict[str, float]

    def set_gravity(self, gravity: tuple[float, float, float], poses: Array) -> None:
        """Set gravity [m/s²] until the next sample; ``poses`` are those of the last one."""

    def step(self) -> None:
        """Advance by one timestep."""

    def sample(self, time: float) -> Sample:
        """Measure one value for each column of the recording at a time [s]."""

    def is_broken(self) -> bool:
        """Tell whether the engine reports that its state is not finite."""

    def list_contacts(self) -> list[Contact]:
        """List the contacts with the plane."""

    def find_overlaps(self, *, ground: bool = True) -> list[Contact]:
        """Find the deepest point of each two interpenetrating bodies, contacts enabled or not."""

    def set_joint_position(self, joint: int, value: float) -> None:
        """Move a joint [rad, m], and those that mimic it, without a step."""

    def clear_ground(self) -> None:
        """Take the robot off the plane, if the plane would appear in :meth:`overlaps`."""


class Engine(ABC):
    """A physics engine; creating one imports no library."""

    capabilities: ClassVar[Capabilities]

    @abstractmethod
    def has_wheel(self) -> bool:
        """Tell whether the library has a wheel for this Python and machine."""

    @abstractmethod
    def write_model(
        self, robot: Robot, bodies: RigidBodyModel, settings: Settings, folder: Path
    ) -> None:
        """Write the files that :meth:`open_world` reads.

        Args:
            robot: The robot.
            bodies: The same, as rigid bodies.
            settings: How it is spawned.
            folder: An empty folder.

        Raises:
            UrdftoolError: The robot has no form that the engine reads.
        """

    @abstractmethod
    def open_world(self, bodies: RigidBodyModel, settings: Settings, folder: Path) -> World:
        """Load the robot in this process.

        Args:
            bodies: The robot, which :meth:`write_model` wrote.
            settings: How it is spawned.
            folder: Where its files are.

        Raises:
            MissingDependency: The library is not installed.
            ModelError: The engine does not load the robot.
        """
