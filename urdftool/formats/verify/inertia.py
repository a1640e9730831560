"""Comparison of the mass properties of bodies."""

from __future__ import annotations

import math

import numpy as np

from ...mechanics.tensor import get_noise
from ...model.elements import Link
from ..mechanics import Array, compute_mass_properties
from .bodies import Bodies, Body
from .difference import Comparison, Difference
from .frames import format_vector
from .pair import Match, Pair, locate

Properties = tuple[float, Array, Array]


def compare_inertia(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Compare mass, center of mass and tensor: link by link, or of the whole body.

    Links without a counterpart that has mass are combined with the body, so that merged links
    cause no difference.
    """
    one, two = (
        _list_massive(pair.a, match.one, np.eye(4)),
        _list_massive(pair.b, match.two, match.frame),
    )
    names = {x: pair.links.get(x, x) for x in one}
    if set(names.values()) == set(two):
        for x, y in names.items():
            links = pair.a.robot.link[x], pair.b.robot.link[y]
            frames = match.one.members[x], match.frame @ match.two.members[y]
            _compare_properties(links, frames, (one[x], two[y]), comparison)
        return
    total = _combine(one), _combine(two)
    top = pair.a.robot.link[match.one.name], pair.b.robot.link[match.two.name]
    before = len(comparison.differences)
    trial = Comparison(comparison.rows)
    origin = np.eye(4)
    _compare_properties(top, (origin, origin), total, trial)
    if trial.is_equal:
        comparison.worst |= {
            row: max(worst, comparison.worst.get(row, 0.0)) for row, worst in trial.worst.items()
        }
        return
    for x, y in names.items():
        if y in two:
            links = pair.a.robot.link[x], pair.b.robot.link[y]
            frames = match.one.members[x], match.frame @ match.two.members[y]
            _compare_properties(links, frames, (one[x], two[y]), comparison)
    _add_unmatched(pair, match, one, two, comparison)
    if len(comparison.differences) == before:
        _compare_properties(top, (origin, origin), total, comparison)


def _add_unmatched(
    pair: Pair,
    match: Match,
    one: dict[str, Properties],
    two: dict[str, Properties],
    comparison: Comparison,
) -> None:
    """Record links with mass that the body of only one robot has."""
    top = pair.a.robot.link[match.one.name], pair.b.robot.link[match.two.name]
    known = {pair.links.get(x, x) for x in one}
    for x, (mass, _, _) in one.items():
        name = pair.links.get(x, x)
        if name not in two:
            link, other = pair.a.robot.link[x], pair.b.robot.link.get(name) or top[1]
            places = locate(link.inertial, link), locate(other.inertial, other)
            names = x, other.name
            values: tuple[object, object] = mass, None
            comparison.add(Difference("mass", "link", names, "mass", values, "kg", 1.0, places))
    for y, (mass, _, _) in two.items():
        if y not in known:
            link, other = pair.b.robot.link[y], pair.a.robot.link.get(y) or top[0]
            places = locate(other.inertial, other), locate(link.inertial, link)
            values = None, mass
            names = other.name if other.name == y else "", y
            comparison.add(Difference("mass", "link", names, "mass", values, "kg", 1.0, places))


def _list_massive(bodies: Bodies, body: Body, frame: Array) -> dict[str, Properties]:
    """Return mass [kg], center [m] and tensor [kg·m²] of the links that have any, by name."""
    found = {}
    for name, pose in body.members.items():
        properties = compute_mass_properties(bodies.robot.link[name], frame @ pose)
        if properties is not None:
            found[name] = properties
    return found


def _combine(parts: dict[str, Properties]) -> Properties:
    """Return the properties of a rigid body of several parts."""
    mass = math.fsum(part[0] for part in parts.values())
    tensor, com = np.zeros((3, 3)), np.zeros(3)
    if mass:
        com = sum((m * c for m, c, _ in parts.values()), np.zeros(3)) / mass
    for m, c, inertia in parts.values():
        arm = c - com
        tensor += inertia + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass, com, tensor


def _compare_properties(
    links: tuple[Link, Link],
    frames: tuple[Array, Array],
    values: tuple[Properties, Properties],
    comparison: Comparison,
) -> None:
    """Compare the properties of a link, which are in the frame of the first body.

    Args:
        links: The link in both robots.
        frames: Their frames, 4 × 4.
        values: Their properties.
        comparison: Where differences are recorded.
    """
    (mass, com, tensor), (mass2, com2, tensor2) = values
    names = links[0].name, links[1].name
    places = (
        locate(links[0].inertial, links[0]),
        locate(links[1].inertial, links[1]),
    )
    larger = max(mass, mass2)
    relative = abs(mass - mass2) / larger if larger else abs(mass - mass2)
    percent = f"{100 * (mass2 / mass - 1):+.3g} %" if mass else ""
    comparison.add(
        Difference("mass", "link", names, "mass", (mass, mass2), "kg", relative, places, percent)
    )
    distance = float(np.linalg.norm(com - com2)) if mass and mass2 else 0.0
    local = [
        format_vector(frame[:3, :3].T @ (point - frame[:3, 3]))
        for frame, point in zip(frames, (com, com2), strict=True)
    ]
    comparison.add(
        Difference(
            "center of mass",
            "link",
            names,
            "center of mass",
            (local[0], local[1]),
            "m",
            distance,
            places,
            f"{distance * 1000:.4g} mm apart",
        )
    )
    size = max(abs(np.trace(tensor)), abs(np.trace(tensor2)))
    if mass and mass2:  # that of another mass differs with it, which is one difference
        tensor2 = tensor2 * (mass / mass2) if relative > 1e-12 else tensor2
        size = max(abs(np.trace(tensor)), abs(np.trace(tensor2)))
    size = max(size, 3 * get_noise(larger))
    spread = float(np.abs(tensor - tensor2).max()) / size if size else 0.0
    texts = [
        _format_tensor(f[:3, :3].T @ t @ f[:3, :3])
        for f, t in zip(frames, (values[0][2], values[1][2]), strict=True)
    ]
    comparison.add(
        Difference(
            "inertia",
            "link",
            names,
            "inertia",
            (texts[0], texts[1]),
            "kg·m²",
            spread,
            places,
            f"{100 * spread:.3g} % of the trace",
        )
    )


def _format_tensor(tensor: Array) -> str:
    """Format xx xy xz yy yz zz."""
    return format_vector(tensor[np.triu_indices(3)])
