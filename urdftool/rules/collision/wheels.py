"""Wheels, and shapes that are too thin."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...model.bounds import size_of
from ...model.elements import Box, Cylinder, Joint, Robot
from ...model.pose import dot, norm, pose_of, rotate
from ..rule import INFO, WARNING, Problem, rule

if TYPE_CHECKING:
    from .casters import Caster

_WHEEL = re.compile(r"wheel|tire|caster", re.IGNORECASE)


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": (
            "collide with the cylinder as written, across the axle: the wheel turns over its edge"
        ),
    },
)
def wheel_cylinder_axis(robot: Robot, *, steepest: float = 45.0) -> Iterator[Problem]:
    """The cylinder of a wheel does not lie along its axle.

    A cylinder of URDF stands along z. A wheel that turns about y needs its collision turned over,
    by ``rpy="1.5708 0 0"``; without it the wheel rolls on its flat side. ``steepest`` [degrees] is
    the angle between the two that is let pass.
    """
    from math import acos, degrees

    for joint in robot.joints:
        link = robot.link.get(joint.child)
        if joint.type != "continuous" or link is None or len(link.collisions) != 1:
            continue
        collision = link.collisions[0]
        shape = collision.geometry
        if not isinstance(shape, Cylinder) or not _WHEEL.search(link.name + joint.name):
            continue
        axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
        if norm(axis) < 1e-6 or shape.length > 4 * shape.radius:
            continue
        along = rotate(pose_of(collision.origin).rotation, (0.0, 0.0, 1.0))
        angle = degrees(acos(min(1.0, abs(dot(along, axis)) / norm(axis))))
        if angle > steepest:
            yield Problem(
                link,
                f"the cylinder of wheel '{link.name}' stands at {angle:.0f}° to the axis of "
                f"'{joint.name}'; turn its <origin> so that z lies along the axis",
                at=collision.origin or shape,
            )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco": (
            "collide with the caster as written: the wheels spin in the air, or the robot leans"
        ),
    },
)
def caster_height_mismatch(
    robot: Robot, *, deepest: float = 0.001, steepest: float = 3.0
) -> Iterator[Problem]:
    """A caster ends lower or higher than the wheels that are driven.

    With casters before and behind the axle that reach lower than the wheels, these hang in the air,
    and the robot does not move. With casters on one side alone it lies tilted, and all that its
    sensors see with it. Where a robot stands is worked out at zero of all joints, with the two
    wheels of a drive, or the only two there are; casters are told by their names, and spheres that
    are lower than all but the wheels are taken for such. Wheels and casters on springs are left
    out. Let pass are ``deepest`` [m] of air below the wheels, and ``steepest`` [degrees] of tilt.
    """
    if sum(joint.type == "continuous" for joint in robot.joints) < 2 or robot.tree.root is None:
        return
    from math import degrees

    from .casters import axle_of, casters_of

    axle = axle_of(robot)
    found = list(casters_of(robot, axle)) if axle is not None else []
    found = [caster for caster in found if abs(caster.ahead) > 0.005]
    ends = [[c for c in found if c.ahead > 0], [c for c in found if c.ahead < 0]]
    firsts = [min(end, key=lambda c: c.tilt) for end in ends if end]
    if len(firsts) == 2:
        one, other = firsts
        apart = abs(one.ahead) + abs(other.ahead)
        air = -(one.above * abs(other.ahead) + other.above * abs(one.ahead)) / apart
        if air > deepest:
            low = min(firsts, key=lambda c: c.above)
            yield _caster_problem(low, f"the wheels hang {air * 1000:.3g} mm in the air")
            return
    lying = min(firsts, key=lambda c: abs(c.tilt), default=None)
    if lying is not None and degrees(abs(lying.tilt)) > steepest:
        tilt = degrees(abs(lying.tilt))
        yield _caster_problem(lying, f"the robot lies tilted by {tilt:.1f}°")


def _caster_problem(caster: Caster, comes_of_it: str) -> Problem:
    where = "below" if caster.above < 0 else "above"
    what = "joint" if isinstance(caster.moved, Joint) else "collision"
    right = "" if caster.height is None else f"; write z = {_length(caster.height)} for its {what}"
    return Problem(
        caster.link,
        f"caster '{caster.link.name}' ends {abs(caster.above) * 1000:.3g} mm {where} the lowest "
        f"point of the driven wheels, so {comes_of_it}{right}",
        at=caster.moved.origin or caster.moved,
    )


def _length(value: float) -> str:
    return f"{round(value, 5) + 0.0:g}"


@rule(
    INFO,
    default=False,
    effects={
        "gz, gazebo-classic, mujoco": (
            "collide with the shape as written: fast things can pass through it in one step"
        ),
    },
)
def paper_thin_collision(robot: Robot, *, thinnest: float = 0.001) -> Iterator[Problem]:
    """A collision is thinner than things move in a step.

    At a step of a millisecond what moves at 1 m/s goes 1 mm; a thinner wall may be on the other
    side before a contact is seen. ``thinnest`` [m] is let pass.
    """
    for link in robot.links:
        for collision in link.collisions:
            size = size_of(collision.geometry)
            if size is None or min(size) <= 0 or min(size) >= thinnest:
                continue
            what = "box" if isinstance(collision.geometry, Box) else "collision"
            yield Problem(
                link,
                f"a {what} of link '{link.name}' is {min(size) * 1000:.3g} mm thin; "
                f"make it {thinnest * 1000:g} mm or more",
                at=collision.geometry,
            )
