"""Rules on names that the files of a MoveIt configuration share."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.controllers import list_controllers
from ...model.elements import Robot
from ...model.moveit_parameters import get_action_type
from ...source.description import Description
from ...source.yaml_tree import Node
from ..rule import ERROR, WARNING, Problem, rule
from ..words import find_nearest, suggest_name
from .configuration import find_managers, read_next_to_srdf
from .semantic import get_srdf_documents

_ON = ("moveit",)


@rule(WARNING, on=_ON, effects={"moveit": "ignores the parameters"})
def moveit_unknown_name(robot: Robot, description: Description) -> Iterator[Problem]:
    """A MoveIt configuration has parameters for a group or joint that does not exist.

    MoveIt reads ``kinematics.yaml`` for each group of the SRDF, and ``joint_limits.yaml`` for each
    joint of the robot. Parameters with another name are never read: the intended group has no
    solver, and the intended joint keeps the limits of the description. A joint is reported only if
    its name is similar to another one, since the file may be for several robots.
    """
    groups = {
        group.get("name") or ""
        for document in get_srdf_documents(robot, description)
        for group in document.root.list_children("group")
    }
    solvers = read_next_to_srdf(robot, description, "kinematics.yaml")
    if groups and solvers is not None and "/**" not in (solvers.fields or {}):
        yield from _find_unknown(robot, "kinematics.yaml", "group", solvers, groups)
    file = read_next_to_srdf(robot, description, "joint_limits.yaml")
    limits = None if file is None else file.find("joint_limits")
    if limits is not None:
        yield from _find_unknown(robot, "joint_limits.yaml", "joint", limits, set(robot.joint))


def _find_unknown(
    robot: Robot, file: str, kind: str, section: Node, known: set[str]
) -> Iterator[Problem]:
    fields = section.fields or {}
    unused = known - set(fields)
    for name, node in fields.items():
        near = find_nearest(name, unused)
        if node.fields is None or name in known or (kind == "joint" and not near):
            continue
        owner = "the SRDF" if kind == "group" else "the robot"
        yield Problem(
            robot,
            f"{file} has parameters for {kind} '{name}', which {owner} does not have"
            f"{suggest_name(name, unused)}",
            at=node.place,
        )


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit": "finds no action server of the controller, and does not execute its trajectories"
    },
)
def moveit_controller_mismatch(robot: Robot, description: Description) -> Iterator[Problem]:
    """A controller of MoveIt is not configured for ros2_control, or offers another action.

    ``moveit_controllers.yaml`` names the controllers of ``ros2_controllers.yaml`` and the type of
    their action. ``spawn_controllers.launch.py`` starts them by these names. A
    ``parallel_gripper_action_controller`` offers ``ParallelGripperCommand``; other gripper
    controllers offer ``GripperCommand``. Nothing is reported if there is no
    ``ros2_controllers.yaml`` next to the SRDF.
    """
    root = read_next_to_srdf(robot, description, "ros2_controllers.yaml")
    if root is None:
        return
    known = {one.name: one.type.text or "" for one in list_controllers(root)}
    for manager in find_managers(robot, description):
        fields = manager.fields or {}
        listed = fields.get("controller_names")
        names = (listed.items if listed is not None else None) or []
        unused = set(known) - {node.text for node in names}
        for node in names:
            name = node.text or ""
            if name not in known:
                yield Problem(
                    robot,
                    f"MoveIt controller '{name}' is not in ros2_controllers.yaml"
                    f"{suggest_name(name, unused)}",
                    at=node.place,
                )
            elif (section := fields.get(name)) is not None:
                yield from _compare_types(robot, name, section, known[name])


def _compare_types(robot: Robot, name: str, section: Node, kind: str) -> Iterator[Problem]:
    node, offered = (section.fields or {}).get("type"), get_action_type(kind)
    if node is not None and offered and node.text != offered:
        yield Problem(
            robot,
            f"MoveIt controller '{name}' has type '{node.text}', but its class {kind} offers "
            f"{offered}; write {offered}",
            at=node.place,
        )
