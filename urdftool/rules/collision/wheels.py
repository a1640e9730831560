"""Check wheels, casters and thin shapes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ...model.bounds import compute_size
from ...model.elements import Box, Joint, Robot, Vector
from ...model.millimeters import find_shapes_in_millimeters
from ...model.pose import compute_norm
from ..fix import (
    FixContext,
    Proposal,
    find_element,
    get_written_value,
    insert_after,
    is_computed,
    set_attribute,
    unsafe,
)
from ..rule import ANY_FORMAT, INFO, UNSAFE, WARNING, Problem, rule
from ..shape_changes import set_in_origin
from .axle import (
    TWIN_POSITION,
    VISUAL,
    Wheel,
    compute_angle,
    get_wheel,
    is_upright,
    select_agreeing,
)

APPLIES_TO = ("collision",)

if TYPE_CHECKING:
    from .casters import Caster


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": (
            "use the cylinder as written, across the axle: the wheel rolls over its edge"
        ),
    },
    formats=ANY_FORMAT,
)
def wheel_cylinder_axis(robot: Robot, *, steepest: float = 45.0) -> Iterator[Problem]:
    """The cylinder of a wheel is not aligned with the axis of its joint.

    URDF cylinders point along z. The collision of a wheel that rotates about y needs
    ``rpy="1.5708 0 0"``; without it the wheel rolls on its flat side. Or the cylinder is right and
    the ``<axis>`` of the joint is wrong. The wheel on the other side of the robot decides,
    because an axle connects both; else the one that points up is wrong, because axles are
    horizontal; else visual and inertia decide. ``steepest`` [degrees] is the tolerated angle.
    A ``revolute`` joint without limits counts as ``continuous``; steering joints are skipped.
    """
    for joint in robot.joints:
        wheel = get_wheel(robot, joint)
        if wheel is None:
            continue
        axis, cylinder = wheel.axis.along, wheel.cylinder.along
        angle = compute_angle(axis, cylinder)
        if angle <= steepest:
            continue
        right, why = _choose_reference(robot, wheel, 90 - steepest)
        disc = f"the cylinder of wheel '{wheel.link.name}'"
        line = f"the axis of '{joint.name}'" + (", x by default," if joint.axis is None else "")
        data: dict[str, Any] = {"angle": angle, "odd": ""}
        if right == "cylinder":
            what = f"{line} is at {angle:.0f}° to {disc}, which {why}; "
            data |= {"odd": "axis", "write": format_axis(cylinder)}
            what += f'write <axis xyz="{data["write"]}"/>' if joint.xml is not None else "check it"
        elif right == "axis":
            same = any(one.what == VISUAL for one in select_agreeing(wheel.others, cylinder, 45))
            pose = "<origin>" if joint.xml is not None else "pose"
            also = ", and that of its visual," if same else ""
            what = f"{disc} is at {angle:.0f}° to {line}, which {why}; rotate its {pose}{also} "
            what += "so that z points along the axis"
            data |= {"odd": "cylinder"}
        else:
            what = f"{disc} is at {angle:.0f}° to {line}; rotate one of the two"
        in_joint = right == "cylinder"
        yield Problem(
            joint if in_joint else wheel.link,
            what,
            at=(joint.axis or joint) if in_joint else (wheel.kind.origin or wheel.shape),
            data=data,
        )


def _choose_reference(robot: Robot, wheel: Wheel, within: float) -> tuple[str, str]:
    """Decide between the axis of a wheel's joint and its cylinder.

    The position of its twin decides, because both are on one axle; without one, that axles are
    horizontal; otherwise the directions of visual and inertia.

    Returns:
        ``axis``, ``cylinder`` or nothing, and the reason, as a clause.
    """
    lines = {"axis": wheel.axis.along, "cylinder": wheel.cylinder.along}
    found = {
        name: [one.what for one in select_agreeing(wheel.others, along, within)]
        for name, along in lines.items()
    }
    placed = [name for name in lines if TWIN_POSITION in found[name]]
    level = [name for name, along in lines.items() if not is_upright(robot, wheel.joint, along)]
    voted = [name for name in lines if len(found[name]) * 2 > len(wheel.others)]
    for choice in (placed, level, voted):
        if len(choice) == 1:
            reasons = found[choice[0]]
            why = f"agrees with {_join_reasons(reasons)}" if reasons else ""
            return choice[0], why or "is horizontal, as axles are"
    return "", ""


def format_axis(along: Vector) -> str:
    """Write a line as an axis: its largest part is positive, and 1 near a coordinate axis."""
    largest = max(along, key=abs)
    sign = -1.0 if largest < 0 else 1.0
    if abs(largest) > 0.999:
        return " ".join("1" if part == largest else "0" for part in along)
    return " ".join(f"{sign * part + 0.0:.6g}" for part in along)


def _join_reasons(reasons: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(reasons[:-1]), *reasons[-1:])))


@wheel_cylinder_axis.fix(UNSAFE)
def align_cylinder_and_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the wrong one: the axis along the cylinder, or the cylinder along the axis."""
    if isinstance(problem.subject, Joint):
        return _write_axis(problem.subject, problem.data["write"])
    link = context.get_link(problem)
    joint = context.robot.tree.get_parent_joint(link.name)
    if joint is None or joint.is_fixed or len(link.collisions) != 1:
        return None
    if problem.data["odd"] != "cylinder":
        return None
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    largest = max(range(3), key=lambda i: abs(axis[i]))
    if abs(axis[largest]) < 0.999 * compute_norm(axis):
        return None
    rpy = ("0 1.5708 0", "1.5708 0 0", "0 0 0")[largest]
    collision = link.collisions[0]
    if collision.origin is not None and collision.origin.quaternion is not None:
        return None
    return unsafe(f'write rpy="{rpy}"', set_in_origin(collision, "rpy", rpy))


def _write_axis(joint: Joint, text: str) -> Proposal | None:
    """Write an ``<axis>``, after the ``<child>`` if there is none."""
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
            "use the caster as written: the wheels spin without contact, or the robot tilts"
        ),
    },
    formats=ANY_FORMAT,
)
def caster_height_mismatch(
    robot: Robot, *, deepest: float = 0.001, steepest: float = 3.0
) -> Iterator[Problem]:
    """A caster ends lower or higher than the driven wheels.

    If casters in front of and behind the axle are lower than the wheels, the wheels do not touch
    the ground and the robot does not move. With casters on one side only, the robot and its
    sensors are tilted. The support is computed with all joints at zero, for the two wheels of a
    drive, or the only two wheels. Casters are recognized by their names, and spheres that are
    lower than all but the wheels count as casters. Wheels and casters on springs are skipped.
    ``deepest`` [m] is the tolerated gap below the wheels, ``steepest`` [degrees] the tolerated
    tilt.
    """
    if sum(joint.type == "continuous" for joint in robot.joints) < 2 or robot.tree.root is None:
        return
    from math import degrees

    from .casters import find_axle, find_casters

    if any(any(find_shapes_in_millimeters(link)) for link in robot.links):
        return
    axle = find_axle(robot)
    found = list(find_casters(robot, axle)) if axle is not None else []
    found = [caster for caster in found if abs(caster.ahead) > 0.005]
    ends = [[c for c in found if c.ahead > 0], [c for c in found if c.ahead < 0]]
    firsts = [min(end, key=lambda c: c.tilt) for end in ends if end]
    if len(firsts) == 2:
        one, other = firsts
        span = abs(one.ahead) + abs(other.ahead)
        air = -(one.above * abs(other.ahead) + other.above * abs(one.ahead)) / span
        if air > deepest:
            low = min(firsts, key=lambda c: c.above)
            yield _report_caster(low, f"the wheels are {air * 1000:.3g} mm above the ground")
            return
    tilted = min(firsts, key=lambda c: abs(c.tilt), default=None)
    if tilted is not None and degrees(abs(tilted.tilt)) > steepest:
        tilt = degrees(abs(tilted.tilt))
        yield _report_caster(tilted, f"the robot is tilted by {tilt:.1f}°")


def _report_caster(caster: Caster, consequence: str) -> Problem:
    where = "below" if caster.above < 0 else "above"
    what = "joint" if isinstance(caster.moved, Joint) else "collision"
    data: dict[str, Any] = {"above": caster.above}
    right = ""
    if caster.height is not None and caster.link.xml is not None:
        data["write"] = _format_length(caster.height)
        right = f"; write z = {data['write']} for its {what}"
    return Problem(
        caster.link,
        f"caster '{caster.link.name}' ends {abs(caster.above) * 1000:.3g} mm {where} the driven "
        f"wheels, so {consequence}{right}",
        at=caster.moved.origin or caster.moved,
        data=data,
    )


def _format_length(value: float) -> str:
    return f"{round(value, 5) + 0.0:g}"


@caster_height_mismatch.fix(UNSAFE)
def write_caster_height(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the height at which the caster ends at the height of the wheels."""
    origin = find_element(problem)
    height = problem.data.get("write")
    if height is None or origin is None or origin.tag != "origin":
        return None
    words = get_written_value(origin, "xyz").split()
    if len(words) != 3 or is_computed(origin, "xyz"):
        return None
    x, y, _ = words
    return unsafe(f"write z = {height}", set_attribute(origin, "xyz", f"{x} {y} {height}"))


@rule(
    INFO,
    default=False,
    effects={
        "gz, gazebo-classic, mujoco": (
            "use the shape as written: fast objects can pass through it in one step"
        ),
    },
)
def paper_thin_collision(robot: Robot, *, thinnest: float = 0.001) -> Iterator[Problem]:
    """A collision is thinner than the distance that objects move in one step.

    At a time step of 1 ms an object at 1 m/s moves 1 mm: it can pass a thinner wall without
    contact. ``thinnest`` [m] is the smallest tolerated thickness.
    """
    for link in robot.links:
        for collision in link.collisions:
            size = compute_size(collision.geometry)
            if size is None or min(size) <= 0 or min(size) >= thinnest:
                continue
            what = "box" if isinstance(collision.geometry, Box) else "collision"
            yield Problem(
                link,
                f"a {what} of link '{link.name}' is only {min(size) * 1000:.3g} mm thick; "
                f"make it {thinnest * 1000:g} mm or more",
                at=collision.geometry,
                data={"thickness": min(size), "limit": thinnest},
            )
