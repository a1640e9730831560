"""Rules on controllers of ros_control and ros2_control in YAML files."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.controllers import Controller, extract_joint
from ...model.elements import Robot
from ...source.description import Description
from ...source.yaml_tree import Node
from ..fix import FixContext, Proposal, Span, get_suggestion, unsafe
from ..rule import ROS, UNSAFE, WARNING, Problem, rule
from ..words import find_nearest
from .controller_files import ControllerFile, Package, get_package

APPLIES_TO = ("ros2_control", "transmission")

_READ_ONLY = ("Broadcaster", "StateController", "SensorController")
_WORDS = re.compile(r"[a-z]+|\d+")


@rule(
    WARNING,
    on=ROS,
    effects={
        "ros2_control": "has no interface of this joint for the controller",
    },
)
def controller_unknown_joint(robot: Robot, description: Description) -> Iterator[Problem]:
    """A controller refers to a joint that does not exist, or that is fixed.

    Controllers are configured in a YAML file, so a wrong joint name is found only when the
    controller is loaded. Checked are files in ``<parameters>`` of the ros2_control plugin, and
    files of the robot's package that a launch file uses with the description, or that no other
    robot uses. If the file is for several robots, or xacro arguments remove parts of the robot,
    only names that are similar to an unused joint are reported.
    """
    package = get_package(robot, description)
    for file in package.controller_files:
        for controller in file.controllers:
            for node in controller.joints:
                yield from _check_joint(robot, package, file, controller, node)


def _check_joint(
    robot: Robot,
    package: Package,
    file: ControllerFile,
    controller: Controller,
    node: Node,
) -> Iterator[Problem]:
    name = extract_joint(node)
    if _has(robot, name):
        joint = robot.joint.get(name)
        fixed = joint is not None and joint.is_fixed and not controller.kind.endswith(_READ_ONLY)
        if fixed and not file.shared:
            yield Problem(
                robot,
                f"joint '{name}' is fixed, so controller '{controller.name}' cannot move it",
                at=node.place,
            )
        return
    if not re.fullmatch(r"[\w.-]+", name) or _is_in_other_part(robot, package, name):
        return
    if package.description.expansion is not None and _is_differently_prefixed(robot, controller):
        return
    near = _suggest_joint(robot, controller, name)
    if near or (not file.shared and _is_sure(robot, package, file, controller)):
        question = f"; did you mean '{near}'?" if near else ""
        yield Problem(
            robot,
            f"controller '{controller.name}' refers to joint '{name}', which the robot does not "
            f"have{question}",
            at=node.place,
            data={"joint": name, "suggestion": near},
        )


@controller_unknown_joint.fix(UNSAFE)
def write_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the suggested joint in the controller file."""
    file, start, end = problem.place.file, problem.place.start, problem.place.end
    wrong = re.search(rb"[\w.-]+(?=[\"']?$)", file.data[start:end])
    name = get_suggestion(problem, wrong[0].decode("utf-8", "replace")) if wrong is not None else ""
    if wrong is None or not name:
        return None
    at = start + wrong.start()
    return unsafe(f"write {name}", Span(file, at, at + len(wrong[0]), name.encode()))


def _has(robot: Robot, name: str) -> bool:
    return name in robot.joint or any(
        name == component.name for block in robot.ros2_controls for component in block.components
    )


def _has_some(robot: Robot, *controllers: Controller) -> bool:
    return any(_has(robot, extract_joint(node)) for one in controllers for node in one.joints)


def _is_sure(robot: Robot, package: Package, file: ControllerFile, controller: Controller) -> bool:
    """Tell whether a controller is for the robot as expanded, not for other xacro arguments."""
    if not file.by_plugin and not file.by_launch:
        return False
    if _has_some(robot, controller):
        return True
    if package.description.expansion is None:
        return True
    if file.by_plugin and not _has_some(robot, *file.controllers):
        return True
    sources = [source.data for source in package.description.files]
    return not any(b"<xacro:if" in data or b"<xacro:unless" in data for data in sources)


def _is_differently_prefixed(robot: Robot, controller: Controller) -> bool:
    """Tell whether joints of a controller differ from those of the robot by a prefix only."""
    names = [extract_joint(node) for node in controller.joints]
    known = [joint.name for joint in robot.joints if joint.name]
    return all(a not in known and any(a.endswith(b) or b.endswith(a) for b in known) for a in names)


def _is_in_other_part(robot: Robot, package: Package, name: str) -> bool:
    """Tell whether a name occurs in a file or a branch that this robot does not use."""
    if name in robot.link:
        return False
    sources = package.description.files if package.description.expansion is not None else []
    word = re.compile(rb"(?<!\w)" + re.escape(name.encode()) + rb"(?!\w)")
    return any(word.search(file.data) for file in (*sources, *(package.other_files or ())))


def _suggest_joint(robot: Robot, controller: Controller, name: str) -> str:
    """Find the joint with a similar name that the controller does not contain."""
    named = {extract_joint(node) for node in controller.joints}
    if name in robot.link:  # a link name in place of its joint
        joint = robot.tree.get_parent_joint(name)
        return joint.name if joint is not None and joint.has_axis else ""
    free = [joint.name for joint in robot.moving_joints if joint.name not in named]
    words = sorted(_WORDS.findall(name.lower()))
    for other in free:
        if sorted(_WORDS.findall(other.lower())) == words:
            return other
    longer = [f for f in free if f.startswith(f"{name}_") or name.startswith(f"{f}_")]
    if len(longer) == 1:
        return longer[0]
    return find_nearest(name, free, 0.8)
