"""Rules on the axis of a joint."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.pose import compute_norm
from ..fix import (
    FixContext,
    Proposal,
    format_numbers,
    insert_after,
    may_vary,
    safe,
    set_attribute,
    unsafe,
)
from ..rule import ANY_FORMAT, ERROR, INFO, SAFE, UNSAFE, WARNING, Problem, rule


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 9)",
        "mujoco, drake": "reject the file",
        "pybullet": "loads it; the joint position becomes NaN when a force acts on it",
        "urdfdom, pinocchio": "accept it without a message; the mass matrix is singular",
    },
    formats=ANY_FORMAT,
)
def zero_axis(robot: Robot, *, shortest: float = 1e-6) -> Iterator[Problem]:
    """The axis of a moving joint is the zero vector.

    An axis is a direction, and readers divide by its length. MuJoCo, sdformat and Drake reject the
    robot. PyBullet loads it, and the joint position becomes NaN when a force acts on the joint. The
    axis of a fixed joint is not checked. ``shortest`` is the length below which an axis counts as
    zero.
    """
    for joint in robot.joints:
        if joint.has_axis and joint.axis is not None and compute_norm(joint.axis.xyz) < shortest:
            yield Problem(
                joint,
                f"axis of joint '{joint.name}' is zero; write a direction such as 0 0 1",
                at=joint.axis.locate_attribute("xyz"),
            )


@rule(
    WARNING,
    effects={
        "gz, mujoco, drake, KDL": "accept it",
        "urdfdom": "keeps its length",
        "pybullet": "accelerates the joint by another amount under torque and gravity",
    },
    pedantic="lengths from 0.7 to 1.4, whose torques accelerate about twice at most",
)
def axis_not_unit(robot: Robot, *, tolerance: float = 1e-3) -> Iterator[Problem]:
    """The axis of a moving joint is not a unit vector.

    The URDF specification requires a unit vector, and urdfdom keeps the written length, also for
    code that multiplies the joint position by the axis. MuJoCo, Drake, KDL and new Gazebo normalize
    it. PyBullet normalizes it for positions, and reaches commanded positions and velocities, but
    not for accelerations: at length 2, a torque on a free joint turns it a quarter as far.
    ``tolerance`` is the difference from length 1 that is ignored.
    """
    for joint in robot.joints:
        if not joint.has_axis or joint.axis is None:
            continue
        length = compute_norm(joint.axis.xyz)
        if length >= 1e-6 and abs(length - 1.0) > tolerance:
            yield Problem(
                joint,
                f"axis of joint '{joint.name}' has length {length:.6g}; write a unit vector",
                at=joint.axis.locate_attribute("xyz"),
                data={"length": length},
                pedantic=0.7 <= length <= 1.4,
            )


@axis_not_unit.fix(UNSAFE)
def write_unit_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the same direction at unit length.

    The fix is unsafe because it changes the accelerations in PyBullet.
    """
    joint = context.get_joint(problem)
    if joint.axis is None:
        return None
    length = compute_norm(joint.axis.xyz)
    unit = format_numbers(part / length for part in joint.axis.xyz)
    return unsafe(f'write xyz="{unit}"', set_attribute(joint.axis.element, "xyz", unit))


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "take 1 0 0",
    },
)
def axis_omitted(robot: Robot) -> Iterator[Problem]:
    """A moving joint has no ``<axis>``.

    The default is 1 0 0. Many readers of the file expect z, so an explicit axis is clearer. All
    simulators use the default, so this rule is off unless selected. ``wheel-cylinder-axis`` reports
    a wheel that does not turn about x. Planar joints are not reported: Pinocchio ignores their
    axis, and sdformat rejects them.
    """
    for joint in robot.joints:
        if joint.has_axis and joint.axis is None and joint.type != "planar":
            yield Problem(
                joint,
                f"joint '{joint.name}' has no <axis>, so readers use 1 0 0; write it",
            )


@axis_omitted.fix(SAFE)
def write_default_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the default axis, unless a xacro argument may set a different one."""
    joint = context.get_joint(problem)
    behind = joint.child_element or joint.parent_element
    if behind is None or may_vary(joint.element):
        return None
    return safe('write <axis xyz="1 0 0"/>', insert_after(behind, '<axis xyz="1 0 0"/>'))


@rule(
    INFO,
    effects={
        "pinocchio": "builds a joint with a free axis instead of one along x, y or z",
    },
    group="robot",
)
def axis_nearly_canonical(
    robot: Robot, *, smallest: float = 3e-4, largest: float = 1e-2
) -> Iterator[Problem]:
    """The axis of a joint is almost, but not exactly, along x, y or z.

    This is rounding noise of a CAD export. It tilts the motion slightly, prevents analytic inverse
    kinematics from recognizing the axis, and makes mirrored arms differ. An angle between
    ``smallest`` and ``largest`` [rad] is reported; a smaller one moves a point at 1 m by less than
    0.3 mm.
    """
    for joint in robot.joints:
        if not joint.has_axis or joint.axis is None:
            continue
        x, y, z = map(abs, joint.axis.xyz)
        _, middle, high = sorted((x, y, z))
        if middle <= smallest * high or middle >= largest * high:
            continue
        place = (x, y, z).index(high)
        sign = "-1" if joint.axis.xyz[place] < 0 else "1"
        snapped = " ".join(sign if i == place else "0" for i in range(3))
        yield Problem(
            joint,
            f"axis of joint '{joint.name}' is {middle / high:.1g} rad off a coordinate axis; "
            f"write {snapped} if that is intended",
            at=joint.axis.locate_attribute("xyz"),
            data={"write": snapped, "angle": middle / high},
            group="axes of {count} joints are almost, but not exactly, along x, y or z: {names}; "
            "write them exactly if that is intended",
        )


@axis_nearly_canonical.fix(UNSAFE)
def write_canonical_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the axis along x, y or z."""
    axis, snapped = context.get_joint(problem).axis, problem.data["write"]
    if axis is None:
        return None
    return unsafe(f'write xyz="{snapped}"', set_attribute(axis.element, "xyz", snapped))
