"""Rules on the interfaces that controllers command."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.controllers import Controller
from ...model.elements import Robot
from ...source.description import Description
from ...source.xacro_names import CONDITIONS
from ..rule import ERROR, WARNING, Problem, rule
from ..words import join_some, quote
from ..xacro.definitions import get_definitions
from .controller_files import get_package

APPLIES_TO = ("ros2_control",)

_KIND = "JointTrajectoryController"


@rule(
    ERROR,
    on=("ros2",),
    effects={
        "controller_manager": "does not activate the controller: the command interface does not "
        "exist",
    },
)
def controller_without_interface(robot: Robot, description: Description) -> Iterator[Problem]:
    """A controller commands an interface that the joint does not have in ``<ros2_control>``.

    Checked is ``command_interfaces`` of a ``JointTrajectoryController``, in the controller files of
    the robot, for joints with other command interfaces. An interface that the description has with
    other xacro arguments is not reported. It is a warning in a file that no plugin of the robot and
    no launch file names.
    """
    given: dict[str, set[str]] = {}
    for control in robot.ros2_controls:
        for joint in control.joints:
            names = given.setdefault(joint.name, set())
            names.update(interface.name for interface in joint.command_interfaces)
    for file in get_package(robot, description).controller_files:
        for controller in file.controllers:
            if controller.kind != _KIND or file.shared:
                continue
            for node in controller.list_scalars("command_interfaces"):
                lacking = [
                    name
                    for name in _list_commanded(controller)
                    if given.get(name) and node.text not in given[name]
                ]
                if lacking and not _is_optional(node.text or "", description):
                    others = sorted(set().union(*(given[name] for name in lacking)))
                    yield Problem(
                        robot,
                        f"controller '{controller.name}' commands interface '{node.text}', which "
                        f"<ros2_control> does not give {join_some(lacking, 'joints', 3)}, only "
                        f"{quote(others)}",
                        at=node.place,
                        severity=None if file.by_plugin or file.by_launch else WARNING,
                    )


def _list_commanded(controller: Controller) -> list[str]:
    """List the joints that a trajectory controller commands."""
    nodes = controller.list_scalars("command_joints") or controller.list_scalars("joints")
    return [node.text or "" for node in nodes]


def _is_optional(name: str, description: Description) -> bool:
    """Tell whether joints may have a command interface with other xacro arguments."""
    if description.expansion is None:
        return False
    for document in get_definitions(description).documents:
        for element in document.root.walk():
            given = element.get("name") or ""
            if element.tag != "command_interface" or not (given == name or "$" in given):
                continue
            above = element.parent
            while above is not None and above.tag not in CONDITIONS:
                above = above.parent
            if "$" in given or above is not None:
                return True
    return False
