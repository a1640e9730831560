"""The robot that a stage holds: the source with every choice of the export."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from ...model.elements import Joint, Limit, Robot
from ...model.mechanism import Base, Configuration, ContactExclusion, JointActuator
from .bodies import Bodies
from .joint_values import JointValues, get_own_values


def make_planned(
    bodies: Bodies,
    values: Mapping[str, JointValues],
    home: Mapping[str, float],
    pairs: Iterable[tuple[str, str]],
) -> Robot:
    """Return the robot with the chosen base, home, values and drives of joints, contact pairs."""
    robot = bodies.robot
    origin = None if robot.base is None else robot.base.origin
    return replace(
        robot,
        base=Base(robot.provenance, bodies.free, origin),
        joints=[_set_values(joint, values.get(joint.name)) for joint in robot.joints],
        joint_actuators=list(_make_drives(robot, values)),
        configurations=[Configuration(robot.provenance, "home", dict(home))],
        exclusions=list(_make_exclusions(bodies, pairs)),
    )


def _set_values(joint: Joint, values: JointValues | None) -> Joint:
    """Return a joint with the values that are not those of the description."""
    if values is None:
        return joint
    own = get_own_values(joint)
    joint = joint.replace_resistance({
        name: value for name, value in values.resistance.items() if value != own.resistance[name]
    })  # fmt: skip
    if values.effort != own.effort:
        unlimited = Limit(joint.provenance, -math.inf, math.inf)  # no bound that is missing is 0
        limit = replace(joint.limit or unlimited, effort=values.effort)
        joint = replace(joint, limit=limit)
    return joint


def _make_drives(robot: Robot, values: Mapping[str, JointValues]) -> Iterator[JointActuator]:
    """Yield the drives with gains; one without applies the commanded effort."""
    for joint in robot.joints:
        one = values.get(joint.name)
        if one is None or not (one.kp or one.kd):
            continue
        yield JointActuator(
            joint.provenance,
            joint.name,
            joint.name,
            "position" if one.kp else "velocity",
            gain=one.kp or one.kd,
            bias=(0.0, -one.kp, -one.kd),
            force_range=None if one.effort is None else (-one.effort, one.effort),
        )


def _make_exclusions(
    bodies: Bodies, pairs: Iterable[tuple[str, str]]
) -> Iterator[ContactExclusion]:
    """Yield the pairs of bodies of which links never collide, each once."""
    known: set[tuple[str, str]] = set()
    for one, other in pairs:
        first, second = sorted((bodies.carrier[one], bodies.carrier[other]))
        if first and second and first != second and (first, second) not in known:
            known.add((first, second))
            yield ContactExclusion(bodies.robot.provenance, first, second)
