"""The definition of a robot that stands, for the row ``runs``, ``simulate`` and measurements.

A robot stands if its base, from the start of a simulation to its end, and as far as its motion at
the end goes on, does not lean, slide away or sink, and if nothing else comes to rest on the ground.
A robot on a fixed base stands if its joints stay. Joints that sag on a free base that stands are
named. Tests of this module are of numbers; the caller measures them in its engine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

LEAN = 10.0
"""Tilt of a base above which it leans [°]; chosen, no source."""

FALLEN = 30.0
"""Tilt of a base above which the robot has fallen [°]; chosen, no source."""

SINK = 0.1
"""Part of the height of its center of mass that a robot that stands loses, at most; chosen, no
source."""

FALLEN_DROP = 0.3
"""Drop of the center of mass, relative to this height, above which the robot has fallen; chosen, no
source."""

SLIDE = 0.5
"""Motion along the ground of a robot that stands, at most [its size]; chosen, no source."""

SAG_TURN = 0.05
"""Motion of a joint that stays, at most [rad]; chosen, no source: 50 mm at 1 m."""

SAG_SLIDE = 0.05
"""The same of a slide [size of the robot]; chosen, no source."""

DRIFT = 0.02
"""Maximum motion of a base that stays at its start [m]; chosen, no source."""

TILT = 3.0
"""Maximum tilt of a base that stays at its start [°]; chosen, no source."""

HORIZON = 5.0
"""Time for which a motion that does not slow down goes on [s]; chosen, no source."""

WINDOW = 0.5
"""Time at the end of a simulation in which a motion is observed [s]; chosen, no source."""

NUDGE = 0.1
"""Duration of the tilted gravity to each side at the start [s]. Chosen, no source."""

NUDGE_ANGLE = 0.02
"""Angle of the tilted gravity [rad], so that a robot balanced on a point falls; chosen, no source.
"""

NUDGE_TOWARD = 0.6
"""Direction of the tilt from x [rad]; not an axis of symmetry of common robots. Chosen, no source.
"""


def get_nudge_side(time: float) -> int:
    """Return to which side gravity is tilted at a time [s]: 1, -1, or 0 after that."""
    return (1 if time < NUDGE else -1) if time < 2 * NUDGE else 0


def estimate_end(values: Sequence[float]) -> float:
    """Return where a value goes from the end of a window within the horizon.

    The rate changes in each half of a window by the same factor, but does not grow. A value that
    goes to and fro stays.

    Args:
        values: At the beginning, in the middle, and at the end of the last ``WINDOW``.
    """
    first, middle, last = values
    before, after = middle - first, last - middle
    if not before * after > 0:
        return last
    ratio, halves = abs(after / before), 2 * HORIZON / WINDOW
    return last + after * (min(ratio / (1 - ratio), halves) if ratio < 1 else halves)


@dataclass(frozen=True)
class BaseMotion:
    """Motion of a free body, with all that it carries, from the start to the end.

    Attributes:
        name: The body, for messages.
        drift: Its motion [m].
        slide: Its motion along the ground [m], with what follows within the horizon.
        tilt: Its tilt [°].
        lean: The same, with what follows within the horizon.
        sink: Its drop [m].
        drop: Drop of the center of mass that it carries, relative to its height at the start above
            the lowest point.
        shrinking: Part of this height that it lost, also if it started above the ground.
        resting: What rests on the ground, and was too high at the start for a base that stays.
    """

    name: str
    drift: float = 0.0
    slide: float = 0.0
    tilt: float = 0.0
    lean: float = 0.0
    sink: float = 0.0
    drop: float = 0.0
    shrinking: float = 0.0
    resting: tuple[str, ...] = ()

    @property
    def stays(self) -> bool:
        """Tell whether the base stays where it starts."""
        return self.drift <= DRIFT and self.tilt <= TILT

    @property
    def excess(self) -> float:
        """Return how far the base moves, relative to one that stays."""
        return max(self.drift / DRIFT, self.tilt / TILT)


@dataclass(frozen=True)
class JointMotion:
    """Motion of a joint from the start to the end.

    Attributes:
        name: The joint.
        moved: Its motion [rad, m].
        is_held: Whether a servo or motor holds it.
        is_slide: Whether it is prismatic.
        is_carried: Whether a free body carries it.
    """

    name: str
    moved: float
    is_held: bool = True
    is_slide: bool = False
    is_carried: bool = False

    def describe(self) -> str:
        """Describe the motion."""
        return f"{self.moved:.2g} {'m' if self.is_slide else 'rad'}"


@dataclass(frozen=True)
class Bounds:
    """Bounds of a robot that stands; lengths [m], joints [rad, m], ``lean`` [°]."""

    slide: float = math.inf
    lean: float = LEAN
    turn: float = SAG_TURN
    length: float = SAG_SLIDE

    @classmethod
    def make_for_size(cls, size: float) -> Bounds:
        """Return the bounds for a robot of a size [m]."""
        return cls(slide=SLIDE * size, length=SAG_SLIDE * size)


@dataclass(frozen=True)
class Motion:
    """Motion of a robot, and of what else is in its scene, from the start to the end.

    Attributes:
        bases: Free bodies; empty for a robot on a fixed base.
        joints: Joints, without those that follow another one.
        is_finite: Whether every number of the simulation is finite.
        bounds: Bounds of a robot that stands.
    """

    bases: Sequence[BaseMotion] = ()
    joints: Sequence[JointMotion] = ()
    is_finite: bool = True
    bounds: Bounds = field(default_factory=Bounds)

    @property
    def stands(self) -> bool:
        """Tell whether the robot stands; on a fixed base, whether its joints stay."""
        return (
            self.is_finite
            and all(map(self._is_standing, self.bases))
            and not any(joint for joint in self.sagging if not joint.is_carried)
        )

    def _is_standing(self, base: BaseMotion) -> bool:
        return (
            base.lean <= self.bounds.lean
            and base.slide <= self.bounds.slide
            and base.shrinking <= SINK
            and not base.resting
        )

    @property
    def worst(self) -> BaseMotion | None:
        """Return the base that moves most; None without a free body."""
        return max(
            self.bases, key=lambda base: (not self._is_standing(base), base.excess), default=None
        )

    @property
    def sagging(self) -> list[JointMotion]:
        """List the joints that do not stay, that which moves most first."""
        found = [
            joint
            for joint in self.joints
            if joint.moved > (self.bounds.length if joint.is_slide else self.bounds.turn)
        ]
        return sorted(found, key=lambda joint: -joint.moved)

    @property
    def stays(self) -> bool:
        """Tell whether the robot stands where it starts, and no joint moves."""
        return self.stands and not self.sagging and all(base.stays for base in self.bases)

    def describe_base(self) -> Iterator[str]:
        """Describe the base that moves most, if it does not stand or stay."""
        base = self.worst
        if base is None or not self.is_finite or (base.stays and self._is_standing(base)):
            return
        moved = f"{base.name} moves by {base.drift:.2g} m and tilts by {base.tilt:.2g}°"
        if base.tilt > FALLEN or base.drop > FALLEN_DROP:
            yield f"falls: {moved}"
        elif base.resting:
            yield f"{moved}; '{base.resting[0]}' comes to rest on the ground"
        elif base.shrinking > SINK:
            yield f"{moved}; the center of mass sinks by {base.shrinking:.0%} of its height"
        elif base.stays:
            goes = f"{base.slide:.2g} m and {base.lean:.2g}°"
            yield f"{moved}, and would go on to {goes} in {HORIZON:g} s"
        elif base.sink > base.drift / 2:
            who = "" if base.name == THE_BASE else f"{base.name} "
            yield f"{who}sags by {base.sink:.2g} m, and tilts by {base.tilt:.2g}°"
        else:
            yield moved

    def describe_joints(self) -> Iterator[tuple[str, bool]]:
        """Describe the joint that sags most, unless its base falls; tell whether it is held."""
        if not all(map(self._is_standing, self.bases)):
            return
        for joint in self.sagging[:1]:
            what = "stands, its joints sag by up to" if joint.is_carried else "joints move by up to"
            yield f"{what} {joint.describe()}, '{joint.name}' most", joint.is_held


THE_BASE = "the base"
"""The only free body of a model that has no other body on its world, in messages."""
