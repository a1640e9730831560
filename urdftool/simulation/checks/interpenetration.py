"""Check interpenetration of links: at the start, at rest, and while joints are swept."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...diagnostic import Severity
from ...model.elements import Robot
from ..fault import Fault
from ..overlap import measure_penetration_depth
from ..recording import GROUND, Array, Contact
from ..rigid_bodies import RigidBody
from ..run import Run
from ..state import StateSnapshot
from .mechanism import find_mechanism
from .misplaced_collision import explain_misplaced_collision


def get_overlap_depth(start: StateSnapshot) -> float:
    """Return the least penetration depth that is reported [m]."""
    bounds = start.thresholds
    return max(bounds.overlap_depth * start.bodies.size, bounds.contact_depth)


def precompute_overlaps(robot: Robot, start: StateSnapshot) -> None:
    """Compute and store the results that :func:`check_interpenetration` needs of a start."""
    for contact in start.contacts:
        if contact.other != GROUND and contact.depth >= get_overlap_depth(start):
            depth = _measure_depth(robot, start, start, contact)
            _choose_misplaced(robot, start, start, contact)
            if depth >= get_overlap_depth(start) and not _are_joined(start, contact):
                _name_mechanism(robot, start, contact)


def check_interpenetration(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report links that interpenetrate at the start, or at the end only."""
    bodies = run.bodies.bodies
    least = get_overlap_depth(run.start)
    at_start = {_pair(contact) for contact in run.start.contacts}
    new = [contact for contact in run.end.contacts if _pair(contact) not in at_start]
    contacts = [(run.start, contact) for contact in run.start.contacts]
    contacts += [(run.end, contact) for contact in new]
    blamed = set()
    for snapshot, contact in contacts:
        if contact.other == GROUND or contact.depth < least:
            continue
        depth = _measure_depth(robot, run.start, snapshot, contact)
        if depth < least:
            continue
        misplaced = _choose_misplaced(robot, run.start, snapshot, contact)
        if misplaced is not None:
            if misplaced[0] in blamed:
                continue  # it interpenetrates another neighbor for the same reason
            blamed.add(misplaced[0])
        joined = _are_joined(run.start, contact)
        numbers = run.start.get_body(contact.one), run.start.get_body(contact.other)
        thin = min(_measure_extents(bodies[number]).min() for number in numbers)
        brought = "" if joined or snapshot is run.start else _name_moving_joint(run, numbers)
        fails = misplaced is not None or bool(
            not joined and depth > run.thresholds.overlap_failure * thin and not brought
        )
        mechanism = ""
        if fails and misplaced is None:
            mechanism = _name_mechanism(robot, run.start, contact)
            fails = not mechanism
        when = "at the start" if snapshot is run.start else "at rest"
        named = misplaced[0] if misplaced else contact.one
        yield Fault(
            "interpenetration",
            _get_severity(fails, joined),
            f"links '{contact.one}' and '{contact.other}' interpenetrate by {depth:.3g} m {when}",
            (robot.link[named].collisions[0] if misplaced else robot.link[named]).place,
            "link",
            named,
            misplaced[1]
            if misplaced
            else _explain_why_ignored(run, numbers)
            if joined
            else brought
            or mechanism
            or "their collision geometry is too large or misplaced, or this pose is in collision",
            "collision-off-visual" if fails else "",
        )


def _get_severity(fails: bool, joined: bool) -> Severity:
    """Return the severity of an overlap; that of joined links moves nothing: engines ignore it."""
    if not fails:
        return Severity.INFO
    return Severity.WARNING if joined else Severity.ERROR


def _name_mechanism(robot: Robot, start: StateSnapshot, contact: Contact) -> str:
    """Name the mechanism that two links belong to; empty if none."""
    links = contact.one, contact.other
    numbers = start.get_body(contact.one), start.get_body(contact.other)
    return start.get_or_compute(
        ("mechanism", *links),
        lambda: find_mechanism(robot, start, links, _list_between(start, numbers)),
    )


def _explain_why_ignored(run: Run, numbers: tuple[int, int]) -> str:
    """Explain why physics engines ignore, or report, a contact of links that share a joint."""
    count = len(_list_between(run.start, numbers))
    if count < 2:
        return "the links share a joint, so physics engines ignore this contact"
    if run.settings.self_collision:
        return f"{count} joints connect the links, so --self-collision pushes them apart"
    return (
        f"{count} joints connect the links; physics engines push them apart if self-collision is "
        "enabled"
    )


def _name_moving_joint(run: Run, numbers: tuple[int, int]) -> str:
    """Name the joint whose motion made two bodies overlap; empty if none did."""
    moved = run.recording.positions[-1] - run.recording.positions[0]
    columns = [number - 1 for number in _list_between(run.start, numbers)]
    far = [
        column for column in columns if abs(moved[column]) > _compute_overlap_motion(run, column)
    ]
    if not far or run.settings.self_collision:
        return ""
    most = max(far, key=lambda column: abs(float(moved[column])))
    return (
        f"caused by joint '{run.recording.joints[most]}' moving to "
        f"{run.recording.positions[-1, most]:.3g}; use --self-collision to enable contacts between "
        "links"
    )


def _compute_overlap_motion(run: Run, column: int) -> float:
    bounds, joint = run.thresholds, run.bodies.joints[column]
    return bounds.overlap_slide if joint.kind == "prismatic" else bounds.overlap_turn


def _measure_depth(
    robot: Robot, start: StateSnapshot, snapshot: StateSnapshot, contact: Contact
) -> float:
    """Measure the penetration depth of two links by the triangles of their meshes [m].

    A depth that is not reported may be 0.
    """
    least = get_overlap_depth(start)
    if _are_joined(start, contact):
        return contact.depth
    links = contact.one, contact.other
    depth = snapshot.get_or_compute(
        ("overlap", *links), lambda: measure_penetration_depth(robot, snapshot, *links, least)
    )
    return contact.depth if depth is None else min(depth, contact.depth)


def _choose_misplaced(
    robot: Robot, start: StateSnapshot, snapshot: StateSnapshot, contact: Contact
) -> tuple[str, str] | None:
    """Choose the one of two joined links whose collision geometry is misplaced, with the reason."""
    if not _are_joined(start, contact):
        return None

    def look() -> tuple[str, str] | None:
        for link, other in ((contact.one, contact.other), (contact.other, contact.one)):
            why = explain_misplaced_collision(robot, snapshot, link, snapshot.get_body(other))
            if why is not None:
                return link, why
        return None

    return snapshot.get_or_compute(("misplaced", contact.one, contact.other), look)


def _are_joined(start: StateSnapshot, contact: Contact) -> bool:
    """Tell whether two bodies share a joint, or several at one place (universal, ball).

    Such parts overlap around their joint by design.
    """
    numbers = start.get_body(contact.one), start.get_body(contact.other)
    return start.get_or_compute(("joined", *numbers), lambda: _has_common_joint(start, numbers))


def _list_between(start: StateSnapshot, numbers: tuple[int, int]) -> list[int]:
    """List the bodies whose joints are between two bodies."""
    bodies = start.bodies.bodies
    above: list[list[int]] = []
    for number in numbers:
        chain = [number]
        while bodies[chain[-1]].parent >= 0:
            chain.append(bodies[chain[-1]].parent)
        above.append(chain)
    common = next(index for index in above[0] if index in above[1])
    return [index for chain in above for index in chain[: chain.index(common)]]


def _has_common_joint(start: StateSnapshot, numbers: tuple[int, int]) -> bool:
    bodies = start.bodies.bodies
    path = _list_between(start, numbers)
    between = {*path, *(bodies[index].parent for index in path)} - set(numbers)
    if not any(bodies[index].shapes for index in between):
        return True
    places = start.poses[path, :3]
    distance = float(np.linalg.norm(places.max(axis=0) - places.min(axis=0)))
    smaller = min(_measure_extents(bodies[number]).max() for number in numbers)
    return bool(distance < start.thresholds.compound_joint * smaller)


def _measure_extents(body: RigidBody) -> Array:
    """Measure the edges of the bounding box of the collision geometry of a body [m], shape (3,)."""
    boxes = [shape.get_bounds() for shape in body.shapes]
    low = np.min([low for low, _ in boxes], axis=0)
    high = np.max([high for _, high in boxes], axis=0)
    edges: Array = high - low
    return edges


def _pair(contact: Contact) -> frozenset[str]:
    return frozenset((contact.one, contact.other))


def check_sweep(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report links that interpenetrate while a joint moves through its limits."""
    least = get_overlap_depth(run.start)
    for joint in run.swept:
        hits = sorted((hit for hit in joint.hits if hit.depth > least), key=lambda hit: -hit.depth)
        if not hits:
            continue
        hit = hits[0]
        more = f" (and {len(hits) - 1} more pairs)" if len(hits) > 1 else ""
        part = robot.joint[joint.joint]
        yield Fault(
            "blocked",
            Severity.INFO,
            f"limits of joint '{joint.joint}' are {joint.lower:.3g} to {joint.upper:.3g}, but only "
            f"{joint.free_lower:.3g} to {joint.free_upper:.3g} is free of collision; beyond it, "
            f"links '{hit.one}' and '{hit.other}' interpenetrate{more}",
            (part.limit or part).place,
            "joint",
            joint.joint,
            "the limits exceed the collision-free range (measured on convex hulls), or a collision "
            "shape is too large",
        )
