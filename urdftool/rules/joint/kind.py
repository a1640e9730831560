"""Rules on the type of a joint."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import BALL_TYPES, JOINT_TYPES, Joint, Robot
from ..fix import (
    FixContext,
    Proposal,
    find_element,
    is_computed,
    remove_element,
    set_attribute,
    unsafe,
)
from ..rule import ANY_FORMAT, ERROR, GAZEBO, INFO, ROS, UNSAFE, Problem, rule, select_holding
from ..unexpanded import is_unexpanded
from ..xml.vocabulary_table import suggest_word

_REMEDIES = {
    "spherical": "only MuJoCo and PyBullet read it; use three revolute joints",
    "ball": "only SDF and Drake's <drake:joint> have it; use three revolute joints",
    "universal": "only SDF and Drake's <drake:joint> have it; use two revolute joints",
    "screw": "only SDF and Drake's <drake:joint> have it",
    "hinge": "write revolute, or continuous without limits",
}
_SYNONYMS = {
    "slide": "prismatic",
    "linear": "prismatic",
    "rotary": "revolute",
    "rotational": "revolute",
    "free": "floating",
    "weld": "fixed",
}


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": "reject the robot: joint has no known type",
        "mujoco, pybullet, drake (not spherical)": "reject it",
        "mujoco, pybullet (spherical)": "load it",
        "drake (spherical)": "rejects it",
        "newton": "rejects the robot",
    },
    formats=ANY_FORMAT,
)
def unknown_joint_type(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A joint has no type, or a type that is not in URDF.

    The types are revolute, continuous, prismatic, fixed, floating and planar. Readers reject the
    robot for any other type, except that MuJoCo and PyBullet load ``spherical``.
    """
    for joint in robot.joints:
        if joint.type.lower() in JOINT_TYPES or is_unexpanded(joint.type):
            continue
        if joint.xml is None:
            continue  # a type of SDF or MJCF
        names = joint.xml.attributes
        if "type" in names or not any(name.lower() == "type" for name in names):
            yield _report_unknown_type(joint, targets)


@unknown_joint_type.full
def report_unknown_types(robot: Robot) -> Iterator[Problem]:
    """Report each type that is not in URDF, also in capitals or unexpanded."""
    for joint in robot.joints:
        if joint.type not in JOINT_TYPES:
            problem = _report_unknown_type(joint, frozenset())
            problem.data = {"is_ball": joint.type in BALL_TYPES}
            yield problem


def _report_unknown_type(joint: Joint, targets: frozenset[str]) -> Problem:
    kind, word = joint.type, None
    if joint.xml is None or "type" in joint.xml.attributes:
        instead = _REMEDIES.get(kind)
        if instead is None:
            word = _SYNONYMS.get(kind) or suggest_word(kind, JOINT_TYPES)
            instead = f"write {word}" if word else f"the types are {', '.join(sorted(JOINT_TYPES))}"
        message = f"joint '{joint.name}' has the unknown type '{kind}'; {instead}"
    else:
        message = f"joint '{joint.name}' has no type; write type=\"…\""
    case = "spherical" if kind == "spherical" else "not spherical"
    loads = kind == "spherical" and targets and targets <= {"mujoco", "pybullet"}
    return Problem(
        joint,
        message,
        at=joint.locate_attribute("type"),
        severity=INFO if loads else None,
        data={"write": word} if word else None,
        effects=select_holding(unknown_joint_type.effects, case),
    )


@unknown_joint_type.fix(UNSAFE, reveals=True)
def write_joint_type(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the URDF type with a similar name or the same meaning."""
    word: str | None = problem.data.get("write")
    if word is None:
        return None
    element = context.get_joint(problem).element
    return unsafe(f"make it {word}", set_attribute(element, "type", word))


_PLANAR = {
    "gz, gazebo-classic": "reject the model (sdformat 12.3: Error 25)",
    "robot_state_publisher (floating)": "publishes no transform for it",
    "robot_state_publisher (planar)": "publishes a fixed transform for it",
    "KDL": "treats it as fixed",
    "pybullet (floating)": "treats it as fixed",
    "pybullet (planar)": "gives it two prismatic axes and a revolute one",
    "mujoco (planar)": "loads it",
    "mujoco (floating, at the root)": "loads it",
    "mujoco (floating, above the root)": "rejects the file: such a joint must be at the root",
    "newton (floating)": "loads it",
    "newton (planar)": "moves it along two axes, without rotation",
    "drake (one damping)": "rejects the file: it requires three damping values for a planar joint",
}


@rule(
    INFO,
    raised=dict.fromkeys(GAZEBO, ERROR),
    effects=_PLANAR,
    pedantic="planar joints at the root of robots that are not for Gazebo",
)
def planar_or_floating(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A joint is planar or floating.

    sdformat removes the joint and keeps a pose relative to it, so Gazebo rejects the model.
    robot_state_publisher publishes no transform for a floating joint, and a fixed one for a planar
    joint. MuJoCo loads both types; Drake loads planar joints. Reported are robots for Gazebo or
    ROS, and joints that MuJoCo or Drake rejects: a floating joint above the root, and a planar one
    with a damping. A planar joint at the root is the mobile base of a planner: it is off by default
    for a robot that is not for Gazebo.
    """
    concerned = not targets.isdisjoint((*GAZEBO, *ROS))
    for joint in robot.joints:
        if joint.type not in ("planar", "floating"):
            continue
        conditions = _list_conditions(robot, joint)
        if concerned or _is_rejected(conditions):
            is_base = {"planar", "at the root"} <= set(conditions)
            yield Problem(
                joint,
                f"joint '{joint.name}' is {joint.type}: Gazebo rejects it, and "
                "robot_state_publisher does not move it; use revolute and prismatic joints, or "
                "leave the root free",
                at=joint.locate_attribute("type"),
                effects=select_holding(_PLANAR, *conditions),
                pedantic=is_base and targets.isdisjoint(GAZEBO),
            )


def _is_rejected(conditions: list[str]) -> bool:
    """Tell whether MuJoCo or Drake rejects a robot with such a joint."""
    return {"floating", "above the root"} <= set(conditions) or "one damping" in conditions


def _list_conditions(robot: Robot, joint: Joint) -> list[str]:
    """List what effects depend on: the type, its parent, and whether damping is one value."""
    is_low = robot.tree.get_parent_joint(joint.parent) is None
    place = "at the root" if is_low else "above the root"
    return [joint.type, place, *["one damping"] * _has_one_damping(joint)]


def _has_one_damping(joint: Joint) -> bool:
    """Tell whether a joint is planar and has one damping value, as in URDF."""
    dynamics = joint.element.find_child("dynamics")
    damping = dynamics.get("damping") if dynamics is not None else None
    return joint.type == "planar" and damping is not None and len(damping.split()) == 1


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "do not move by them: the joint is fixed"
        ),
    },
    default=False,
)
def redundant_on_fixed(robot: Robot) -> Iterator[Problem]:
    """A fixed joint has an axis, a limit or dynamics.

    The joint does not move by them. Exporters write them. PyBullet's ``getJointInfo`` and yourdfpy
    still return the values. Readers that use urdfdom still reject the robot if the ``<limit>`` is
    incomplete.
    """
    for joint in robot.joints:
        if joint.is_fixed:
            for part in (joint.axis, joint.limit, joint.dynamics):
                if part is not None:
                    yield Problem(
                        joint,
                        f"joint '{joint.name}' is fixed, so its <{part.element.tag}> has no "
                        "effect; "
                        "remove it",
                        at=part,
                        data={"element": part.element.tag},
                    )


@redundant_on_fixed.fix(UNSAFE)
def remove_from_fixed_joint(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the element, unless a xacro argument sets the type of the joint."""
    element = find_element(problem)
    if element is None or is_computed(context.get_joint(problem).element, "type"):
        return None
    return unsafe(f"remove the <{element.tag}>", remove_element(element))
