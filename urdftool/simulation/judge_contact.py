"""What touches what should not, or does not touch what should."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..formats.mjcf.extent import shape_points
from ..model.elements import Box, Capsule, Cylinder, Geometry, Mesh, Robot, Sphere
from ..model.pose import pose_of
from .bodies import Body
from .fault import Fault
from .judge_rest import Rest
from .overlap import overlap, primitive_triangles
from .recording import GROUND, Array, Contact
from .run import Run, body_pose
from .shapes import lowest
from .strayed import strayed

SUNK = 0.01
"""How deep a robot at rest may be in the floor, as a part of its size."""

INTO = 0.005
"""How deep parts are in each other to be worth a word, as a part of the robot's size."""

THICK = 0.25
"""How deep they are for a fault, as a part of the thinner one's smallest extent."""

NEAR = 0.002
"""How near to the floor a part is that should touch it [m]."""

SHOWS = 0.001
"""How far what is seen of a foot sticks out of what touches beside it [m]."""

COMPACT = 0.5
"""How far apart joints may be that are one compound joint, as a part of the smaller body."""

_LEAST = 0.002  # m: hulls have a margin, and files are rounded


def judge_contacts(robot: Robot, run: Run, rest: Rest) -> Iterator[Fault]:
    """What is to be said of contacts."""
    yield from _in_the_floor(robot, run)
    yield from _in_each_other(robot, run)
    if not rest.fell and run.recording.ended != "lost":
        yield from _sunk(robot, run)
        told = {fault.name: fault for fault in _untouching(robot, run)}
        yield from told.values()
        yield from (f for f in _unlike(robot, run, rest) if f.name not in told)


def _deep(run: Run, part: float) -> float:
    return max(part * run.bodies.size, _LEAST)


def _in_the_floor(robot: Robot, run: Run) -> Iterator[Fault]:
    for contact in run.recording.start_contacts:
        if contact.other == GROUND and contact.depth > _deep(run, SUNK):
            if run.bodies.nailed and contact.one in run.bodies.bodies[0].links:
                continue
            yield Fault(
                "starts-in-floor",
                f"link '{contact.one}' starts {contact.depth:.3g} m deep in the floor",
                robot.link[contact.one].place,
                "link",
                contact.one,
                "the root is nailed to the world there"
                if run.bodies.nailed
                else "--height puts it there",
            )


def _sunk(robot: Robot, run: Run) -> Iterator[Fault]:
    grounded = [contact for contact in run.recording.contacts if contact.other == GROUND]
    deepest = max(grounded, key=lambda contact: contact.depth, default=None)
    if deepest is not None and deepest.depth > _deep(run, SUNK):
        yield Fault(
            "sank-in",
            f"link '{deepest.one}' sank {deepest.depth:.3g} m into the floor",
            robot.link[deepest.one].place,
            "link",
            deepest.one,
            "its contact is too soft (<kp>) or the robot too heavy for what it stands on",
            "missing-contact-parameters",
        )


def _in_each_other(robot: Robot, run: Run) -> Iterator[Fault]:
    bodies = {body.name: body for body in run.bodies.bodies}
    owner = {link: body.name for body in run.bodies.bodies for link in body.links}
    at_start = {_pair(contact) for contact in run.recording.start_contacts}
    blamed = set()
    for contact in (*run.recording.start_contacts, *run.recording.contacts):
        if contact.other == GROUND or contact.depth < _deep(run, INTO):
            continue
        starting = any(contact is other for other in run.recording.start_contacts)
        if not starting and _pair(contact) in at_start:
            continue
        adjacent = _are_joined(run, owner[contact.one], owner[contact.other])
        depth: float | None = None
        if not adjacent:
            depth = overlap(robot, run, 0 if starting else -1, contact.one, contact.other)
        if depth is not None and depth < _deep(run, INTO):
            continue
        depth = contact.depth if depth is None else min(depth, contact.depth)
        frame = 0 if starting else -1
        beside = _misplaced(robot, run, frame, contact) if adjacent else None
        if beside is not None:
            if beside[0] in blamed:
                continue  # it is in another neighbour, too, for the same reason
            blamed.add(beside[0])
        thin = min(_extents(bodies[owner[name]]).min() for name in (contact.one, contact.other))
        fails = beside is not None or bool(not adjacent and depth > THICK * thin)
        when = "at the start" if starting else "at rest"
        named = beside[0] if beside else contact.one
        yield Fault(
            "parts-collide",
            f"links '{contact.one}' and '{contact.other}' are {depth:.3g} m in each other {when}",
            (robot.link[named].collisions[0] if beside else robot.link[named]).place,
            "link",
            named,
            beside[1]
            if beside
            else "they are joined, so engines let them"
            if adjacent
            else "their collision shapes are too large or misplaced, or the pose is not free",
            "collision-off-visual" if fails else "",
            fails=fails,
        )


def _misplaced(robot: Robot, run: Run, frame: int, contact: Contact) -> tuple[str, str] | None:
    """Which of two joined links has a collision that is not where the link is, and why."""
    number = {link: index for index, body in enumerate(run.bodies.bodies) for link in body.links}
    for link, other in ((contact.one, contact.other), (contact.other, contact.one)):
        why = strayed(robot, run, frame, link, number[other])
        if why is not None:
            return link, why
    return None


def _are_joined(run: Run, one: str, other: str) -> bool:
    """Whether two bodies share a joint, or several in one place that make a universal or ball one.

    Such parts overlap around their joint by design.
    """
    bodies = run.bodies.bodies
    number = {body.name: index for index, body in enumerate(bodies)}
    above: list[list[int]] = []
    for name in (one, other):
        chain = [number[name]]
        while bodies[chain[-1]].parent >= 0:
            chain.append(bodies[chain[-1]].parent)
        above.append(chain)
    common = next(index for index in above[0] if index in above[1])
    path = [index for chain in above for index in chain[: chain.index(common)]]
    between = {*path, common} - {number[one], number[other]}
    if not any(bodies[index].shapes for index in between):
        return True
    places = run.recording.poses[0, path, :3]
    apart = float(np.linalg.norm(places.max(axis=0) - places.min(axis=0)))
    smaller = min(_extents(bodies[number[name]]).max() for name in (one, other))
    return bool(apart < COMPACT * smaller)


def _extents(body: Body) -> Array:
    """Edges of the box around what of a body touches [m], shape (3,)."""
    boxes = [shape.bounds() for shape in body.shapes]
    low = np.min([low for low, _ in boxes], axis=0)
    high = np.max([high for _, high in boxes], axis=0)
    edges: Array = high - low
    return edges


def _pair(contact: Contact) -> frozenset[str]:
    return frozenset((contact.one, contact.other))


def _untouching(robot: Robot, run: Run) -> Iterator[Fault]:
    """Moving bodies that are seen on the floor and have nothing to touch it with."""
    if not any(body.shapes for body in run.bodies.bodies):
        return  # nothing of it touches, which is said
    parents = {body.parent for body in run.bodies.bodies}
    for number, body in enumerate(run.bodies.bodies):
        seen = [name for name in body.links if robot.link[name].visuals]
        if not seen or (number == 0 and run.bodies.nailed):
            continue
        pose = body_pose(run, number)
        highest = NEAR
        if body.shapes:
            seen = [name for name in seen if not robot.link[name].collisions]
            highest = -_deep(run, SUNK)
            if number not in parents:  # a foot on the end of a leg, of which the rest may touch
                turn, at = np.array(pose.rotation), np.array(pose.translation)
                highest = min(NEAR, lowest(body.shapes, turn, at) - SHOWS)
        for name in seen:
            points = _seen(robot, name)
            if not len(points):
                continue
            place = pose @ body.places[name]
            heights = points @ np.array(place.rotation[2]) + place.translation[2]
            least = float(heights.min())
            if least < highest:
                where = "on" if least > -NEAR else f"{-least:.3g} m below"
                yield Fault(
                    "no-contact-shape",
                    f"link '{name}' is {where} the floor and has no <collision> to touch it with",
                    robot.link[name].place,
                    "link",
                    name,
                    "a wheel or foot that carries nothing; what is beside it does",
                    "missing-collision",
                )


def _unlike(robot: Robot, run: Run, rest: Rest) -> Iterator[Fault]:
    """Links that look like one on which the robot stands, and have nothing to stand on."""
    feet = {look: name for name in rest.supports if (look := _look(robot, name)) is not None}
    for body in run.bodies.bodies[1:]:
        for name in body.links:
            look = None if robot.link[name].collisions else _look(robot, name)
            twin = None if look is None else feet.get(look)
            if twin is not None:
                yield Fault(
                    "no-contact-shape",
                    f"link '{name}' has no <collision>, and '{twin}', which looks the same, stands "
                    "on the floor with one",
                    robot.link[name].place,
                    "link",
                    name,
                    "a wheel or foot that carries nothing; what is beside it does",
                    "missing-collision",
                )


def _look(robot: Robot, name: str) -> tuple[object, ...] | None:
    """What is seen of a link, to be compared with others; None where nothing is."""
    visuals = robot.link[name].visuals
    if not visuals:
        return None
    return tuple(_form(visual.geometry) for visual in visuals)


def _form(geometry: Geometry | None) -> tuple[object, ...]:
    if isinstance(geometry, Mesh):
        return geometry.filename, *(abs(factor) for factor in geometry.scale)
    if isinstance(geometry, Box):
        return ("box", *sorted(geometry.size))
    if isinstance(geometry, Sphere):
        return "sphere", geometry.radius
    if isinstance(geometry, (Cylinder, Capsule)):
        return "round", geometry.radius, geometry.length
    return (id(geometry),)


def _seen(robot: Robot, name: str) -> Array:
    """Points of what is seen of a link, in its frame: those of round shapes lie on them."""
    found = [np.zeros((0, 3))]
    for shape in robot.link[name].visuals:
        if isinstance(shape.geometry, (Cylinder, Sphere, Capsule)):
            pose = pose_of(shape.origin)
            corners = primitive_triangles(shape).reshape(-1, 3)
            found.append(corners @ np.array(pose.rotation).T + np.array(pose.translation))
        elif (points := shape_points(robot, shape)) is not None:
            found.append(points)
    return np.concatenate(found)
