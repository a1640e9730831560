"""Directed search for contacts of pairs that the boxes leave open.

A pattern search: the distance of the shapes is made smaller by steps in one joint at a time, which
are halved when none helps (Hooke and Jeeves, J. ACM 8, 1961).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..geometry.mesh import Array
from .chain import place
from .divide import Outcome
from .prove import Prover, get_pose_of

STARTS = 4
"""Poses from which the search starts; chosen, no source."""

MEASURES = 400
"""Largest number of distances for each pair; chosen, no source."""

_FIRST, _LAST = 0.25, 1e-4
"""First and last step, relative to the range of a joint; chosen, no source."""


def search(prover: Prover, outcomes: Mapping[tuple[int, int], Outcome]) -> None:
    """Search for a pose at which each open pair touches; store it, or the smallest distance."""
    for pair, outcome in outcomes.items():
        if not outcome.is_free and outcome.witness is None:
            _search_pair(prover, pair, outcome)


def _search_pair(prover: Prover, pair: tuple[int, int], outcome: Outcome) -> None:
    lower, upper = prover.lower, prover.upper
    starts = list(prover.random.uniform(lower, upper, (STARTS - 1, len(lower))))
    if outcome.near_values is not None:
        starts.insert(0, outcome.near_values)
    left = MEASURES
    for start in starts:
        left -= _search_downhill(prover, pair, outcome, start, left // 2 + 1)
        if outcome.witness is not None or left <= 0:
            return


def _search_downhill(
    prover: Prover, pair: tuple[int, int], outcome: Outcome, values: Array, most: int
) -> int:
    """Search downhill from a pose; return the number of distances that were measured."""
    used = 1
    span = prover.upper - prover.lower
    best, step = _measure(prover, pair, outcome, values), _FIRST
    while step > _LAST and used < most and outcome.witness is None:
        improved = False
        for column in range(len(span)):
            for sign in (1.0, -1.0):
                trial = values.copy()
                trial[column] += sign * step * span[column]
                trial = np.clip(trial, prover.lower, prover.upper)
                if trial[column] == values[column]:
                    continue
                used += 1
                distance = _measure(prover, pair, outcome, trial)
                if distance < best:
                    best, values, improved = distance, trial, True
                    break
            if outcome.witness is not None or used >= most:
                return used
        if not improved:
            step /= 2
    return used


def _measure(prover: Prover, pair: tuple[int, int], outcome: Outcome, values: Array) -> float:
    """Measure a distance [m], and store it if it is the smallest, or a contact."""
    pose = get_pose_of(place(prover.chain, values[None]), 0)
    if prover.contacts.find_contact(pair, pose):
        outcome.witness = values.copy()
        return 0.0
    distance = max(prover.contacts.measure(pair, pose), 0.0)
    if distance < outcome.nearest:
        outcome.nearest, outcome.near_values = distance, values.copy()
    return distance
