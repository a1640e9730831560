"""Check the support of a robot at rest: its support polygon, and contacts of wheels and feet."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...diagnostic import Severity
from ...listing import quote_first
from ...model.elements import Robot
from ...rules.gazebo.contact import get_contact_role
from ..fault import Fault
from ..recording import GROUND, Contact
from ..run import Run
from ..shapes import compute_lowest_height
from .final_state import FinalState


def check_support(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    """Report a robot at rest without support, or supported by links other than wheels or feet."""
    bodies = run.bodies
    if (
        bodies.fixed_base
        or state.fell
        or state.settled is None
        or state.tilt > run.thresholds.tip_tilt
    ):
        return
    if not bodies.bodies[0].mass:
        return  # no-mass is reported; engines fix such a root in the air
    yield from _report_unsupported(robot, run, state)
    yield from _report_wheels_in_the_air(robot, run, state)
    yield from _report_body_on_ground(robot, run)


def _report_unsupported(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    """Report a robot at rest that the ground does not carry within the support polygon."""
    bounds = run.thresholds
    weight = run.settings.gravity * math.fsum(body.weight[0] for body in run.bodies.bodies)
    weight *= math.cos(run.settings.slope)  # what presses on the ground
    carried = run.recording.carried
    least = max(bounds.support_margin * run.bodies.size, bounds.support_margin_min)
    root = robot.link[run.bodies.bodies[0].name]
    names = quote_first(_list_supporting_links(run), 4)
    inner = _list_internal_overlaps(run)
    if weight <= 0:
        what = "no gravity acts on the robot, so the ground does not carry it"
        why = "the description turns gravity off, or compensates for it, at each link with mass"
    elif carried < bounds.carried_weight * weight:
        what = f"the ground carries only {carried:.3g} N of the robot's weight of {weight:.3g} N"
        what += " across the slope" * (run.settings.slope > 0)
    elif state.margin is not None and state.margin < -least:
        what = f"the center of mass is {-1000 * state.margin:.0f} mm outside the support polygon"
        what += f" of {names}"
    else:
        return
    if weight > 0 and inner:
        pairs = ", ".join(f"'{c.one}' and '{c.other}' ({1000 * c.depth:.0f} mm)" for c in inner[:3])
        why = f"contacts inside the robot carry it: {pairs} overlap"
    elif weight > 0:
        why = "this state is not physical; compare with another --engine or a smaller --timestep"
    yield Fault("unsupported", Severity.ERROR, what, root.place, "link", root.name, why)


def _list_internal_overlaps(run: Run) -> list[Contact]:
    """List the interpenetrations of links with contacts enabled, the deepest first."""
    if not run.settings.self_collision:
        return []
    found = [c for c in run.recording.contacts if c.other != GROUND and c.depth > 0]
    return sorted(found, key=lambda contact: -contact.depth)


def _list_supporting_links(run: Run) -> list[str]:
    """List the links that carried the robot at the end, in the order of the file."""
    touching = {contact.one for contact in run.recording.carrying}
    return [name for body in run.bodies.bodies for name in body.links if name in touching]


def _find_wheels_and_feet(robot: Robot, run: Run, role: str) -> dict[int, str]:
    """Find the bodies that are a wheel or a foot, each with the link that makes contact."""
    found: dict[int, str] = {}
    for number, body in enumerate(run.bodies.bodies):
        for name in body.links if number else ():
            if get_contact_role(robot, robot.link[name]) == role:
                found.setdefault(number, name)
    return found


def _report_wheels_in_the_air(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    wheels = _find_wheels_and_feet(robot, run, "wheel")
    carrying = _list_supporting_links(run)
    numbers = {run.start.get_body(name) for name in carrying}
    if len(wheels) < run.thresholds.supporting_parts or numbers & set(wheels) or not carrying:
        return
    name = next(iter(wheels.values()))
    height = min(_compute_height(run, number) for number in wheels)
    yield Fault(
        "wheels-off-ground",
        Severity.ERROR,
        f"no wheel carries the robot, which rests on {quote_first(carrying, 4)}",
        robot.link[name].place,
        "link",
        name,
        f"the lowest wheel is {1000 * max(0.0, height):.1f} mm above the ground: the robot cannot "
        "drive; lower the wheels, or raise what it rests on",
        "caster-height-mismatch",
    )


def _compute_height(run: Run, number: int) -> float:
    """Compute the height of a body's lowest point [m]."""
    pose = run.end.get_pose(number)
    shapes = run.bodies.bodies[number].shapes
    return compute_lowest_height(shapes, np.array(pose.rotation), np.array(pose.translation))


def _report_body_on_ground(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report a chassis or trunk on the ground, of a robot with wheels or feet."""
    wheels, feet = (_find_wheels_and_feet(robot, run, role) for role in ("wheel", "foot"))
    carrying = set(_list_supporting_links(run))
    on_wheels = {run.start.get_body(name) for name in carrying} & set(wheels)
    if (
        not (len(wheels) >= run.thresholds.supporting_parts and on_wheels)
        and len(feet) < run.thresholds.supporting_parts
    ):
        return
    root = run.bodies.bodies[0]
    for name in root.links:
        if name not in carrying or get_contact_role(robot, robot.link[name]):
            continue
        if all(shape.kind == "sphere" for shape in root.shapes if shape.link == name):
            continue  # a caster
        what = "wheels" if on_wheels else "feet"
        yield Fault(
            "body-on-ground",
            Severity.INFO,
            f"link '{name}' of the body rests on the ground in addition to the {what}",
            robot.link[name].place,
            "link",
            name,
            "its collision geometry reaches as low as the wheels; raise it, or add a caster"
            if on_wheels
            else "the legs do not lift it at the initial joint positions; change them with --pose",
        )
        return
