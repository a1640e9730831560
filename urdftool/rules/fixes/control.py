"""Fixes of transmissions and ros2_control."""

from __future__ import annotations

import re

from ...source.document import Element
from ..control.controller_files import package_of
from ..control.parameter_types import wrong_types
from ..control.ros2_control import repeats_mimic
from ..rule import Problem
from .proposal import (
    Around,
    Change,
    Proposal,
    Span,
    after,
    attribute_at,
    element_at,
    insert,
    is_computed,
    lines_of,
    meant,
    put,
    quote,
    remove,
    replace,
    retag,
    safe,
    say,
    sub,
    sub_text,
    unsafe,
    written,
)


def _rename(problem: Problem) -> Proposal | None:
    """What was meant, for the attribute or text that a problem points at."""
    found = attribute_at(problem)
    if found is not None:
        name = meant(problem, found[0].get(found[1]) or "")
        return unsafe(f"write {name}", put(*found, name)) if name else None
    element = element_at(problem)
    name = meant(problem, element.text.strip()) if element is not None else ""
    return unsafe(f"write {name}", say(element, name)) if element is not None and name else None


def transmission_unknown_joint(problem: Problem, around: Around) -> Proposal | None:
    """The joint that was meant, if no other transmission drives it."""
    made = _rename(problem)
    names = {joint.name for t in around.robot.transmissions for joint in t.joints}
    return None if made is not None and _new_value(made) in names else made


def _new_value(made: Proposal) -> str:
    change = made.changes[0]
    return change.value if isinstance(change, Change) else ""


def unprefixed_hardware_interface(problem: Problem, around: Around) -> Proposal | None:
    """With its prefix."""
    element = element_at(problem)
    if element is None:
        return None
    name = element.text.strip()
    return safe(
        f"write hardware_interface/{name}",
        sub_text(element, r"^(\s*)(?=(?:Effort|Position|Velocity)Joint)", r"\1hardware_interface/"),
    )


def missing_hardware_interface(problem: Problem, around: Around) -> Proposal | None:
    """That of the actuator, moved to the joint."""
    transmission = problem.element
    joints = [joint for joint in transmission.all("joint") if not joint.child("hardwareInterface")]
    inside = [
        interface
        for actuator in transmission.all("actuator")
        for interface in actuator.all("hardwareInterface")
    ]
    if len(joints) != 1 or not inside or not inside[0].text.strip():
        return None
    changes = [remove(interface) for interface in inside]
    line = f"<hardwareInterface>{quote(inside[0].text.strip())}</hardwareInterface>"
    return unsafe("move it into the joint", *changes, insert(joints[0], line))


def unknown_hardware_interface(problem: Problem, around: Around) -> Proposal | None:
    """The interface that was meant."""
    return _rename(problem)


def duplicate_transmission(problem: Problem, around: Around) -> Proposal | None:
    """A number behind the second of a name."""
    found = attribute_at(problem)
    if found is None or "is called" not in problem.message or found[0] is not problem.element:
        return None
    taken = {transmission.name for transmission in around.robot.transmissions}
    name, number = found[0].get("name") or "", 2
    while f"{name}_{number}" in taken:
        number += 1
    return unsafe(f"call it '{name}_{number}'", sub(*found, r"(?<=\S)(?=\s*$)", f"_{number}"))


def transmission_on_immovable_joint(problem: Problem, around: Around) -> Proposal | None:
    """Gone."""
    transmission = problem.element
    if sum(1 for _ in transmission.all("joint")) != 1:
        return None
    return unsafe("take the transmission out", remove(transmission))


def actuated_joint_without_transmission(problem: Problem, around: Around) -> Proposal | None:
    """One like those of the other joints."""
    joint = around.joint(problem)
    used = [
        text
        for transmission in around.robot.transmissions
        for part in transmission.joints
        for text in part.hardware_interfaces
    ]
    if len(set(used)) > 1:
        return None
    interface = used[0] if used else "hardware_interface/EffortJointInterface"
    name = quote(written(joint.element, "name"))
    lines = (
        f'<transmission name="{name}_transmission">',
        "\t<type>transmission_interface/SimpleTransmission</type>",
        f'\t<joint name="{name}">',
        f"\t\t<hardwareInterface>{quote(interface)}</hardwareInterface>",
        "\t</joint>",
        f'\t<actuator name="{name}_motor">',
        "\t\t<mechanicalReduction>1</mechanicalReduction>",
        "\t</actuator>",
        "</transmission>",
    )
    return unsafe(f"add a transmission with {interface}", after(joint.element, *lines))


def ros2_control_unknown_joint(problem: Problem, around: Around) -> Proposal | None:
    """The joint that was meant, if it is in no block yet."""
    made = _rename(problem)
    known = {joint.name for control in around.robot.ros2_controls for joint in control.joints}
    return None if made is not None and _new_value(made) in known else made


def ros2_control_fixed_joint(problem: Problem, around: Around) -> Proposal | None:
    """Remove the joint, whose states ROS before Jazzy reports."""
    element = element_at(problem)
    return unsafe("take the joint out", remove(element)) if element is not None else None


def ros2_control_mimic(problem: Problem, around: Around) -> Proposal | None:
    """Without the commands that its leader has."""
    interface = element_at(problem)
    joint = interface.parent if interface is not None else None
    if interface is None or interface.tag != "command_interface" or joint is None:
        return None
    return unsafe("take its command interfaces out", *map(remove, joint.all("command_interface")))


def ros2_control_legacy_mimic_param(problem: Problem, around: Around) -> Proposal | None:
    """Leave it to the ``<mimic>`` of the URDF, which ROS before Jazzy does not read here."""
    param = element_at(problem)
    part = param.parent if param is not None else None
    joint = around.robot.joint.get(part.get("name") or "") if part is not None else None
    if param is None or part is None or joint is None:
        return None
    leader = param.text.strip()
    factors = [p for p in part.all("param") if p.get("name") == "multiplier"]
    changes = [remove(param), *map(remove, factors)]
    if joint.mimic is None:
        if leader not in around.robot.joint or joint.is_fixed:
            return None
        if is_computed(around.robot.joint[leader].element):
            return None
        by = f' multiplier="{quote(factors[0].text.strip())}"' if factors else ""
        changes.append(insert(joint.element, f'<mimic joint="{quote(leader)}"{by}/>'))
        return unsafe("write <mimic> into the joint", *changes)
    params = {p.get("name") or "": p.text.strip() for p in part.all("param")}
    if not repeats_mimic(params, joint.mimic):
        return None
    return unsafe("remove it: the joint has its <mimic>", *changes)


def ros2_control_duplicate_interface(problem: Problem, around: Around) -> Proposal | None:
    """The second of one joint goes."""
    element = element_at(problem)
    if element is None or " twice" not in problem.message:
        return None
    return unsafe("take the second out", remove(element))


def nonstandard_interface_name(problem: Problem, around: Around) -> Proposal | None:
    """The name that was meant."""
    return _rename(problem)


def command_without_state(problem: Problem, around: Around) -> Proposal | None:
    """The state of that name."""
    interface = element_at(problem)
    joint = interface.parent if interface is not None else None
    if joint is None:
        return None
    states = {
        state.name
        for control in around.robot.ros2_controls
        for other in control.joints
        if other.name == (joint.get("name") or "")
        for state in other.state_interfaces
    }
    names = [command.get("name") or "" for command in joint.all("command_interface")]
    missing = [name for name in names if name in ("position", "velocity") and name not in states]
    lines = tuple((f'<state_interface name="{name}"/>',) for name in dict.fromkeys(missing))
    return unsafe("add the state", Change("insert", joint, blocks=lines))


def joint_outside_ros2_control(problem: Problem, around: Around) -> Proposal | None:
    """In the one block there is, with its states and no command."""
    joint = around.joint(problem)
    if len(around.robot.ros2_controls) != 1 or is_computed(joint.element):
        return None
    block = around.robot.ros2_controls[0].element
    lines = (
        f'<joint name="{quote(joint.name)}">',
        '\t<state_interface name="position"/>',
        '\t<state_interface name="velocity"/>',
        "</joint>",
    )
    return unsafe("report its position and velocity", insert(block, *lines))


def ros2_control_invalid_tag(problem: Problem, around: Around) -> Proposal | None:
    """The element that was meant."""
    element = element_at(problem)
    name = meant(problem, element.tag) if element is not None else ""
    if element is None or not name:
        return None
    return unsafe(f"write <{name}>", retag(element, name))


def ros2_control_nested(problem: Problem, around: Around) -> Proposal | None:
    """Move it up into the robot; where another is there, the hardware is one more from then on."""
    element = problem.element
    make = unsafe if around.robot.element.child("ros2_control") is not None else safe
    top: Element = element
    while top.parent is not None and top.parent is not around.robot.element:
        top = top.parent
    if top is element or top.parent is None:
        return None
    alone = element.parent is top and len(top.children) == 1 and top.tag == "gazebo"
    if alone and not top.attributes:
        return make("move it up", replace(top, tuple(lines_of(element))))
    return make("move it up", remove(element), after(top, *lines_of(element)))


def ros2_control_wrong_sim_plugin(problem: Problem, around: Around) -> Proposal | None:
    """The class of the Gazebo that it is for."""
    element = element_at(problem)
    right = problem.message.partition("; write ")[2]
    if element is None or element.tag != "plugin" or not right:
        return None
    return unsafe(f"write {right}", say(element, right))


def ros2_control_unknown_imu_interface(problem: Problem, around: Around) -> Proposal | None:
    """The state that was meant."""
    return _rename(problem)


def controller_unknown_joint(problem: Problem, around: Around) -> Proposal | None:
    """The joint that was meant, in the file of controllers."""
    file, start, end = problem.place.file, problem.place.start, problem.place.end
    written_there = file.data[start:end]
    wrong = re.search(rb"[\w.-]+(?=[\"']?$)", written_there)
    name = meant(problem, wrong[0].decode("utf-8", "replace")) if wrong is not None else ""
    if wrong is None or not name:
        return None
    at = start + wrong.start()
    return unsafe(f"write {name}", Span(file, at, at + len(wrong[0]), name.encode()))


def controller_parameter_type(problem: Problem, around: Around) -> Proposal | None:
    """The same numbers in the type that is declared; none is rounded."""
    for file in package_of(around.robot, around.description).controller_files:
        if file.file.path != problem.place.path:
            continue
        spans = []
        for _, node, right in wrong_types(file):
            if node.items is None and float(node.text or 0) != float(right):
                continue
            pairs = [(node, right)]
            if node.items is not None:
                pairs = [(item, f"{item.text}.0") for item in node.items]
            spans += [Span(one.file, one.start, one.end, text.encode()) for one, text in pairs]
        return safe("write the type that is declared", *spans) if spans else None
    return None
