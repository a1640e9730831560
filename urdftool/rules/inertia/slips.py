"""Slips of the pen that make a tensor impossible: what was meant can be told."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...model.elements import Inertial, Link, Robot, Vector
from ...model.tensor3 import Six
from ..rule import ERROR, WARNING, Problem, rule
from .solids import solid_moments
from .tensors import SIX, is_possible, tensors

_DIAGONAL = (0, 3, 5)


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (Error 18)",
        "mujoco": "rejects the file",
    },
)
def inertia_component_slip(robot: Robot) -> Iterator[Problem]:
    """The six numbers of an inertia are in the wrong order.

    URDF goes row by row: ixx ixy ixz iyy iyz izz. Elsewhere the three moments come first, or the
    matrix is written with all nine. Pasted as they are, no rigid body has them; in the right order
    they are fine.
    """
    for link, inertial, six in tensors(robot):
        meant = reordered(six)
        if meant is not None:
            shown = " ".join(f'{n}="{v:g}"' for n, v in zip(SIX, meant, strict=True))
            yield Problem(
                link,
                f"the numbers of the inertia of link '{link.name}' are in the wrong order; "
                f"write {shown}",
                at=inertial.inertia,
            )


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (Error 18)",
        "mujoco": "rejects the file",
    },
)
def inertia_off_by_power_of_ten(robot: Robot) -> Iterator[Problem]:
    """One moment of an inertia is off by a power of ten.

    As written no rigid body has the three; with the decimal point of just one of them moved, and in
    one way only, a body of the link's size does.
    """
    for link, inertial, six in tensors(robot):
        if reordered(six) is not None:
            continue
        slip = shifted(link, six)
        if slip is not None and inertial.inertia is not None:
            name, value = slip
            yield Problem(
                link,
                f"{name} of link '{link.name}' is off by a power of ten, so no rigid body has this "
                f"inertia; write {value:g}",
                at=inertial.inertia.element.attribute_place(name),
            )


def slip_of(link: Link, inertial: Inertial, six: Six) -> bool:
    """Whether one of these slips explains an impossible tensor."""
    return reordered(six) is not None or shifted(link, six) is not None


def reordered(six: Six) -> Six | None:
    """The numbers in the order that was meant; None where that is not clear."""
    xx, xy, xz, yy, yz, zz = six
    if is_possible(six, 0.01) or min(xx, xy, xz) <= 0:
        return None
    moments_first = (xx, yy, yz, xy, zz, xz)
    return moments_first if is_possible(moments_first) else None


def shifted(link: Link, six: Six) -> tuple[str, float] | None:
    """The one moment to move the decimal point of, and what it is then; None where unclear.

    Where the link has one solid shape, what comes out has to be its moment within a quarter, and
    the other two within a factor of two.
    """
    if is_possible(six, 0.01) or min(six[i] for i in _DIAGONAL) <= 0:
        return None
    found = []
    solid = solid_moments(link)
    for place, i in enumerate(_DIAGONAL):
        for power in (-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6):
            value = float(f"{six[i]:.17g}") * 10.0**power
            changed = [*six]
            changed[i] = value
            if not is_possible((*changed,)):  # type: ignore[arg-type]
                continue
            if solid is not None and not _is_near(changed, solid, place):
                continue
            found.append((SIX[i], float(f"{value:.12g}")))
    return found[0] if len(found) == 1 else None


def _is_near(six: Sequence[float], solid: Vector, place: int) -> bool:
    if 0.0 in solid:
        return False
    ratios = [six[i] / moment for i, moment in zip(_DIAGONAL, solid, strict=True)]
    return all(0.5 <= ratio <= 2 for ratio in ratios) and 0.8 <= ratios[place] <= 1.25


@rule(
    WARNING,
    effects={"every reader": "passes over them and takes ixy, ixz, iyz"},
)
def redundant_inertia_attributes(robot: Robot) -> Iterator[Problem]:
    """An ``<inertia>`` has ``iyx``, ``izx`` or ``izy``.

    The tensor is symmetric and readers take the upper half. Where the lower half says something
    else, another matrix was meant.
    """
    for link in robot.links:
        if link.inertial is None or link.inertial.inertia is None:
            continue
        element = link.inertial.inertia.element
        if len(element.attributes) <= len(SIX):
            continue
        for name, twin in (("iyx", "ixy"), ("izx", "ixz"), ("izy", "iyz")):
            if name not in element.attributes:
                continue
            same = element.attributes[name] == element.attributes.get(twin)
            remedy = "take it out" if same else f"it differs from {twin}, which is read; write one"
            yield Problem(
                link,
                f"{name} in the inertia of link '{link.name}' is not read; {remedy}",
                at=element.attribute_place(name),
            )
