"""The axis of a joint."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...model.pose import norm
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
from ..rule import ERROR, INFO, SAFE, UNSAFE, WARNING, Problem, rule


@rule(
    ERROR,
    effects={
        "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 9)",
        "mujoco, drake": "reject the file",
        "pybullet": "loads it; a force on the joint makes its position NaN",
        "urdfdom, pinocchio": "accept it without a message; the mass matrix is singular",
    },
)
def zero_axis(robot: Robot, *, shortest: float = 1e-6) -> Iterator[Problem]:
    """A moving joint's axis is the zero vector.

    An axis is a direction, and readers divide by its length. MuJoCo, sdformat and Drake reject the
    robot; PyBullet loads it, and the joint's position is NaN as soon as a force acts. On a fixed
    joint it does no harm.
    """
    for joint in robot.joints:
        if joint.has_axis and joint.axis is not None and norm(joint.axis.xyz) < shortest:
            yield Problem(
                joint,
                f"axis of joint '{joint.name}' is zero; write a direction such as 0 0 1",
                at=joint.axis.element.attribute_place("xyz"),
            )


@rule(
    WARNING,
    effects={
        "mujoco, drake, KDL": "normalize it",
        "urdfdom, gz, gazebo-classic, pybullet": (
            "pass it on as it is; a joint in PyBullet then moves by another amount"
        ),
    },
)
def axis_not_unit(robot: Robot, *, tolerance: float = 1e-3) -> Iterator[Problem]:
    """A moving joint's axis is not of unit length.

    The specification asks for a unit vector and urdfdom passes on what is written. MuJoCo, Drake
    and KDL normalize it; PyBullet, and code that multiplies the joint's position with the axis,
    moves the joint by a wrong amount.
    """
    for joint in robot.joints:
        if not joint.has_axis or joint.axis is None:
            continue
        length = norm(joint.axis.xyz)
        if length >= 1e-6 and abs(length - 1.0) > tolerance:
            yield Problem(
                joint,
                f"axis of joint '{joint.name}' has length {length:.6g}; write a unit vector",
                at=joint.axis.element.attribute_place("xyz"),
                data={"length": length},
            )


@axis_not_unit.fix(UNSAFE)
def write_unit_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the same direction at unit length.

    PyBullet takes the axis as it is written: at length 2 a revolute joint accelerates by half, and
    a prismatic one moves by twice its position.
    """
    joint = context.joint(problem)
    if joint.axis is None:
        return None
    length = norm(joint.axis.xyz)
    unit = format_numbers((part / length for part in joint.axis.xyz), 17)
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

    The default is x (1 0 0). Many expect z; whoever means x helps the next reader by writing it.
    As every reader takes the default, the rule is off unless it is selected. A wheel that does not
    turn about x is a case of ``wheel-cylinder-axis``. Planar joints are left out: Pinocchio ignores
    their axis, and sdformat rejects them.
    """
    for joint in robot.joints:
        if joint.has_axis and joint.axis is None and joint.type != "planar":
            yield Problem(
                joint,
                f"joint '{joint.name}' has no <axis>, so it is 1 0 0; write it down",
            )


@axis_omitted.fix(SAFE)
def write_default_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the default, where no argument puts another axis there."""
    joint = context.joint(problem)
    behind = joint.child_element or joint.parent_element
    if behind is None or may_vary(joint.element):
        return None
    return safe('write <axis xyz="1 0 0"/>', insert_after(behind, '<axis xyz="1 0 0"/>'))


@rule(
    INFO,
    effects={
        "pinocchio": "builds a joint with a free axis instead of one along x, y or z",
    },
)
def axis_nearly_canonical(
    robot: Robot, *, smallest: float = 1e-6, largest: float = 1e-2
) -> Iterator[Problem]:
    """A joint's axis is almost, but not quite, along x, y or z.

    That is noise of a drawing program. It tilts the arm by a hair, keeps analytic inverse
    kinematics from seeing the axis for what it is, and makes mirrored arms differ.
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
            f"axis of joint '{joint.name}' is off by {middle / high:.1g} rad; "
            f"write {snapped} if that is meant",
            at=joint.axis.element.attribute_place("xyz"),
            data={"write": snapped, "angle": middle / high},
        )


@axis_nearly_canonical.fix(UNSAFE)
def write_canonical_axis(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the axis along x, y or z."""
    axis, snapped = context.joint(problem).axis, problem.data["write"]
    if axis is None:
        return None
    return unsafe(f'write xyz="{snapped}"', set_attribute(axis.element, "xyz", snapped))
