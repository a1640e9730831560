"""Random poses and a directed search that try to bring disabled pairs in contact."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterable, Mapping
from dataclasses import asdict, dataclass, field

import numpy as np
from scipy.optimize import minimize

from urdftool.geometry.mesh import Array
from urdftool.model.elements import Robot

from .contacts import (
    SLACK,
    LinkSolids,
    is_contact,
    make_solids,
    measure_distance,
    measure_gaps,
    put,
)
from .placement import Frames, draw_positions, list_ranges, place_links

CHUNK = 2000
"""Poses in one computation."""

STARTS, CALLS = 3, 120
"""Starts of the directed search of a pair, and distances measured from each."""

Pair = tuple[str, str]


@dataclass
class Sampled:
    """What random poses and the search found.

    Attributes:
        poses: Random poses of the robot that were looked at.
        asked: Poses at which FCL was asked, in all pairs.
        contacts: Random poses in contact, by pair; only those above 0.
        searched: Pairs of the directed search.
        distances: Distances that the search measured.
        found: Positions at which the search found a contact, by pair.
        nearest: Smallest distance of the search [m]; None without a search.
        unread: Links whose shapes are not known.
        seconds: Processor time [s].
    """

    poses: int = 0
    asked: int = 0
    contacts: dict[str, int] = field(default_factory=dict)
    searched: int = 0
    distances: int = 0
    found: dict[str, dict[str, float]] = field(default_factory=dict)
    nearest: float | None = None
    unread: list[str] = field(default_factory=list)
    seconds: float = 0.0

    def as_dict(self) -> dict[str, object]:
        """Return the fields as data of JSON."""
        return asdict(self)


class Sampler:
    """Random poses of a robot, and contacts of some pairs at them."""

    def __init__(self, robot: Robot, pairs: Iterable[Pair], seed: int = 1) -> None:
        """Read the shapes.

        Args:
            robot: Robot.
            pairs: Pairs to look at; those with an unknown shape are left out.
            seed: Of the random poses.
        """
        self.robot, self.ranges = robot, list_ranges(robot)
        pairs = list(pairs)
        solids = {name: make_solids(robot, name) for pair in pairs for name in pair}
        self.solids: dict[str, LinkSolids] = {n: s for n, s in solids.items() if s is not None}
        self.unread = sorted(set(solids) - set(self.solids))
        self.pairs = [pair for pair in pairs if set(pair) <= set(self.solids)]
        self.random = np.random.default_rng(seed)
        self.asked = 0
        self.near: dict[Pair, list[tuple[float, dict[str, float]]]] = {p: [] for p in self.pairs}

    def draw(self, count: int) -> tuple[dict[str, Array], Frames]:
        """Draw random poses of the robot."""
        positions = draw_positions(self.ranges, count, self.random)
        return positions, place_links(self.robot, positions, count)

    def find_contacts(
        self, pair: Pair, positions: Mapping[str, Array], frames: Frames, *, most: int | None = None
    ) -> list[int]:
        """Return the poses at which a pair is in contact; at most some, in their order."""
        a, b = self.solids[pair[0]], self.solids[pair[1]]
        gaps = measure_gaps(a, b, frames, pair)
        self._remember(pair, positions, gaps)
        found: list[int] = []
        for row in np.nonzero(gaps < SLACK)[0]:
            if most is not None and len(found) >= most:
                break
            self.asked += 1
            put(a, frames[pair[0]], row)
            put(b, frames[pair[1]], row)
            if is_contact(a, b):
                found.append(int(row))
        return found

    def _remember(self, pair: Pair, positions: Mapping[str, Array], gaps: Array) -> None:
        """Store the poses with the smallest distances of spheres, for the search."""
        rows = np.argsort(gaps, kind="stable")[:STARTS]
        new = [(float(gaps[row]), {n: float(v[row]) for n, v in positions.items()}) for row in rows]
        kept = sorted([*self.near[pair], *new], key=lambda item: item[0])
        self.near[pair] = kept[:STARTS]

    def search(self, pair: Pair, seconds: float) -> tuple[dict[str, float] | None, int, float]:
        """Make the distance of a pair smaller by Powell's method, from the nearest random poses.

        Returns:
            Positions in contact or None, the number of distances, and the smallest one [m].
        """
        names, begin = list(self.ranges), time.process_time()
        bounds = [self.ranges[name] for name in names]
        state: dict[str, object] = {"calls": 0, "least": np.inf, "hit": None}

        def compute(values: Array) -> float:
            if state["hit"] is not None or time.process_time() - begin > seconds:
                return 0.0
            state["calls"] = int(str(state["calls"])) + 1
            given = dict(zip(names, np.clip(values, *np.transpose(bounds)), strict=True))
            frames = place_links(self.robot, {n: np.array([v]) for n, v in given.items()}, 1)
            a, b = self.solids[pair[0]], self.solids[pair[1]]
            put(a, frames[pair[0]], 0)
            put(b, frames[pair[1]], 0)
            if is_contact(a, b):
                state["hit"] = {name: float(value) for name, value in given.items()}
                return 0.0
            distance = max(measure_distance(a, b), 0.0)
            state["least"] = min(float(str(state["least"])), distance)
            return distance

        for _, start in self.near[pair]:
            first = np.array([start[name] for name in names])
            options = {"maxfev": CALLS, "xtol": 1e-3, "ftol": 1e-6}
            minimize(compute, first, method="Powell", bounds=bounds, options=options)
            if state["hit"] is not None or time.process_time() - begin > seconds:
                break
        hit = state["hit"]
        least = float(str(state["least"]))
        return hit if isinstance(hit, dict) else None, int(str(state["calls"])), least


def sample(
    robot: Robot, pairs: Collection[Pair], *, most: int, seconds: float, each: float
) -> Sampled:
    """Look at random poses until their number or the processor time is used, then search.

    Args:
        robot: Robot.
        pairs: Pairs that should never be in contact.
        most: Largest number of poses.
        seconds: Processor time of the random poses [s].
        each: Processor time of the search of a pair [s]; 0 for no search.
    """
    begin = time.process_time()
    sampler, result = Sampler(robot, pairs), Sampled()
    result.unread = sampler.unread
    while sampler.pairs and result.poses < most and time.process_time() - begin < seconds:
        positions, frames = sampler.draw(CHUNK)
        for pair in sampler.pairs:
            hits = sampler.find_contacts(pair, positions, frames)
            if hits:
                key = " ".join(pair)
                result.contacts[key] = result.contacts.get(key, 0) + len(hits)
        result.poses += CHUNK
    for pair in sampler.pairs if each else ():
        hit, calls, least = sampler.search(pair, each)
        result.searched += 1
        result.distances += calls
        result.nearest = least if result.nearest is None else min(result.nearest, least)
        if hit is not None:
            result.found[" ".join(pair)] = hit
    result.asked, result.seconds = sampler.asked, time.process_time() - begin
    return result
