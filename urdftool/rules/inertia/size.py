"""Inertia against the size of the link."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.elements import Collision, Link, Mesh, Robot, Visual
from ...model.tensor3 import Six
from ..mesh.outlines import reaches
from ..rule import INFO, WARNING, Problem, rule
from .density import outlier
from .frame import about_com
from .proposals import remedy_text
from .solids import centre_of_solids, solid_moments, solid_text, spread_ratio
from .tensors import is_positive, is_zero, moments_of, six_of, tensors

_SIZE_IN_DOUBT = ("mesh-in-millimetres", "mesh-scaled-twice", "mesh-scale-out-of-line")
_CENTER = ("com-outside-geometry", "inertial-not-at-com-suspect")


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": (
            "take it as written: the link swings like a flywheel"
        ),
    },
    group="robot",
    of_motion=True,
)
def placeholder_inertia(robot: Robot) -> Iterator[Problem]:
    """An inertia is the same power of ten about every axis, such as 1 or 1e-3.

    Nobody measured that. 1 kg·m² on a link of 100 g puts its mass 3 m from its centre: the arm
    turns like a flywheel and its motors look too weak.
    """
    for link, inertial, six in tensors(robot):
        if not _is_placeholder(link, six):
            continue
        moment = six[0]
        radius = math.sqrt(moment / inertial.mass) if inertial.mass and inertial.mass > 0 else 0.0
        large = moment == 1.0 or radius > 1.0
        far = f", as if its {link.mass:g} kg were {radius:.2g} m from the centre" if large else ""
        yield Problem(
            link,
            f"inertia of link '{link.name}' is a placeholder, {moment:g} about every axis{far}"
            f"{solid_text(link)}",
            at=inertial.inertia,
            severity=WARNING if large else INFO,
            hint="'urdftool inertia' computes it",
            group="inertia of {count} links is a placeholder, the same power of ten about every "
            "axis: {names}",
        )


def _is_placeholder(link: Link, six: Six) -> bool:
    """Whether a tensor is a power of ten times the identity, and not by chance the right one."""
    xx, xy, xz, yy, yz, zz = six
    if not xx == yy == zz > 0 or xy or xz or yz:
        return False
    power = math.log10(xx)
    if abs(power - round(power)) > 1e-9:
        return False
    solid = solid_moments(link)
    return solid is None or not all(0.5 <= moment / xx <= 2 for moment in solid)


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": "take it as written",
    },
    of_motion=True,
    group="robot",
)
def inertia_exceeds_geometry(
    robot: Robot, *, allowed: float = 1.1, rounding: float = 0.01, certain: float = 10.0
) -> Iterator[Problem]:
    """An inertia is larger than any body of the link's size can have.

    Mass is most spread out along an axis when it sits in two lumps at the ends of the shape, and
    even that gives less. Square millimetres for square metres, grams for kilograms, a mass a tenth
    of what it should be, or the moment of one axis written for all three do it. Of a mesh the box
    around it counts; up to ``certain`` times too large is then no more than a remark, as the mesh
    may leave out what is heavy.
    """
    reach = reaches(robot)
    for link, inertial, six in tensors(robot):
        if link.mass <= 0 or _is_placeholder(link, six) or not is_positive(moments_of(six)):
            continue
        low, middle, high = moments_of(six)
        if low + middle < high * 0.99:
            continue
        ratio, axis = spread_ratio(reach.link(link), inertial, rounding)
        if ratio <= allowed or about_com(link, inertial, six, reach.link(link)) is not None:
            continue
        remark = ratio <= certain and _has_mesh(link)
        fits, _ = spread_ratio(reach.link(link), inertial, rounding, centered=True)
        yield Problem(
            link,
            f"inertia of link '{link.name}' spreads its mass along {'xyz'[axis]} more than its "
            f"shapes allow, by a factor of {ratio:.2g}{remedy_text(link, inertial, six)}",
            at=inertial.inertia,
            severity=INFO if remark else None,
            caused_by=(*_SIZE_IN_DOUBT, "singular-inertia", *(_CENTER if fits <= allowed else ())),
        )


def _has_mesh(link: Link) -> bool:
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    return any(isinstance(shape.geometry, Mesh) for shape in shapes)


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": (
            "take it as written: the same force turns the link faster"
        ),
    },
    of_motion=True,
    caused_by=_SIZE_IN_DOUBT,
)
def inertia_below_geometry(robot: Robot, *, least: float = 0.12) -> Iterator[Problem]:
    """An inertia is far smaller than that of a body of the link's size.

    A solid box has the moments that its mass and size give; steel in its middle and plastic around
    it halve them. An eighth means that the mass is ten times too large, that the inertia lost a
    power of ten, or that the shape is larger than the body. ``least`` is the part of the solid
    box's that is let pass.
    """
    reach = reaches(robot)
    heavy = outlier(robot)
    for link, inertial, six in tensors(robot):
        mass = link.mass
        if mass <= 0 or is_zero(six, mass) or not is_positive(moments_of(six)):
            continue
        if heavy is not None and link is heavy.link:
            continue  # the mass is reported
        box = reach.link(link)
        if box is None:
            continue
        if _is_placeholder(link, six):
            continue
        solid = mass / 12 * sum(length * length for length in box.size)
        written = sum(six[i] for i in (0, 3, 5)) / 2
        if written < least * solid:
            x, y, z = (f"{length:.3g}" for length in box.size)
            yield Problem(
                link,
                f"inertia of link '{link.name}' is {written / solid:.2g} of that of a solid box "
                f"of its {mass:g} kg and size, {x} × {y} × {z} m; is the mass or the inertia off "
                "by a power of ten?",
                at=inertial.inertia,
            )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": "take it as written",
    },
    of_motion=True,
    group="robot",
    caused_by=_SIZE_IN_DOUBT,
)
def com_outside_geometry(
    robot: Robot, *, margin: float = 0.02, together: float = 6
) -> Iterator[Problem]:
    """A link's centre of mass is outside the box around its shapes.

    The mean of a body's mass is inside its hull. Millimetres, or the pose of another frame, put it
    elsewhere; the link then falls to a side it should not. ``margin`` is the part of the box's
    diagonal that is let pass, of a mesh twice that. A mesh often shows the cover and not the motor
    that weighs most, so there it is a warning only beyond half a diagonal; more than ``together``
    that are none are one finding, which names the links.
    """
    remarks: list[tuple[Problem, str]] = []
    reach = reaches(robot)
    for link in robot.links:
        inertial = link.inertial
        if inertial is None or not inertial.mass:
            continue
        box = reach.link(link)
        if box is None:
            continue
        lower, upper = box
        diagonal, has_mesh = math.dist(lower, upper), _has_mesh(link)
        slack = margin * diagonal * (2 if has_mesh else 1)
        com = inertial.origin.xyz if inertial.origin is not None else (0.0, 0.0, 0.0)
        off = [
            (max(lower[i] - com[i], com[i] - upper[i]), i)
            for i in range(3)
            if not lower[i] - slack <= com[i] <= upper[i] + slack
        ]
        if off:
            distance, axis = max(off)
            less = has_mesh and distance < diagonal / 2
            problem = Problem(
                link,
                f"centre of mass of link '{link.name}' is {distance:.3g} m outside its shapes "
                f"along {'xyz'[axis]}; they reach from {lower[axis]:.4g} to {upper[axis]:.4g} m",
                at=inertial.origin if inertial.origin is not None else inertial,
                severity=INFO if less else None,
            )
            if less:
                remarks.append((problem, f"'{link.name}' by {distance:.3g} m along {'xyz'[axis]}"))
            else:
                yield problem
    if len(remarks) > together:
        remarks[0][0].message += f"; so are those of {', '.join(said for _, said in remarks[1:])}"
        del remarks[1:]
    yield from (problem for problem, _ in remarks)


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": (
            "put the center of mass at the link's origin, on the joint"
        ),
    },
    of_motion=True,
    group="robot",
)
def inertial_not_at_com_suspect(robot: Robot, *, far: float = 0.2) -> Iterator[Problem]:
    """An ``<inertial>`` has no origin though the link's shapes lie to one side.

    The mass then sits at the frame of the link, that is on the axis of its joint, and gravity turns
    nothing. Mostly the ``<origin>`` was forgotten.
    """
    reach = reaches(robot)
    for link in robot.links:
        inertial = link.inertial
        if inertial is None or not inertial.mass:
            continue
        if inertial.origin is not None and any(inertial.origin.xyz):
            continue
        if inertial.inertia is not None and _is_placeholder(link, six_of(inertial.inertia)):
            continue  # all of it is made up, which is said
        box = reach.link(link)
        if box is None:
            continue
        lower, upper = box
        slack = 0.02 * math.dist(lower, upper)
        if max(lower) - slack > 0 or min(upper) + slack < 0:
            continue  # the centre of mass is outside, which is more than a suspicion
        centre = box.centre
        solid = centre_of_solids(link)
        if solid is not None and math.hypot(*solid) <= far * math.dist(lower, upper):
            continue  # what lies to one side is thin
        if math.hypot(*centre) > far * math.dist(lower, upper):
            shown = " ".join(f"{value:.4g}" for value in centre)
            yield Problem(
                link,
                f"mass of link '{link.name}' is at its frame, while its shapes are centred at "
                f"{shown}; write that as the <origin> of its <inertial>",
                at=inertial.origin if inertial.origin is not None else inertial,
            )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pinocchio, drake": "take it as written",
    },
    of_motion=True,
)
def radius_of_gyration(
    robot: Robot, *, largest: float = 1.0, smallest: float = 1e-3, heavy: float = 0.01
) -> Iterator[Problem]:
    """A link's inertia does not go with its mass.

    The root of the one over the other is how far from its centre the mass sits on average. A metre
    is more than most robots are long, a millimetre is a pinhead. Square millimetres for square
    metres are the usual cause. Links whose size is known are left to ``inertia-exceeds-geometry``.
    """
    reach = reaches(robot)
    for link, inertial, six in tensors(robot):
        mass = link.mass
        if mass <= 0 or is_zero(six, mass) or _is_placeholder(link, six):
            continue
        if inertial.mass is None or reach.link(link) is not None:
            continue
        high = moments_of(six)[2]
        if high <= 0:
            continue
        radius = math.sqrt(high / mass)
        if radius > largest:
            remedy = "; if it is in kg·mm², divide it by 1e6" if radius > 10 else ""
        elif radius < smallest and mass > heavy:
            remedy = "; are the units kg·m²?"
        else:
            continue
        yield Problem(
            link,
            f"inertia of link '{link.name}' puts its {mass:g} kg {radius:.2g} m from its centre"
            f"{remedy}",
            at=inertial.inertia,
        )
