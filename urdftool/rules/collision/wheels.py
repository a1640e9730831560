"""Wheels, and shapes that are too thin."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.bounds import size_of
from ...model.elements import Box, Cylinder, Robot
from ...model.pose import dot, norm, pose_of, rotate
from ..rule import INFO, WARNING, Problem, rule

_WHEEL = re.compile(r"wheel|tire|caster", re.IGNORECASE)


@rule(WARNING, effects={"every simulator": "the wheel tumbles over its edge"})
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


@rule(INFO, default=False, effects={"every simulator": "fast things pass through it in one step"})
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
