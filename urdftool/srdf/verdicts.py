"""Verdicts on all pairs of links of a robot."""

from __future__ import annotations

import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations_with_replacement
from time import monotonic

import numpy as np

from ..model.elements import Robot
from ..parallel import count_cores, map_tasks
from .adjacent import find_adjacent_pairs
from .body import Body, Contacts, make_bodies
from .chain import Chain, find_chain, place
from .divide import Outcome
from .prove import Prover, get_pose_of
from .search import search
from .shapes import LinkShape, read_shapes

ADJACENT, NEVER, ALWAYS, DEFAULT = "adjacent", "never", "always", "default"
CAN_TOUCH, OPEN = "can-touch", "open"

BOXES = 40_000
"""Boxes for each two bodies; chosen by the time of the proof of an arm, no source."""

ALL_BOXES, FEWEST = 10_000_000, 256
"""Boxes for all bodies of a robot, and the least number for each two; chosen, no source."""

Pair = tuple[str, str]
Progress = Callable[[int, int, str], None]
"""Called with the number of finished pairs of bodies, of all, and the two in work."""


@dataclass(frozen=True)
class Options:
    """What is proved, and how long.

    Attributes:
        boxes: Largest number of boxes for each two bodies; None for ``BOXES``, or fewer if all
            bodies would have more than ``ALL_BOXES``.
        visual: Whether the visual geometry is compared.
        time_limit: Time after which pairs that are not begun stay open [s]; None for no limit.
        jobs: Number of processes; None for one per core.
        only: Pairs to decide; None for all.
        default: Whether pairs that touch at the default pose have the verdict ``default``.
        search: Whether contacts of the pairs that the boxes leave open are searched.
    """

    boxes: int | None = None
    visual: bool = False
    time_limit: float | None = None
    jobs: int | None = None
    only: frozenset[frozenset[str]] | None = None
    default: bool = False
    search: bool = True


@dataclass(frozen=True)
class Verdict:
    """What is known of a pair of links.

    Attributes:
        link1: Name of the link that is first in the file.
        link2: Name of the other.
        kind: ``adjacent``, ``never``, ``always``, ``can-touch`` or ``open``.
        positions: Joint positions at which they touch, or were nearest, by name [rad, m].
        distance: Smallest distance that was found [m]; None if none was measured.
        boxes: Boxes that the proof computed, together with the other pairs of the same bodies.
        reason: Why a pair is open; empty if its boxes were used up.
    """

    link1: str
    link2: str
    kind: str
    positions: Mapping[str, float] = field(default_factory=dict)
    distance: float | None = None
    boxes: int = 0
    reason: str = ""

    @property
    def links(self) -> frozenset[str]:
        """Return both names."""
        return frozenset((self.link1, self.link2))


@dataclass(frozen=True)
class Verdicts:
    """Verdicts on the pairs of a robot, in the order of the file.

    Attributes:
        pairs: The verdicts.
        ranges: Lower and upper value of each joint that was used [rad, m], by name.
        problems: Why the shapes of links are not known, by link.
    """

    pairs: tuple[Verdict, ...]
    ranges: Mapping[str, tuple[float, float]]
    problems: Mapping[str, str]

    def count(self) -> Counter[str]:
        """Count the pairs of each kind."""
        return Counter(verdict.kind for verdict in self.pairs)

    def find(self, link1: str, link2: str) -> Verdict | None:
        """Return the verdict on two links; None without one."""
        ends = frozenset((link1, link2))
        return next((verdict for verdict in self.pairs if verdict.links == ends), None)


@dataclass(frozen=True, eq=False)
class Task:
    """Two bodies, the joints between them, and the links to compare."""

    a: Body
    b: Body
    chain: Chain
    pairs: tuple[tuple[int, int], ...]

    @property
    def names(self) -> list[Pair]:
        """Return the names of the links."""
        return [(self.a.shapes[i].link, self.b.shapes[j].link) for i, j in self.pairs]


def list_shaped_links(robot: Robot, *, visual: bool = False) -> list[str]:
    """List the names of the links with collision or visual geometry, in the order of the file."""
    return [n for n, link in robot.link.items() if (link.visuals if visual else link.collisions)]


def decide(
    robot: Robot, options: Options | None = None, progress: Progress | None = None
) -> Verdicts:
    """Decide all pairs of links with geometry.

    The result does not depend on the number of processes. A time limit turns pairs into open ones.

    Raises:
        MissingDependency: python-fcl is not installed.
    """
    from ..extras import require

    require("the proof of collision pairs", "fcl", "manifold3d")
    options = options or Options()
    names = list_shaped_links(robot, visual=options.visual)
    shapes = {name: read_shapes(robot, name, visual=options.visual) for name in names}
    tasks, found = _plan(robot, shapes, find_adjacent_pairs(robot, names), options)
    found |= _prove_all(tasks, options, progress)
    rank = {name: index for index, name in enumerate(names)}
    verdicts = sorted((_order(v, rank) for v in found.values()), key=lambda v: _rank(v, rank))
    ranges = {c.joint: (c.lower, c.upper) for task in tasks for c in task.chain.coordinates}
    problems = {name: shape.problem for name, shape in shapes.items() if shape.problem}
    ordered = {name: ranges[name] for name in robot.joint if name in ranges}
    return Verdicts(tuple(verdicts), ordered, problems)


def list_tasks(robot: Robot, options: Options) -> list[Task]:
    """List the pairs of bodies that :func:`decide` proves."""
    names = list_shaped_links(robot, visual=options.visual)
    shapes = {name: read_shapes(robot, name, visual=options.visual) for name in names}
    return _plan(robot, shapes, find_adjacent_pairs(robot, names), options)[0]


def _order(verdict: Verdict, rank: Mapping[str, int]) -> Verdict:
    """Put the link first that is first in the file."""
    if rank[verdict.link1] <= rank[verdict.link2]:
        return verdict
    return replace(verdict, link1=verdict.link2, link2=verdict.link1)


def _rank(verdict: Verdict, rank: Mapping[str, int]) -> tuple[int, int]:
    return rank[verdict.link1], rank[verdict.link2]


def _plan(
    robot: Robot,
    shapes: Mapping[str, LinkShape],
    adjacent: set[frozenset[str]],
    options: Options,
) -> tuple[list[Task], dict[frozenset[str], Verdict]]:
    """List what is to be proved, and the verdicts that need no proof."""
    found: dict[frozenset[str], Verdict] = {}
    names = list(shapes)
    unknown = {name for name in names if shapes[name].problem}
    for index, one in enumerate(names):
        for other in names[index + 1 :]:
            pair = frozenset((one, other))
            if options.only is not None and pair not in options.only:
                continue
            if pair in adjacent:
                found[pair] = Verdict(one, other, ADJACENT)
            elif pair & unknown:
                which = one if one in unknown else other
                found[pair] = Verdict(one, other, OPEN, reason=f"the shape of '{which}' is unknown")
    tasks = []
    for a, b in combinations_with_replacement(make_bodies(robot, shapes), 2):
        pairs = _list_pairs(a, b, set(found), options)
        if not pairs:
            continue
        task = Task(a, b, find_chain(robot, a.top, b.top), tuple(pairs))
        if task.chain.obstacle:
            for one, other in task.names:
                verdict = Verdict(one, other, OPEN, reason=task.chain.obstacle)
                found[verdict.links] = verdict
        else:
            tasks.append(task)
    return tasks, found


def _list_pairs(
    a: Body, b: Body, known: set[frozenset[str]], options: Options
) -> list[tuple[int, int]]:
    return [
        (i, j)
        for i, one in enumerate(a.shapes)
        for j, other in enumerate(b.shapes)
        if (a is not b or i < j)
        and (pair := frozenset((one.link, other.link))) not in known
        and (options.only is None or pair in options.only)
    ]


def _prove_all(
    tasks: Sequence[Task], options: Options, progress: Progress | None
) -> dict[frozenset[str], Verdict]:
    """Prove all tasks in several processes."""
    begin, limit = monotonic(), options.time_limit
    boxes = options.boxes or min(BOXES, max(FEWEST, ALL_BOXES // max(1, len(tasks))))
    options = replace(options, boxes=boxes)

    def prove(index: int) -> list[Verdict]:
        if limit is not None and monotonic() - begin > limit:
            return [Verdict(*pair, OPEN, reason="the time was up") for pair in tasks[index].names]
        return _prove(tasks[index], options)

    def announce(done: int, running: Sequence[int]) -> None:
        if progress is not None:
            now = [f"{tasks[index].a.top} and {tasks[index].b.top}" for index in running]
            progress(done, len(tasks), ", ".join(now))

    order = sorted(range(len(tasks)), key=lambda index: -len(tasks[index].chain.coordinates))
    results = map_tasks(prove, order, workers=options.jobs or count_cores(), on_progress=announce)
    return {verdict.links: verdict for _, some in results for verdict in some}


def _prove(task: Task, options: Options) -> list[Verdict]:
    """Prove what can be proved of two bodies, and search for contacts of the rest."""
    seed = zlib.crc32(" ".join(map(" ".join, task.names)).encode())
    contacts = Contacts(task.a, task.b)
    prover = Prover(task.chain, (task.a.cover, task.b.cover), list(task.pairs), contacts, seed)
    result = prover.run(options.boxes or BOXES)
    if options.search:
        search(prover, result.outcomes)
    if options.default:
        resting = {key for key in task.pairs if _is_contact_at_rest(prover, key)}
    else:
        resting = set()
    joints = [coordinate.joint for coordinate in task.chain.coordinates]
    return [
        _judge(pair, result.outcomes[key], joints, result.boxes, at_rest=key in resting)
        for pair, key in zip(task.names, task.pairs, strict=True)
    ]


def _is_contact_at_rest(prover: Prover, key: tuple[int, int]) -> bool:
    """Tell whether two links touch at the default pose of MoveIt: 0, or the middle of a range."""
    lower, upper = prover.lower, prover.upper
    values = np.where((lower <= 0) & (upper >= 0), 0.0, (lower + upper) / 2)
    return prover.contacts.find_contact(key, get_pose_of(place(prover.chain, values[None]), 0))


def _judge(
    pair: Pair, outcome: Outcome, joints: Iterable[str], boxes: int, *, at_rest: bool
) -> Verdict:
    """Make the verdict of an outcome."""
    if at_rest and outcome.witness is not None and len(outcome.witness):
        return Verdict(*pair, DEFAULT, boxes=boxes)
    kind = CAN_TOUCH if outcome.witness is not None else NEVER if outcome.is_free else OPEN
    values = outcome.witness if outcome.witness is not None else outcome.near_values
    if kind == NEVER or values is None:
        return Verdict(*pair, kind, boxes=boxes)
    positions = dict(zip(joints, map(float, values), strict=True))
    if kind == CAN_TOUCH and not positions:
        return Verdict(*pair, ALWAYS, boxes=boxes)
    distance = None if kind == CAN_TOUCH else float(outcome.nearest)
    return Verdict(*pair, kind, positions, distance, boxes)
