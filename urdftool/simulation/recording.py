"""What an engine measured; verdicts read nothing else of a run, whichever engine it was."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .engines.base import Capabilities

Array = npt.NDArray[np.float64]

GROUND = ""
"""The name of the plane, as one side of a contact."""


@dataclass(frozen=True)
class Contact:
    """Two bodies that touch.

    Attributes:
        one: The link of the robot.
        other: The other link, or ``GROUND``.
        depth: How deep they are in each other [m]; negative is a gap.
        force: Along the normal [N].
        point: Where, in the world [m].
        normal: Away from ``other``, in the world.
    """

    one: str
    other: str
    depth: float
    force: float
    point: tuple[float, float, float]
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class ReadBack:
    """Something that the engine took for other than the file says."""

    kind: str
    name: str
    what: str
    said: str
    got: str


@dataclass(eq=False)
class Recording:
    """One run: n samples of b bodies and j joints; the first sample is the start.

    Attributes:
        engine: Its title and version.
        capabilities: What it does differently from other engines.
        bodies: The topmost link of each rigid body, the root first.
        joints: Those between ``bodies[1:]`` and their parents, in that order.
        times: Shape (n,) [s].
        poses: Shape (n, b, 7): position [m] and quaternion x, y, z, w of each body's link frame.
        velocities: Shape (n, b, 6): of the centre of mass [m/s], and angular [rad/s], in the world.
        positions: Shape (n, j) [rad, m].
        rates: Shape (n, j) [rad/s, m/s].
        efforts: Shape (n, j): what drives each joint [N·m, N].
        kinetic: Shape (n,) [J].
        potential: Shape (n,) [J], zero where the start is.
        depths: Shape (n,): the deepest contact with the plane at each sample [m].
        held: Names of the joints that are held.
        targets: Where those are to be [rad, m].
        start_contacts: Contacts before the first step, also of links of one joint.
        contacts: Those of the last sample.
        carrying: Contacts with the plane that carried a load in the last half second, each sample's
            in turn: an engine may leave one out at any moment.
        carried: What these carried together, on average [N]; nan where nothing was sampled.
        read_back: What the engine took for other than it was given.
        capped: The damping that each joint had, where the timestep bears less than the file says
            [N·m·s/rad, N·s/m].
        still_since: From when on nothing moved [s]; None where it moved to the end.
        ended: ``still``, ``time`` or ``lost`` (a number was no number, or ran away).
        seconds: What the engine took for the steps [s].
        steps: How many there were.
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
    """Two links that run into each other while a joint moves.

    Attributes:
        one: A link.
        other: Another.
        first: The lowest position at which they overlap [rad, m].
        last: The highest.
        depth: How deep at most [m], by the hulls that the engine collides.
    """

    one: str
    other: str
    first: float
    last: float
    depth: float


@dataclass(frozen=True)
class Swept:
    """A joint.

    Attributes:
        joint: Its name.
        lower: Its lower limit, or half a turn where it has none [rad, m].
        upper: Its upper limit.
        free_lower: How far down it comes from the start before links overlap.
        free_upper: How far up.
        hits: What runs into what.
    """

    joint: str
    lower: float
    upper: float
    free_lower: float
    free_upper: float
    hits: list[Hit] = field(default_factory=list)
