"""What ``<ros2_control>`` refers to in the robot."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ..rule import ERROR, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import did_you_mean

DIES = {"controller_manager": "stops with an exception at start"}


@rule(ERROR, on=("ros2",), effects=DIES)
def ros2_control_unknown_joint(robot: Robot) -> Iterator[Problem]:
    """A joint in ``<ros2_control>`` is not in the robot.

    The parser looks up every joint to know its limits and whether it mimics another, and throws at
    the first that it does not find. No controller starts, in simulation or on the robot.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            if joint.name and joint.name not in robot.joint and not is_unexpanded(joint.name):
                yield Problem(
                    control.element,
                    f"joint '{joint.name}' of ros2_control '{control.name}' is not in the robot"
                    + did_you_mean(joint.name, robot.joint),
                    at=joint.element.attribute_place("name"),
                )
