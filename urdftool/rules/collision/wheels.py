"""Wheels, and shapes that are too thin."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ...model.bounds import size_of
from ...model.elements import Box, Joint, Robot, Vector
from ...model.millimeters import shapes_in_millimeters
from ...model.pose import norm
from ..fix import (
    FixContext,
    Proposal,
    element_at,
    insert_after,
    is_computed,
    set_attribute,
    unsafe,
    written_value,
)
from ..rule import INFO, UNSAFE, WARNING, Problem, rule
from ..shape_changes import set_in_origin
from .axle import PLACE, VISUAL, Wheel, agreeing, angle_between, is_upright, wheel_of_joint

APPLIES_TO = ("collision",)

if TYPE_CHECKING:
    from .casters import Caster


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": (
            "collide with the cylinder as written, across the axle: the wheel turns over its edge"
        ),
    },
)
def wheel_cylinder_axis(robot: Robot, *, steepest: float = 45.0) -> Iterator[Problem]:
    """The cylinder of a wheel does not lie along the axis of its joint.

    A cylinder of URDF stands along z. A wheel that turns about y needs its collision turned over,
    by ``rpy="1.5708 0 0"``; without it the wheel rolls on its flat side. Or the cylinder is right,
    and the ``<axis>`` of the joint is not. The place of the twin on the other side of the robot
    decides which one is odd, as the axle goes from one to the other; else the one that points up
    is, as the axle of a wheel lies level; else the visual and the inertia decide. ``steepest``
    [degrees] is the angle between the two that is allowed. A ``revolute`` joint without limits
    counts as ``continuous``; one that steers is left out.
    """
    for joint in robot.joints:
        wheel = wheel_of_joint(robot, joint)
        if wheel is None:
            continue
        axis, cylinder = wheel.axis.along, wheel.cylinder.along
        angle = angle_between(axis, cylinder)
        if angle <= steepest:
            continue
        right, why = _which_is_right(robot, wheel, 90 - steepest)
        disc = f"the cylinder of wheel '{wheel.link.name}'"
        line = f"the axis of '{joint.name}'" + (", x by default," if joint.axis is None else "")
        data: dict[str, Any] = {"angle": angle, "odd": ""}
        if right == "cylinder":
            what = f"{line} is at {angle:.0f}° to {disc}, which {why}; "
            data |= {"odd": "axis", "write": axis_text(cylinder)}
            what += f'write <axis xyz="{data["write"]}"/>'
        elif right == "axis":
            same = any(one.what == VISUAL for one in agreeing(wheel.others, cylinder, 45))
            also = ", and that of its visual," if same else ""
            what = f"{disc} is at {angle:.0f}° to {line}, which {why}; turn its <origin>{also} "
            what += "until z lies along the axis"
            data |= {"odd": "cylinder"}
        else:
            what = f"{disc} is at {angle:.0f}° to {line}; turn one of the two"
        in_joint = right == "cylinder"
        yield Problem(
            joint if in_joint else wheel.link,
            what,
            at=(joint.axis or joint) if in_joint else (wheel.kind.origin or wheel.shape),
            data=data,
        )


def _which_is_right(robot: Robot, wheel: Wheel, within: float) -> tuple[str, str]:
    """Decide between the axis of a wheel's joint and its cylinder.

    The place of its twin decides, as the two stand on one axle; without one, that the axle lies
    level; without that, what the visual and the inertia say.

    Returns:
        ``axis``, ``cylinder`` or nothing, and what speaks for it, as a clause.
    """
    lines = {"axis": wheel.axis.along, "cylinder": wheel.cylinder.along}
    found = {
        name: [one.what for one in agreeing(wheel.others, along, within)]
        for name, along in lines.items()
    }
    placed = [name for name in lines if PLACE in found[name]]
    level = [name for name, along in lines.items() if not is_upright(robot, wheel.joint, along)]
    voted = [name for name in lines if len(found[name]) * 2 > len(wheel.others)]
    for choice in (placed, level, voted):
        if len(choice) == 1:
            reasons = found[choice[0]]
            why = f"agrees with {_listed(reasons)}" if reasons else ""
            return choice[0], why or "lies level, as axles do"
    return "", ""


def axis_text(along: Vector) -> str:
    """Write a line as an axis: its largest part is positive, and 1 near a coordinate axis."""
    largest = max(along, key=abs)
    sign = -1.0 if largest < 0 else 1.0
    if abs(largest) > 0.999:
        return " ".join("1" if part == largest else "0" for part in along)
    return " ".join(f"{sign * part + 0.0:.6g}" for part in along)


def _listed(reasons: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(reasons[:-1]), *reasons[-1:])))


@wheel_cylinder_axis.fix(UNSAFE)
def align_cylinder_and_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the axis along the cylinder, or turn the cylinder along the axis: the odd one."""
    if isinstance(problem.subject, Joint):
        return _write_axis(problem.subject, problem.data["write"])
    link = context.link(problem)
    joint = context.robot.tree.parent_joint(link.name)
    if joint is None or joint.is_fixed or len(link.collisions) != 1:
        return None
    if problem.data["odd"] != "cylinder":
        return None
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    largest = max(range(3), key=lambda i: abs(axis[i]))
    if abs(axis[largest]) < 0.999 * norm(axis):
        return None
    rpy = ("0 1.5707963267948966 0", "1.5707963267948966 0 0", "0 0 0")[largest]
    collision = link.collisions[0]
    if collision.origin is not None and collision.origin.quaternion is not None:
        return None
    return unsafe(f'write rpy="{rpy}"', set_in_origin(collision, "rpy", rpy))


def _write_axis(joint: Joint, text: str) -> Proposal | None:
    """Write an ``<axis>``, behind the ``<child>`` where there is none."""
    if joint.axis is not None:
        change = set_attribute(joint.axis.element, "xyz", text)
    else:
        before = joint.child_element or joint.parent_element
        if before is None:
            return None
        change = insert_after(before, f'<axis xyz="{text}"/>')
    return unsafe(f'write <axis xyz="{text}"/>', change)


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

    if any(any(shapes_in_millimeters(link)) for link in robot.links):
        return
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
    data: dict[str, Any] = {"above": caster.above}
    right = ""
    if caster.height is not None:
        data["write"] = _length(caster.height)
        right = f"; write z = {data['write']} for its {what}"
    return Problem(
        caster.link,
        f"caster '{caster.link.name}' ends {abs(caster.above) * 1000:.3g} mm {where} the lowest "
        f"point of the driven wheels, so {comes_of_it}{right}",
        at=caster.moved.origin or caster.moved,
        data=data,
    )


def _length(value: float) -> str:
    return f"{round(value, 5) + 0.0:g}"


@caster_height_mismatch.fix(UNSAFE)
def write_caster_height(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the height at which the caster ends where the wheels do."""
    origin = element_at(problem)
    height = problem.data.get("write")
    if height is None or origin is None or origin.tag != "origin":
        return None
    words = written_value(origin, "xyz").split()
    if len(words) != 3 or is_computed(origin, "xyz"):
        return None
    x, y, _ = words
    return unsafe(f"write z = {height}", set_attribute(origin, "xyz", f"{x} {y} {height}"))


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
                data={"thickness": min(size), "limit": thinnest},
            )
