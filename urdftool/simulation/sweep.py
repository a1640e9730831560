"""What became of a joint that was moved through its limits."""

from __future__ import annotations

from dataclasses import dataclass, field


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
