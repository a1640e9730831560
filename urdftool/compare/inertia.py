"""Comparison of the mass properties of bodies."""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np

from ..mechanics.reference import Array, compute_mass_properties
from ..mechanics.tensor import get_noise
from ..model.elements import Link
from .bodies import Bodies, Body
from .difference import Comparison, Difference
from .frames import format_vector
from .pair import Match, Pair, locate
from .rows import Row

Properties = tuple[float, Array, Array]

_MASSLESS = 1e-9
"""Mass [kg] of a link up to which it is a placeholder, which simulators require."""


def compare_inertia(pair: Pair, match: Match, comparison: Comparison) -> None:
    """Compare mass, center of mass and tensor: link by link, or of several links together.

    Links that differ, or have no counterpart with mass, are combined on each side: links that were
    merged into one, or mass that was moved from one to another, cause no difference.
    """
    one, two = (
        _list_massive(pair.a, match.one, np.eye(4)),
        _list_massive(pair.b, match.two, match.frame),
    )
    names = {x: y for x in one if (y := pair.links.get(x, x)) in two}
    trials = {
        x: _compare_links(pair, match, (x, y), (one[x], two[y]), comparison)
        for x, y in names.items()
    }
    rest = {x: part for x, part in one.items() if x not in trials or not trials[x].is_equal}
    equal = {names[x] for x in trials if x not in rest}
    rest2 = {y: part for y, part in two.items() if y not in equal}
    for x, trial in trials.items():
        if x not in rest:
            comparison.merge(trial)
    if not rest and not rest2:
        return
    filled = _compare_with_placeholders(pair, match, len(one) + len(two), comparison)
    if filled is not None:
        comparison.merge(filled)
        return
    common = [x for x in names if x in rest]
    merged = _find_merged(pair, match, names, (rest, rest2), comparison)
    for x in common:
        if merged is not None and x != merged:
            comparison.merge(trials[x])
    if merged is not None:
        return
    total = _compare_rest(pair, match, common, rest, rest2, comparison)
    if total.is_equal or _is_merged(common, names, rest, rest2):
        comparison.merge(total)
        return
    whole = _compare_whole(pair, match, (one, two), (rest, rest2), comparison)
    if whole is not None:
        comparison.merge(whole)
        return
    before = len(comparison.differences)
    for x in common:
        comparison.merge(trials[x])
    _add_unmatched(pair, match, one, two, comparison)
    if len(comparison.differences) == before:
        comparison.merge(total)


def _compare_with_placeholders(
    pair: Pair, match: Match, count: int, comparison: Comparison
) -> Comparison | None:
    """Compare both bodies with their placeholders; None without any, or if they are not equal.

    Lumping adds the mass of a placeholder to another link.
    """
    one = _list_massive(pair.a, match.one, np.eye(4), least=0.0)
    two = _list_massive(pair.b, match.two, match.frame, least=0.0)
    if len(one) + len(two) == count:
        return None
    whole = _compare_rest(pair, match, [], one, two, comparison)
    return whole if whole.is_equal else None


def _find_merged(
    pair: Pair,
    match: Match,
    names: dict[str, str],
    rest: tuple[dict[str, Properties], dict[str, Properties]],
    comparison: Comparison,
) -> str | None:
    """Return the only common link into which the links without a counterpart were merged."""
    common = [x for x in names if x in rest[0]]
    others = [
        {name: part for name, part in side.items() if name not in known}
        for side, known in zip(rest, (common, [names[x] for x in common]), strict=True)
    ]
    if not (others[0] or others[1]):
        return None
    for x in common:
        one, two = {x: rest[0][x], **others[0]}, {names[x]: rest[1][names[x]], **others[1]}
        total = _compare_rest(pair, match, [x], one, two, comparison)
        if total.is_equal:
            comparison.merge(total)
            return x
    return None


def _compare_rest(
    pair: Pair,
    match: Match,
    common: list[str],
    one: dict[str, Properties],
    two: dict[str, Properties],
    comparison: Comparison,
) -> Comparison:
    """Compare links together, at their only common link or at the body."""
    names = (
        (common[0], pair.links.get(common[0], common[0]))
        if len(common) == 1
        else (match.one.name, match.two.name)
    )
    total = Comparison(comparison.rows)
    links = pair.a.robot.link[names[0]], pair.b.robot.link[names[1]]
    frames = match.one.members[names[0]], match.frame @ match.two.members[names[1]]
    _compare_properties(links, frames, (combine(one.values()), combine(two.values())), total)
    return total


def _compare_whole(
    pair: Pair,
    match: Match,
    every: tuple[dict[str, Properties], dict[str, Properties]],
    rest: tuple[dict[str, Properties], dict[str, Properties]],
    comparison: Comparison,
) -> Comparison | None:
    """Compare both bodies as a whole; None unless mass or inertia was moved between their links.

    What differs in the links is then in another link, where it is below the tolerance.
    """
    totals, rests = ([combine(part.values()) for part in side] for side in (every, rest))
    if rests[0][0] and rests[1][0] and abs(rests[0][0] - rests[1][0]) <= _MASSLESS:
        moved = _measure_spread(rests[0][2], rests[1][2])
        left = _measure_spread(totals[0][2], totals[1][2])
    else:
        moved, left = (abs(one[0] - two[0]) for one, two in (rests, totals))
    if left > 0.1 * moved:
        return None
    whole = _compare_rest(pair, match, [], *every, comparison)
    return whole if whole.is_equal else None


def _measure_spread(one: Array, two: Array) -> float:
    return float(np.abs(one - two).max())


def _is_merged(
    common: list[str],
    names: dict[str, str],
    one: dict[str, Properties],
    two: dict[str, Properties],
) -> bool:
    """Tell whether links without a counterpart were merged into the only common link.

    The masses then differ less together than those of the common link.
    """
    if len(common) != 1 or len(one) == len(two) == 1:
        return False
    mass, mass2 = one[common[0]][0], two[names[common[0]]][0]
    return abs(combine(one.values())[0] - combine(two.values())[0]) < abs(mass - mass2)


def _compare_links(
    pair: Pair,
    match: Match,
    names: tuple[str, str],
    values: tuple[Properties, Properties],
    comparison: Comparison,
) -> Comparison:
    """Compare a link of both bodies that has mass in both."""
    x, y = names
    trial = Comparison(comparison.rows)
    links = pair.a.robot.link[x], pair.b.robot.link[y]
    frames = match.one.members[x], match.frame @ match.two.members[y]
    _compare_properties(links, frames, values, trial)
    return trial


def _add_unmatched(
    pair: Pair,
    match: Match,
    one: dict[str, Properties],
    two: dict[str, Properties],
    comparison: Comparison,
) -> None:
    """Record links with mass that the body of only one robot has.

    A link of one and a link of the other with equal properties are the same mass.
    """
    one, two = _drop_moved(pair, match, one, two, comparison.rows)
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


def _drop_moved(
    pair: Pair,
    match: Match,
    one: dict[str, Properties],
    two: dict[str, Properties],
    rows: tuple[Row, ...],
) -> tuple[dict[str, Properties], dict[str, Properties]]:
    """Return the links without those whose mass is that of a link with another name."""
    known = {x: y for x in one if (y := pair.links.get(x, x)) in two}
    left, right = (
        {n: p for n, p in side.items() if n not in names}
        for side, names in ((one, known.keys()), (two, known.values()))
    )
    for x, part in left.items():
        for y, other in right.items():
            trial = _compare_links(pair, match, (x, y), (part, other), Comparison(rows))
            if trial.is_equal:
                one, two = _remove_part(one, x), _remove_part(two, y)
                right = _remove_part(right, y)
                break
    return one, two


def _remove_part(parts: dict[str, Properties], name: str) -> dict[str, Properties]:
    return {other: part for other, part in parts.items() if other != name}


def _list_massive(
    bodies: Bodies, body: Body, frame: Array, least: float = _MASSLESS
) -> dict[str, Properties]:
    """Return mass [kg], center [m] and tensor [kg·m²] of the links that have any, by name."""
    found = {}
    for name, pose in body.members.items():
        properties = compute_mass_properties(bodies.robot.link[name], frame @ pose)
        if properties is not None and (properties[0] > least or not properties[0]):
            found[name] = properties
    return found


def combine(parts: Collection[Properties]) -> Properties:
    """Return the properties of a rigid body of several parts."""
    if len(parts) == 1:
        return next(iter(parts))
    mass = math.fsum(part[0] for part in parts)
    tensor, com = np.zeros((3, 3)), np.zeros(3)
    if mass:
        com = sum((m * c for m, c, _ in parts), np.zeros(3)) / mass
    for m, c, inertia in parts:
        arm = c - com
        tensor += inertia + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass, com, tensor


def _compare_properties(
    links: tuple[Link, Link],
    frames: tuple[Array, Array],
    values: tuple[Properties, Properties],
    comparison: Comparison,
) -> None:
    """Compare the properties of a link, which are in the frame of the first body."""
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
    spread = _measure_tensors(tensor, tensor2, larger)
    if mass and mass2 and relative > 1e-12:  # that of a body of another mass is one difference
        spread = min(spread, _measure_tensors(tensor, tensor2 * (mass / mass2), larger))
    texts = [
        format_tensor(f[:3, :3].T @ t @ f[:3, :3])
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


def _measure_tensors(one: Array, two: Array, mass: float) -> float:
    """Return the largest difference of elements, relative to the larger trace."""
    size = max(abs(np.trace(one)), abs(np.trace(two)), 3 * get_noise(mass))
    return float(np.abs(one - two).max()) / size if size else 0.0


def format_tensor(tensor: Array) -> str:
    """Format xx xy xz yy yz zz with six digits; rounding relative to the largest is zero."""
    six = tensor[np.triu_indices(3)]
    return " ".join(f"{x:.6g}" for x in np.where(abs(six) > 1e-12 * abs(six).max(), six, 0.0))
