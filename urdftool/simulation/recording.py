"""Measurements of a run, in one form for all engines; checks read nothing else of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .capabilities import Capabilities

Array = npt.NDArray[np.float64]

GROUND = ""
"""The name of the plane, as one side of a contact."""


@dataclass(frozen=True)
class Contact:
    """A contact or interpenetration of two bodies.

    Attributes:
        one: Name of a link of the robot.
        other: Name of the other link, or ``GROUND``.
        depth: Penetration depth [m]; negative is a gap.
        force: Normal force [N].
        point: Contact point in the world [m].
        normal: Unit vector away from ``other``, in the world.
    """

    one: str
    other: str
    depth: float
    force: float
    point: tuple[float, float, float]
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class ReadBack:
    """A value that the engine loaded differently from the file."""

    kind: str
    name: str
    what: str
    specified: str
    loaded: str


@dataclass(eq=False)
class Recording:
    """Recording of a run: n samples of b bodies and j joints; the first sample is the start.

    Attributes:
        engine: Title and version of the engine.
        capabilities: Differences of the engine from other engines.
        bodies: Topmost link of each rigid body, the root first.
        joints: Joints between ``bodies[1:]`` and their parents, in that order.
        times: Shape (n,) [s].
        poses: Shape (n, b, 7): position [m] and quaternion x, y, z, w of each body's link frame.
        velocities: Shape (n, b, 6): of the center of mass [m/s], and angular [rad/s], in the world.
        positions: Shape (n, j) [rad, m].
        rates: Shape (n, j) [rad/s, m/s].
        efforts: Shape (n, j): effort of the motor of each joint [N·m, N].
        kinetic: Shape (n,) [J].
        potential: Shape (n,) [J], zero at the start.
        depths: Shape (n,): depth of the deepest contact with the plane at each sample [m].
        held: Names of the joints that are held.
        targets: Target positions of the held joints [rad, m].
        start_contacts: Overlaps before the first step, also of links that share a joint.
        contacts: Contacts and overlaps of the last sample.
        carrying: Contacts with the plane that carried a load in the last half second, of all its
            samples: an engine may omit a contact in single samples.
        carried: Mean of the total force of these contacts [N]; nan without samples.
        read_back: Values that the engine loaded differently from the file.
        capped: That of the engine's ``World``.
        still_since: Time since which nothing moved [s]; None if the robot moved to the end.
        ended: ``still``, ``time``, or ``lost`` (a value was not finite, or the robot far away).
        seconds: Processor time of the steps [s].
        steps: Number of steps.
    """

    engine: str
    capabilities: Capabilities
    bodies: tuple[str, ...]
    joints: tuple[str, ...]
    times: Array
    poses: Array
    velocities: Array
    positions: Array
    rates: Array
    efforts: Array
    kinetic: Array
    potential: Array
    depths: Array
    held: tuple[str, ...] = ()
    targets: dict[str, float] = field(default_factory=dict)
    start_contacts: list[Contact] = field(default_factory=list)
    contacts: list[Contact] = field(default_factory=list)
    carrying: list[Contact] = field(default_factory=list)
    carried: float = math.nan
    read_back: list[ReadBack] = field(default_factory=list)
    capped: dict[str, float] = field(default_factory=dict)
    still_since: float | None = None
    ended: str = "time"
    seconds: float = 0.0
    steps: int = 0


@dataclass(frozen=True)
class Hit:
    """Interpenetration of two links while a joint moves.

    Attributes:
        one: Name of a link.
        other: Name of the other link.
        first: Lowest joint position at which they overlap [rad, m].
        last: Highest joint position at which they overlap [rad, m].
        depth: Maximum penetration depth [m], of the convex hulls that the engine uses.
    """

    one: str
    other: str
    first: float
    last: float
    depth: float


@dataclass(frozen=True)
class Swept:
    """Result of moving a joint through its limits.

    Attributes:
        joint: Name of the joint.
        lower: Lower limit, or minus half a turn without limits [rad, m].
        upper: Upper limit, or half a turn without limits [rad, m].
        free_lower: Lower end of the collision-free range around the start [rad, m].
        free_upper: Upper end of the collision-free range [rad, m].
        hits: Pairs of links that interpenetrate.
    """

    joint: str
    lower: float
    upper: float
    free_lower: float
    free_upper: float
    hits: list[Hit] = field(default_factory=list)
