"""MoveIt's way to find pairs, from the description of its steps: adjacent, default, always, never.

The steps and numbers are those of ``compute_default_collisions.cpp`` of MoveIt: links that share a
joint are adjacent, and a link without geometry connects all its neighbors; what touches at the
default pose is disabled; so is what touches in more than 95 % of 200 random poses; and what is not
seen in contact in 10,000 random poses is never in contact. Nothing of MoveIt is run.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass, field
from itertools import combinations

import numpy as np

from urdftool.model.elements import Robot

from .placement import place_links
from .sampling import Pair, Sampler

POSES, ALWAYS_POSES, FRACTION = 10_000, 200, 0.95

_CHUNK = 2000


@dataclass
class SampledMatrix:
    """Pairs by the step that disables them, each as two names.

    Attributes:
        pairs: Pairs of links with geometry.
        adjacent: Disabled as adjacent.
        default: Disabled since they touch at the default pose.
        always: Disabled since they touch nearly always.
        never: Disabled since they were not seen in contact.
        seconds: Processor time [s].
    """

    pairs: int = 0
    adjacent: list[Pair] = field(default_factory=list)
    default: list[Pair] = field(default_factory=list)
    always: list[Pair] = field(default_factory=list)
    never: list[Pair] = field(default_factory=list)
    seconds: float = 0.0

    def as_dict(self) -> dict[str, object]:
        """Return the fields as data of JSON."""
        return asdict(self)


def find_adjacent(robot: Robot) -> set[frozenset[str]]:
    """Return the pairs that share a joint; links without geometry connect their neighbors."""
    near: dict[str, set[str]] = {name: set() for name in robot.link}
    for joint in robot.joints:
        near[joint.parent].add(joint.child)
        near[joint.child].add(joint.parent)
    for name in [name for name, link in robot.link.items() if not link.collisions]:
        for one in near[name]:
            near[one] |= near[name] - {one}
            near[one].discard(name)
    return {frozenset((one, other)) for one, others in near.items() for other in others}


def sample_matrix(robot: Robot, poses: int = POSES, seed: int = 1) -> SampledMatrix:
    """Find the pairs that MoveIt's steps disable."""
    begin = time.process_time()
    shaped = [name for name, link in robot.link.items() if link.collisions]
    adjacent = find_adjacent(robot)
    result = SampledMatrix()
    left: list[Pair] = []
    for pair in combinations(shaped, 2):
        (result.adjacent if frozenset(pair) in adjacent else left).append(pair)
    sampler = Sampler(robot, left, seed)
    result.pairs = len(result.adjacent) + len(sampler.pairs)
    rest = {n: np.array([_rest(*bounds)]) for n, bounds in sampler.ranges.items()}
    frames = place_links(robot, rest, 1)
    result.default = [p for p in sampler.pairs if sampler.find_contacts(p, rest, frames)]
    left = [pair for pair in sampler.pairs if pair not in result.default]
    positions, frames = sampler.draw(ALWAYS_POSES)
    for pair in left:
        if len(sampler.find_contacts(pair, positions, frames)) > FRACTION * ALWAYS_POSES:
            result.always.append(pair)
    left = [pair for pair in left if pair not in result.always]
    for _ in range(0, poses, _CHUNK):
        positions, frames = sampler.draw(_CHUNK)
        left = [p for p in left if not sampler.find_contacts(p, positions, frames, most=1)]
    result.never, result.seconds = left, time.process_time() - begin
    return result


def _rest(lower: float, upper: float) -> float:
    return 0.0 if lower <= 0 <= upper else (lower + upper) / 2
