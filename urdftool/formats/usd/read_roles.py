"""Which attributes of physics a robot holds, and which say the same for different simulators."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from pxr import Usd

from ...model.drives import GAINS
from ...model.kinematics import MOVABLE
from ...model.settings import RESISTANCE, Setting
from .read_joints import JointKind, Units, find_units, has_drive
from .read_links import find_contradicting_inertia
from .read_stage import ROUNDING, Context

_PHYSICAL = re.compile(r"(physics|physx\w*|newton|mjc|drive|limit|state|omniphysics|isaac):.+")


def is_physical(name: str) -> bool:
    """Tell whether an attribute or relation is one of physics or of a simulator."""
    return _PHYSICAL.fullmatch(name) is not None


@dataclass(frozen=True)
class Repeated:
    """Attributes with which a stage says one value, each for another simulator.

    Attributes:
        factors: Factor of each attribute to one unit, by name.
    """

    factors: dict[str, float]

    def find_agreeing(self, prim: Usd.Prim) -> Iterable[str]:
        """Return the attributes that say what the first one says; all, if none is written."""
        values = {name: _get_number(prim, name) for name in self.factors}
        if all(value is None for value in values.values()):
            return self.factors
        scaled = {n: v * self.factors[n] for n, v in values.items() if v is not None}
        first = next(iter(scaled.values()))
        return [n for n, value in scaled.items() if math.isclose(value, first, rel_tol=ROUNDING)]


@dataclass(frozen=True)
class Roles:
    """What the robot holds of the attributes of a prim.

    Attributes:
        held: Names of the attributes of which it has the value.
        groups: Attributes that say one value.
        find_agreeing: Returns further names of attributes that agree with what is held.
    """

    held: re.Pattern[str] = re.compile("(?!)")
    groups: tuple[Repeated, ...] = ()
    find_agreeing: Callable[[Context, Usd.Prim], Iterable[str]] = lambda *_: ()

    def list_agreeing(self, context: Context, prim: Usd.Prim) -> frozenset[str]:
        """Return the names of attributes that say again what the robot holds."""
        agreeing = (name for group in self.groups for name in group.find_agreeing(prim))
        return frozenset((*agreeing, *self.find_agreeing(context, prim)))


def _get_number(prim: Usd.Prim, name: str) -> float | None:
    attribute = prim.GetAttribute(name)
    value = attribute.Get() if attribute and attribute.HasAuthoredValue() else None
    return float(value) if isinstance(value, (int, float)) else None


_INERTIA = ("newton:inertia", "physics:diagonalInertia", "physics:principalAxes")


def _find_agreeing_inertia(context: Context, prim: Usd.Prim) -> Iterable[str]:
    """Return the attributes of inertia that are written, unless they contradict each other."""
    written = [name for name in _INERTIA if prim.GetAttribute(name).HasAuthoredValue()]
    if not written:
        return _INERTIA
    return () if find_contradicting_inertia(context, prim) else written


BODY = Roles(
    re.compile(r"physics:(mass|centerOfMass|rigidBodyEnabled)"),
    find_agreeing=_find_agreeing_inertia,
)
"""Attributes of a rigid body."""

COLLIDER = Roles(re.compile(r"physics:collisionEnabled"))
"""Attributes of a collider."""

MATERIAL = Roles(re.compile(r"physics:(dynamicFriction|restitution)"))
"""Attributes of a physics material."""

_JOINT = (
    r"physics:(axis|(lower|upper)Limit|local(Pos|Rot)[01]|jointEnabled|excludeFromArticulation)"
    r"|newton:mimic(Coef[01]|Enabled)|physxMimicJoint:\w+:(gearing|offset)|mjc:coef[01]"
)


def list_joint_roles(context: Context, prim: Usd.Prim, kind: JointKind) -> Roles:
    """Return the roles of the attributes of a joint.

    Args:
        context: State of reading.
        prim: The joint.
        kind: How it is read; what is held of a joint with several freedoms is its frame.
    """
    if kind.type not in MOVABLE:
        return Roles(re.compile(_JOINT))
    units = find_units(context, kind)
    held = f"{_JOINT}|limit:{kind.freedom or '-'}:physics:(low|high)"
    return Roles(re.compile(held), _list_groups(units, is_driven=has_drive(prim, units.name)))


def _list_groups(units: Units, *, is_driven: bool) -> tuple[Repeated, ...]:
    """Return the attributes of a joint that say its effort, velocity, friction and so on."""
    drive = f"drive:{units.name}:physics"
    gains = [f"{drive}:{gain}" for gain in GAINS] if is_driven else []
    effort = {f"{drive}:maxForce": 1.0} if is_driven else {}
    axis, there = f"physxJointAxis:{units.name}", units.by_radian / units.rate
    velocity = ("newton:velocityLimit", f"{axis}:maxJointVelocity", "physxJoint:maxJointVelocity")
    ends = {"mjc:actuatorfrcrange:min": -1.0, "mjc:actuatorfrcrange:max": 1.0}
    return (
        Repeated(dict.fromkeys(velocity, 1.0)),
        *(_list_resistance(row, units.name, there) for row in RESISTANCE),
        Repeated({**effort, **ends}),
        *(Repeated({gain: 1.0}) for gain in gains),
    )


def _list_resistance(row: Setting, axis: str, rate: float) -> Repeated:
    """Return the attributes of a value of the dynamics; a rate of MuJoCo's schema is by radian."""
    names = (row.usd, *(name.replace("*", axis) for name in row.physx))
    there = rate if "/rad" in row.unit else 1.0
    return Repeated({**dict.fromkeys(names, 1.0), f"mjc:{row.mjcf_attribute}": there})
