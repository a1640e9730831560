"""Bodies without the physics that a simulation lives on, whatever the engine made of them."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..model.elements import Link, Robot
from .bodies import Bodies, Body, mass_of
from .extent import Extent, extent_of
from .fault import Fault
from .recording import Array
from .run import Run
from .urdf import ROUNDED

REACH = 1.2
"""How far out a link's mass may sit on average, as a part of how far its shapes reach."""

FAR_OUT = 3.0
"""The same of a link so light that its inertia hardly matters."""

DENSEST = 12_000.0
"""Denser than lead [kg/m³]."""

LARGEST = 30.0
"""A part larger than this, on a robot of smaller parts, is in millimetres [m]."""

_THIN = 1.0  # kg/m³, a bit less than air
_SHARE = 0.5
_HOLLOW = 100.0  # kg/m³: a rigid body lighter than this lacks the mass of a part
_HEAVY = 0.1
_LIGHT = 0.02  # of the robot's mass: what is lighter stands for a camera or a frame


def judge_bodies(robot: Robot, run: Run) -> Iterator[Fault]:
    """What is missing or impossible in the file."""
    bodies = run.bodies
    if not any(body.shapes for body in bodies.bodies):
        yield Fault(
            "nothing-touches",
            "no link has a <collision>: nothing of the robot can touch the floor",
            robot.place,
            cause="give each link a <collision>",
            rule="missing-collision",
        )
    yield from _massless(robot, bodies)
    told = set()
    for number, body in enumerate(bodies.bodies):
        if number == 0 and bodies.nailed:
            continue
        yield from _unweighed(robot, body)
        if body.properties is not None and _is_impossible(body.properties.inertia):
            told.add(body.name)
            yield from _tensor(robot, body)
        for name in body.links:
            yield from _size(robot, robot.link[name], run)
    yield from _giants(robot, bodies)
    for difference in run.recording.read_back:
        if difference.name in told:
            continue
        part = robot.link.get(difference.name) or robot.joint.get(difference.name)
        yield Fault(
            "read-otherwise",
            f"{difference.what} of {difference.kind} '{difference.name}' is {difference.said} in "
            f"the file, and the engine took {difference.got}",
            None if part is None else part.place,
            difference.kind,
            difference.name,
        )


def _massless(robot: Robot, bodies: Bodies) -> Iterator[Fault]:
    loads = {body.parent for body in bodies.bodies if body.mass}
    moving = []
    for number, body in enumerate(bodies.bodies):
        if body.mass or (number == 0 and bodies.nailed):
            continue
        if number == 0:
            yield Fault(
                "no-mass",
                f"the root, link '{body.name}', weighs nothing",
                robot.link[body.name].place,
                "link",
                body.name,
                "it has no <inertial> with a mass; PyBullet nails such a root to the world, Gazebo "
                "drops it: give it one, or nail it down with --fixed-base",
                "massless-root-body",
            )
        elif body.shapes or not _is_empty(bodies, number, loads):
            moving.append(body.name)
    if moving:
        more = f" and {len(moving) - 1} more" if len(moving) > 1 else ""
        yield Fault(
            "no-mass",
            f"link '{moving[0]}'{more} on a moving joint weighs nothing",
            robot.link[moving[0]].place,
            "link",
            moving[0],
            "it has no <inertial> with a mass; engines drop it, or invent a mass",
            "massless-moving-body",
        )


def _is_empty(bodies: Bodies, number: int, loads: set[int]) -> bool:
    """Whether a body is a mere frame: it carries nothing that weighs, so that nothing is moved."""
    return number not in loads and not bodies.bodies[number].shapes


def _unweighed(robot: Robot, body: Body) -> Iterator[Fault]:
    """A link that is most of its body, and has no mass: the others cannot stand for it."""
    without = [name for name in body.links if not robot.link[name].mass]
    if not body.mass or not without:
        return
    extents = {name: extent_of(robot, name) for name in body.links if _has_shapes(robot, name)}
    whole = sum(extent.volume for extent in extents.values())
    for name in without:
        large = name in extents and extents[name].volume > _SHARE * whole > 0
        if large and body.mass < _HOLLOW * whole:
            yield Fault(
                "no-mass",
                f"link '{name}' is most of its rigid body and weighs nothing; the rest weighs "
                f"{body.mass:.3g} kg",
                robot.link[name].place,
                "link",
                name,
                "it has a shape and no <inertial> with a mass",
                "missing-inertial",
            )


def _has_shapes(robot: Robot, name: str) -> bool:
    return bool(robot.link[name].collisions or robot.link[name].visuals)


def _is_impossible(tensor: Array) -> bool:
    low, middle, high = np.linalg.eigvalsh(tensor).tolist()
    possible: bool = low >= -1e-9 * abs(high) and 0 < high <= (low + middle) * (1 + ROUNDED)
    return not possible


def _tensor(robot: Robot, body: Body) -> Iterator[Fault]:
    """The link that makes the tensor of its body impossible."""
    bad = [
        link
        for link in (robot.link[name] for name in body.links)
        if (own := mass_of(link)) is not None and _is_impossible(own.inertia)
    ]
    link = max(bad, key=lambda link: link.mass) if bad else robot.link[body.name]
    own = mass_of(link)
    tensor = own.inertia if bad and own is not None else np.zeros((3, 3))
    low, middle, high = np.linalg.eigvalsh(tensor).tolist()
    if high <= 0 and low >= 0:
        said = f"is zero, and it weighs {body.mass:.4g} kg"
        why = "nothing resists its turning; PyBullet then never turns it"
        rule = "zero-inertia"
    elif low < -1e-9 * abs(high):
        said = f"has a principal moment of {low:.3g} kg·m²"
        why = "every principal moment is above zero; PyBullet takes such a tensor for zero"
        rule = "inertia-not-positive-definite"
    else:
        said = f"breaks the triangle inequality: {high:.3g} > {low:.3g} + {middle:.3g} kg·m²"
        why = "no body has such a tensor; PyBullet takes it for zero, and the link does not turn"
        rule = "inertia-triangle-inequality"
    part = link.inertial.inertia or link.inertial if link.inertial is not None else link
    yield Fault(
        "impossible-inertia",
        f"the inertia of link '{link.name}' {said}",
        part.place,
        "link",
        link.name,
        why,
        rule,
    )


def _size(robot: Robot, link: Link, run: Run) -> Iterator[Fault]:
    """Mass and inertia that no shape of this size could have."""
    own = mass_of(link)
    if own is None or link.inertial is None:
        return
    share = own.mass / run.bodies.mass
    if not _has_shapes(robot, link.name) and share < _HEAVY:
        return
    spread = math.sqrt(max(0.0, float(np.trace(own.inertia)) / 2 / own.mass))
    extent = _around(robot, link, run, only_collisions=True)
    if _fits(extent, spread, own.mass, own.com):
        return
    extent = _around(robot, link, run)
    reach = extent.reach(own.com)
    matters = share > _LIGHT or _rules(own.inertia, link.name, run)
    if reach and matters and spread > (REACH if share > _LIGHT else FAR_OUT) * reach:
        yield Fault(
            "inertia-too-large",
            f"the inertia of link '{link.name}' is that of mass {spread:.3g} m from its centre; "
            f"its shapes reach {reach:.3g} m",
            (link.inertial.inertia or link.inertial).place,
            "link",
            link.name,
            "a tensor of ones, or of other units; the link turns far too slowly",
            "inertia-exceeds-geometry",
        )
    if share > _LIGHT and extent.volume and own.mass > DENSEST * extent.volume:
        yield Fault(
            "too-dense",
            f"link '{link.name}' weighs {own.mass:.4g} kg, {own.mass / extent.volume:,.0f} kg/m³ "
            "of its shapes",
            link.inertial.place,
            "link",
            link.name,
            "lead is lighter: its mass is in grams, or its shapes in another unit",
            "implausible-density",
        )


def _rules(tensor: Array, name: str, run: Run) -> bool:
    """Whether a light link's tensor is most of its rigid body's all the same."""
    body = next(body for body in run.bodies.bodies if name in body.links)
    assert body.properties is not None
    return bool(np.trace(tensor) > _SHARE * np.trace(body.properties.inertia))


def _around(robot: Robot, link: Link, run: Run, *, only_collisions: bool = False) -> Extent:
    """The extent of a link; of one without shapes, that of its rigid body, in its own frame."""
    if _has_shapes(robot, link.name):
        return extent_of(robot, link.name, only_collisions=only_collisions)
    body = next(body for body in run.bodies.bodies if link.name in body.links)
    back = body.places[link.name].inverse()
    found = []
    for name in body.links:
        extent = extent_of(robot, name, only_collisions=only_collisions)
        pose = back @ body.places[name]
        points = extent.points @ np.array(pose.rotation).T + np.array(pose.translation)
        found.append(Extent(points, extent.volume))
    return Extent(
        np.concatenate([extent.points for extent in found]),
        sum(extent.volume for extent in found),
    )


def _fits(extent: Extent, spread: float, mass: float, com: Array) -> bool:
    reach = extent.reach(com)
    return spread <= REACH * reach and mass <= DENSEST * extent.volume


def _giants(robot: Robot, bodies: Bodies) -> Iterator[Fault]:
    sizes: dict[str, list[float]] = {}
    for body in bodies.bodies:
        for shape in body.shapes:
            low, high = shape.bounds()
            sizes.setdefault(shape.link, []).append(float((high - low).max()))
    largest = {name: max(found) for name, found in sizes.items()}
    for name, size in largest.items():
        others = [value for other, value in largest.items() if other != name]
        link = robot.link[name]
        volume = extent_of(robot, name, only_collisions=True).volume
        thin = link.mass and volume and link.mass / volume < _THIN
        if size > LARGEST and (thin or (others and size > 30 * float(np.median(others)))):
            yield Fault(
                "too-large",
                f"a collision of link '{name}' is {size:,.0f} m large",
                link.collisions[0].place,
                "link",
                name,
                'its mesh is in millimetres; scale it with <mesh scale="0.001 0.001 0.001">',
                "mesh-in-millimetres",
            )
