"""Actuators: what transmissions, ros2_control and drive plugins say, or one kind for every joint.

URDF has no gains. A servo gets one that asks for the whole effort of its joint at a small error,
and critical damping for the inertia it moves (``dampratio``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from lxml import etree

from ...model.elements import Joint, Robot
from ..numbers import number_text, numbers_text
from ..written import Written
from .drives import plugin_drives
from .equality import follows
from .joint import effort_of
from .options import Actuators
from .structure import Structure, bounds, locked_at

POSITION_GAIN = {"hinge": 10.0, "slide": 100.0}
"""Gain of a position servo over its joint's effort [1/rad or 1/m]: all of it at 0.1 rad or 1 cm."""

VELOCITY_GAIN = 10.0
"""Gain of a velocity servo over effort by velocity: all of it at a tenth of the velocity."""

PLAIN_GAIN = {
    "position": {"hinge": 100.0, "slide": 1000.0},
    "velocity": {"hinge": 10.0, "slide": 100.0},
}
"""Gains where no effort is written."""

INTERFACES = ("position", "velocity", "effort")


@dataclass(frozen=True)
class Drive:
    """How a joint is driven: ``position``, ``velocity`` or ``motor``, and by which gear."""

    joint: Joint
    kind: str
    reduction: float = 1.0


def actuator_section(
    structure: Structure, actuators: Actuators, written: Written
) -> tuple[etree._Element | None, list[Drive]]:
    """``<actuator>``, or None where there is none; and the drives in its order."""
    drives = [drive for drive in _drives(structure, actuators, written) if drive is not None]
    if not drives:
        return None, []
    section = etree.Element("actuator")
    for drive in drives:
        section.append(_element(structure, drive))
    return section, drives


def _drives(structure: Structure, actuators: Actuators, written: Written) -> Iterator[Drive]:
    said = dict(_described(structure.robot, written)) if actuators == "auto" else {}
    for joint in structure.moving:
        if structure.kind(joint) not in ("hinge", "slide") or locked_at(joint) is not None:
            continue
        if actuators == "auto":
            if joint.name in said:
                kind, reduction = said[joint.name]
                yield Drive(joint, kind, reduction)
        elif actuators != "none" and not follows(structure, joint):
            yield Drive(joint, actuators)


def _described(robot: Robot, written: Written) -> Iterator[tuple[str, tuple[str, float]]]:
    """What drives each joint by name, as far as the description says; the last holds."""
    for name, kind in plugin_drives(robot).items():
        yield name, (kind, 1.0)
    for transmission in robot.transmissions:
        reductions = [a.mechanical_reduction for a in transmission.actuators]
        reduction = next((r for r in reductions if r), 1.0)
        for joint in transmission.joints:
            if joint.name not in robot.joint:
                written.lose(
                    "transmission",
                    f"transmission '{transmission.name}' is of joint '{joint.name}', which "
                    "does not exist",
                    joint.place,
                    kind="transmission",
                    name=transmission.name,
                )
                continue
            names = [*joint.hardware_interfaces]
            names += [name for a in transmission.actuators for name in a.hardware_interfaces]
            kind = _kind(names)
            if "simple" not in transmission.type.lower() and transmission.type:
                written.lose(
                    "transmission",
                    f"transmission '{transmission.name}' of type {transmission.type} is written as "
                    "one actuator a joint",
                    transmission.place,
                    kind="transmission",
                    name=transmission.name,
                )
            yield joint.name, (kind, reduction if kind == "motor" else 1.0)
    for block in robot.ros2_controls:
        for component in block.joints:
            names = [interface.name for interface in component.command_interfaces]
            if names and component.name in robot.joint:
                yield component.name, (_kind(names), 1.0)


def _kind(interfaces: list[str]) -> str:
    """The kind of actuator for a joint's hardware interfaces; the first that is known counts."""
    for name in interfaces:
        for interface in INTERFACES:
            if interface in name.lower().rpartition("/")[2]:
                return "motor" if interface == "effort" else interface
    return "motor"


def _element(structure: Structure, drive: Drive) -> etree._Element:
    joint, kind = drive.joint, structure.kind(drive.joint)
    effort = effort_of(joint)
    element = etree.Element(drive.kind, name=joint.name, joint=joint.name)
    if drive.kind == "position":
        gain = effort * POSITION_GAIN[kind] if effort else PLAIN_GAIN["position"][kind]
        element.set("kp", number_text(gain))
        element.set("dampratio", "1")
        limits = bounds(joint)
        if limits is not None and limits[0] < limits[1]:
            element.set("inheritrange", "1")
    elif drive.kind == "velocity":
        velocity = abs(joint.limit.velocity or 0.0) if joint.limit is not None else 0.0
        gain = PLAIN_GAIN["velocity"][kind]
        if effort and velocity:
            gain = effort * VELOCITY_GAIN / velocity
        element.set("kv", number_text(gain))
        if velocity:
            element.set("ctrlrange", numbers_text((-velocity, velocity)))
    else:
        if drive.reduction != 1.0:
            element.set("gear", number_text(drive.reduction))
        if effort:
            bound = effort / abs(drive.reduction)
            element.set("ctrlrange", numbers_text((-bound, bound)))
    return element
