"""Comparison of mass matrices and gravity forces, which follow from everything else."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping

import numpy as np

from ..mechanics.reference import GRAVITY, SLIDING, TURNING, Array, Mechanics, get_origin_matrix
from ..model.elements import Joint
from ..model.kinematics import get_limits
from ..model.numbers import remove_noise
from ..model.provenance import NOWHERE
from ..model.world import WORLD
from .difference import Comparison, Difference
from .freedoms import BASE, SEVERAL, add_free_base, expand_joints, place_root
from .pair import Pair, locate
from .rows import GLOBAL_ROWS

_CONFIGURATIONS = 5
"""Configurations at which the dynamics are compared; chosen, no source."""

_MOST_JOINTS = 120
"""Largest number of joints whose dynamics are compared; chosen, no source."""

_FLOOR = 1e-6
"""Largest element [kg·m², kg, N·m or N] below which differences are absolute; chosen, no source.

A robot without mass has elements of 1e-12 of rounding or of the least masses that formats require.
"""

_BALANCE = 1e-6
"""Arm [m] of the weight of the robot below which forces of gravity are absolute; chosen, no source.

A balanced robot has forces that are nothing but rounding.
"""


_LEVEL = 1e-6
"""Sine of the angle between two vertical axes that are equal; chosen, no source."""


def compare_dynamics(
    pair: Pair, frame: Array, signs: Mapping[str, float], comparison: Comparison
) -> None:
    """Compare joint-space mass matrices and gravity forces with a fixed base, then with a free one.

    ``frame`` is the pose of the root body of the second robot in that of the first, 4 × 4.
    """
    if not set(GLOBAL_ROWS) & set(comparison.tolerances):
        return
    one, two, names = expand_joints(pair)
    roots = one.tree.roots[0].name, two.tree.roots[0].name
    two = place_root(two, roots[1], frame)
    turns = _get_turns(pair, roots, frame)
    why = _find_obstacle(pair, Mechanics(one), Mechanics(two), names, comparison)
    if why:
        comparison.skipped |= dict.fromkeys(GLOBAL_ROWS, why)
        _compare_tilt(pair, turns, comparison)
        return
    _compare(Mechanics(one), Mechanics(two), names, signs, comparison, turns)
    is_fixed = False in (pair.a.is_free, pair.b.is_free) or WORLD in roots
    if not is_fixed and roots == (pair.a.root, pair.b.root):
        free, free2 = Mechanics(add_free_base(one)), Mechanics(add_free_base(two))
        names |= {f"{BASE}~{i}": f"{BASE}~{i}" for i in range(6)}
        _compare(free, free2, names, signs, comparison)


def _get_turns(pair: Pair, roots: tuple[str, str], frame: Array) -> tuple[Array, Array]:
    """Return the rotations in the world, 3 × 3, of the frame in which both roots are placed.

    A fixed base may be tilted against gravity. One without a pose is upright, as engines have it
    that fix a root; the start of a free one is no property of the robot.
    """
    found: list[Array] = []
    for bodies, root in zip((pair.a, pair.b), roots, strict=True):
        base = bodies.robot.base
        if base is not None and base.is_free:
            return np.eye(3), np.eye(3)
        is_placed = base is not None and root != WORLD
        found.append(get_origin_matrix(base.origin)[:3, :3] if is_placed and base else np.eye(3))
    return found[0], found[1] @ frame[:3, :3].T


def _compare_tilt(pair: Pair, turns: tuple[Array, Array], comparison: Comparison) -> None:
    """Compare the directions of gravity in two fixed bases, where forces do not show them.

    ``turns`` are the rotations in the world, 3 × 3, of the frame in which both roots are placed.
    """
    if "base" in comparison.skipped or not _is_tilted(turns):
        return
    downs = [tuple(remove_noise((-turn[2]).tolist())) for turn in turns]
    roots = pair.a.robot.link[pair.a.root], pair.b.robot.link[pair.b.root]
    comparison.add(
        Difference(
            "base",
            "link",
            (roots[0].name, roots[1].name),
            "direction of gravity",
            (downs[0], downs[1]),
            "",
            float(np.abs(turns[0][2] - turns[1][2]).max()),
            (locate(pair.a.robot.base, roots[0]), locate(pair.b.robot.base, roots[1])),
            "the fixed bases are tilted differently",
        )
    )


def _is_tilted(turns: tuple[Array, Array]) -> bool:
    return float(np.abs(turns[0][2] - turns[1][2]).max()) > _LEVEL


def _find_obstacle(
    pair: Pair,
    one: Mechanics,
    two: Mechanics,
    names: Mapping[str, str],
    comparison: Comparison,
) -> str:
    """Return why the matrices cannot be compared; empty if they can."""
    others = [names.get(joint.name, "") for joint in one.joints]
    if sorted(others) != sorted(joint.name for joint in two.joints):
        return "the joints differ"
    if any(d.row == "tree" and d.what == "type" for d in comparison.differences):
        return "the types of joints differ"
    if len(one.joints) > _MOST_JOINTS:
        return f"there are more than {_MOST_JOINTS} joints"
    if not one.joints:
        return "there are no joints with positions"
    known = (*TURNING, *SLIDING, *SEVERAL)
    return "" if all(j.type in known for j in pair.a.joints.values()) else "some joints are planar"


def _compare(
    one: Mechanics,
    two: Mechanics,
    pairs: Mapping[str, str],
    signs: Mapping[str, float],
    comparison: Comparison,
    turns: tuple[Array, Array] | tuple[None, None] = (None, None),
) -> None:
    """Compare mass matrices and gravity forces of two robots at some configurations.

    ``turns`` are the rotations of their roots in the world, 3 × 3.
    """
    names = [joint.name for joint in one.joints]
    others = [pairs[name] for name in names]
    columns = [[joint.name for joint in two.joints].index(name) for name in others]
    sign = np.array([signs.get(name, 1.0) for name in names])
    generator = random.Random(0)
    tilt = ""
    if turns[0] is not None and _is_tilted(turns):
        tilt = "the fixed bases are tilted differently"
    for number in range(_CONFIGURATIONS):
        values = [_draw(joint, generator) if number else 0.0 for joint in one.joints]
        here = dict(zip(names, values, strict=True))
        there = dict(zip(others, (sign * np.array(values)).tolist(), strict=True))
        _add_matrix(
            comparison,
            "mass matrix",
            one.compute_mass_matrix(here),
            two.compute_mass_matrix(there)[np.ix_(columns, columns)] * np.outer(sign, sign),
        )
        _add_matrix(
            comparison,
            "gravity",
            one.compute_gravity(here, turns[0]),
            two.compute_gravity(there, turns[1])[columns] * sign,
            _BALANCE * one.compute_centroid(here)[0] * float(np.abs(GRAVITY).max()),
            tilt,
        )


def _draw(joint: Joint, generator: random.Random) -> float:
    lower, upper = (max(-3.0, min(3.0, value)) for value in get_limits(joint))
    return generator.uniform(lower, upper) if lower < upper else lower


def _add_matrix(
    comparison: Comparison, row: str, one: Array, two: Array, least: float = 0.0, why: str = ""
) -> None:
    size = max(float(np.abs(one).max()), float(np.abs(two).max()))
    amount = float(np.abs(one - two).max()) / max(size, _FLOOR, least)
    known = [difference for difference in comparison.differences if difference.row == row]
    if known and known[0].amount >= amount:
        return
    for difference in known:
        comparison.differences.remove(difference)
    note = f"{100 * amount:.3g} % of the largest element" if math.isfinite(amount) else ""
    if not any(d for d in comparison.differences if d.row != row and not d.is_convention):
        note += f"; {why or 'no part differs above its tolerance'}"
    comparison.add(
        Difference(row, "robot", ("", ""), row, (None, None), "", amount, (NOWHERE, NOWHERE), note)
    )
