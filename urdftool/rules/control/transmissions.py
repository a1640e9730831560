"""Transmissions of ros_control."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ..rule import ERROR, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import did_you_mean

JOINT_INTERFACES = ("EffortJointInterface", "PositionJointInterface", "VelocityJointInterface")


@rule(ERROR, effects={"gazebo_ros_control": "fails to start: no joint is controlled"})
def transmission_unknown_joint(robot: Robot) -> Iterator[Problem]:
    """A transmission names a joint that is not there.

    ``gazebo_ros_control`` looks every joint up and gives up at the first that it does not find, so
    one misspelt name leaves the whole robot limp. Drivers of real hardware do much the same.
    """
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            if joint.name and joint.name not in robot.joint and not is_unexpanded(joint.name):
                yield Problem(
                    transmission.element,
                    f"transmission '{transmission.name}' names joint '{joint.name}', "
                    f"which is not there{did_you_mean(joint.name, robot.joint)}",
                    at=joint.element.attribute_place("name"),
                )


@rule(
    WARNING,
    on=("ros1",),
    effects={"gazebo_ros_control": "takes it and calls it deprecated syntax at every start"},
)
def unprefixed_hardware_interface(robot: Robot) -> Iterator[Problem]:
    """A hardware interface lacks its ``hardware_interface/``.

    ``EffortJointInterface`` alone is the syntax of before 2014. It is still taken, with a warning
    for every joint, by ``gazebo_ros_control``; other hardware compares the whole name and finds
    none.
    """
    for transmission in robot.transmissions:
        for joint in transmission.joints:
            for child in joint.element.all("hardwareInterface"):
                name = child.text.strip()
                if name in JOINT_INTERFACES:
                    yield Problem(
                        transmission.element,
                        f"'{name}' in transmission '{transmission.name}' lacks its prefix; "
                        f"write hardware_interface/{name}",
                        at=child,
                    )
