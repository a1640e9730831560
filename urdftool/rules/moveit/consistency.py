"""Rules on names that the files of a MoveIt configuration share."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.controllers import Controller, list_controllers
from ...model.elements import Robot
from ...model.moveit_parameters import ACTIONS, get_action_type
from ...model.semantic import read_semantic
from ...model.semantic_groups import list_joints_of_group
from ...source.description import Description
from ...source.yaml_tree import Node
from ..rule import ERROR, WARNING, Problem, rule
from ..words import find_nearest, join_some, suggest_name
from .configuration import find_managers, read_next_to_srdf
from .semantic import get_srdf_documents

_ON = ("moveit",)
_TRAJECTORY = "FollowJointTrajectory"


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


_OTHER_JOINTS = "joint_trajectory_controller (other joints)"


@rule(
    ERROR,
    on=_ON,
    effects={
        "moveit": "finds no action server of the controller, and does not execute its trajectories",
        _OTHER_JOINTS: "rejects the trajectories of MoveIt",
    },
)
def moveit_controller_mismatch(robot: Robot, description: Description) -> Iterator[Problem]:
    """A controller of MoveIt differs from that of ros2_control in its name, action or joints.

    ``moveit_controllers.yaml`` names the controllers of ``ros2_controllers.yaml``, with the type
    and name of their action. ``spawn_controllers.launch.py`` starts them by these names. A
    ``parallel_gripper_action_controller`` offers ``ParallelGripperCommand``; other gripper
    controllers offer ``GripperCommand``. A ``JointTrajectoryController`` requires all of its joints
    in a trajectory, unless ``allow_partial_joints_goal`` is true, and no others. Nothing is
    reported if there is no ``ros2_controllers.yaml`` next to the SRDF.
    """
    root = read_next_to_srdf(robot, description, "ros2_controllers.yaml")
    if root is None:
        return
    known = {one.name: one for one in list_controllers(root)}
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
                yield from _compare_actions(robot, name, section, known[name])
                yield from _compare_joints(robot, name, section, known[name])


def _compare_actions(
    robot: Robot, name: str, section: Node, controller: Controller
) -> Iterator[Problem]:
    kind = controller.type.text or ""
    offered = get_action_type(kind)
    for key, right in (("type", offered), ("action_ns", ACTIONS.get(offered, ""))):
        node = (section.fields or {}).get(key)
        text = "" if node is None else (node.text or "").strip("/")
        if node is not None and right and text != right and "$" not in text:
            yield Problem(
                robot,
                f"MoveIt controller '{name}' has {key} '{node.text}', but its class {kind} offers "
                f"{right}; write {right}",
                at=node.place,
            )
            return


def _compare_joints(
    robot: Robot, name: str, section: Node, controller: Controller
) -> Iterator[Problem]:
    """Compare the joints of a trajectory controller, whose names may not be computed."""
    node = (section.fields or {}).get("joints")
    mine = {one.text or "" for one in (node.items if node is not None else None) or []}
    its = {one.text or "" for one in controller.list_scalars("joints")}
    if node is None or not mine or not its or any("$" in one for one in mine | its):
        return
    if get_action_type(controller.type.text or "") != _TRAJECTORY:
        return
    lacking, more = sorted(its - mine), sorted(mine - its)
    takes_part = controller.parameters.find("allow_partial_joints_goal")
    if takes_part is not None and takes_part.text in ("true", "True"):
        lacking = []
    if lacking:
        it = f"does not send {join_some(lacking, 'joints', 3)}, which ros2_controllers.yaml has"
    else:
        it = f"sends {join_some(more, 'joints', 3)}, which ros2_controllers.yaml does not have"
    if lacking or more:
        yield Problem(
            robot,
            f"MoveIt controller '{name}' {it}; write the same joints in both",
            at=node.place,
            effects=(_OTHER_JOINTS,),
        )


@rule(
    WARNING,
    on=_ON,
    effects={
        "moveit": "plans for the group, but identifies no set of controllers that can actuate it",
    },
)
def group_partly_controlled(robot: Robot, description: Description) -> Iterator[Problem]:
    """The controllers of MoveIt have only some of the joints of a group.

    MoveIt executes a trajectory only if its controllers together have all joints of the group;
    passive and mimic joints do not count. Nothing is reported of a group without any controller, of
    a group of groups, and of joints that are another group.
    """
    documents = get_srdf_documents(robot, description)
    root = read_next_to_srdf(robot, description, "ros2_controllers.yaml")
    compared = {
        one.name: {node.text or "" for node in one.list_scalars("joints")}
        for one in (() if root is None else list_controllers(root))
    }
    for manager in find_managers(robot, description):
        lists = {
            name: node
            for name, section in (manager.fields or {}).items()
            if (node := (section.fields or {}).get("joints")) is not None
        }
        controlled = {one.text or "" for node in lists.values() for one in node.items or []}
        # moveit-controller-mismatch reports what these lack
        controlled |= set().union(*(compared.get(name, set()) for name in lists))
        if not controlled or not controlled <= robot.joint.keys():
            continue  # moveit-controller-unknown-joint
        for document in documents:
            content = read_semantic(document.root)
            passive = {joint.name for joint in content.passive_joints}
            of_group = {
                group.name: {
                    name
                    for name in list_joints_of_group(content, group.name, robot)
                    if name in robot.joint
                    and name not in passive
                    and robot.joint[name].has_axis
                    and robot.joint[name].mimic is None
                }
                for group in content.groups
            }
            for group in content.groups:
                joints = of_group[group.name]
                lacking = joints - controlled
                if not lacking or lacking == joints or group.groups:
                    continue
                if any(other and other <= lacking for other in of_group.values()):
                    continue
                nearest = max(lists.values(), key=lambda node: _count_joints(node, joints))
                yield Problem(
                    robot,
                    f"no controller of MoveIt has {join_some(sorted(lacking), 'joints', 3)} of "
                    f"group '{group.name}'; write it in its controller, or mark it as passive",
                    at=nearest.place,
                )


def _count_joints(node: Node, joints: set[str]) -> int:
    return sum(one.text in joints for one in node.items or [])
