"""Rules on pairs of links that an SRDF disables, or could disable."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...model.elements import Robot
from ...model.semantic import read_semantic
from ...source.description import Description
from ...source.document import Element
from ..collision.convex_bodies import get_convex_bodies
from ..collision.exact_contact import find_contact
from ..collision.intended_overlap import is_telescope, list_joints_between
from ..fix import FixContext, Proposal, remove_element, unsafe
from ..gazebo.contact import are_fingers
from ..rule import INFO, UNSAFE, WARNING, Problem, rule
from ..words import join_some
from .semantic import get_srdf_documents

if TYPE_CHECKING:
    from ...srdf.existing import Judgement

_ON = ("moveit",)

BOXES, ALL_BOXES, FEWEST = 1000, 3000, 10
"""Boxes for each two bodies in lint, for all of them, which takes seconds, and at least for two;
chosen, no source.
"""


def _choose_boxes(pairs: int) -> int:
    """Return the boxes for each of a number of pairs."""
    return min(BOXES, max(FEWEST, ALL_BOXES // pairs))


def _judge_disabled(robot: Robot, description: Description) -> list[Judgement]:
    """Judge the disabled pairs of the SRDF files, with few boxes."""
    from ...srdf.existing import judge
    from ...srdf.verdicts import Options, decide

    def compute() -> list[Judgement]:
        contents = [read_semantic(d.root) for d in get_srdf_documents(robot, description)]
        pairs = frozenset(
            pair.links for content in contents for pair in content.list_disabled(robot.link)
        )
        if not pairs:
            return []
        boxes = _choose_boxes(len(pairs))
        options = Options(boxes=boxes, jobs=1, only=pairs, search=False)
        verdicts = decide(robot, options)
        return [found for content in contents for found in judge(content, robot, verdicts)]

    return robot.memo.get("disabled pairs", compute)


@rule(
    WARNING,
    on=_ON,
    effects={
        "moveit": "plans motions in which the two links collide",
    },
)
def disabled_pair_can_touch(robot: Robot, description: Description) -> Iterator[Problem]:
    """The SRDF disables a pair of links that touch at some joint positions.

    MoveIt does not check the pair, so a planned motion may drive the links into each other. The
    message has joint positions within the limits at which the collision geometry of both is in
    contact. MoveIt's Setup Assistant disables pairs that it never saw in contact at random poses.
    Pairs with the reason ``User``, ``Default`` or ``Always`` are intended, and so are pairs that
    touch with all joints at zero, the stages of a telescope, and the fingers of a gripper, which
    touch when it closes: MoveIt could not move these joints without the pair. Links that are
    disabled as ``Adjacent`` without a common joint are findings of adjacent-through-bare-link. Of a
    robot with many pairs, each is searched for a short time; ``urdftool srdf --check`` searches
    longer. Requires python-fcl.
    """
    from ...srdf.content import format_positions
    from ...srdf.existing import REFUTED

    for found in _judge_disabled(robot, description):
        if found.code == REFUTED and found.verdict is not None:
            pair = found.pair
            if _is_disabled_rightly(robot, pair.link1, pair.link2):
                continue
            reason = f" as {pair.reason}" if pair.reason else ""
            yield Problem(
                pair,
                f"links '{pair.link1}' and '{pair.link2}' are disabled{reason}, but touch at "
                f"{format_positions(found.verdict.positions)}",
                at=pair.element,
                data={"positions": dict(found.verdict.positions)},
            )


def _is_disabled_rightly(robot: Robot, one: str, other: str) -> bool:
    """Tell whether two links touch in poses in which the robot works: at zero, or when it grips."""
    joints = list_joints_between(robot, one, other)
    if are_fingers(joints) or is_telescope(robot, one, other):
        return True
    poses = get_convex_bodies(robot).poses
    if one not in poses or other not in poses:
        return False
    return find_contact(robot, robot.link[one], robot.link[other]) is True


@rule(
    WARNING,
    on=_ON,
    default=False,
    effects={
        "moveit": "does not check the two links against each other",
    },
)
def adjacent_through_bare_link(robot: Robot, description: Description) -> Iterator[Problem]:
    """The SRDF disables two links as adjacent, but no joint connects them.

    MoveIt's Setup Assistant lets a link without geometry connect all its neighbors with each other.
    So two arms on a bare torso are adjacent, and two fingers on a bare palm, and are not checked
    against each other. Links that are proved never to touch are no finding. Not enabled by default,
    because such a pair usually has to be disabled, and only its reason is imprecise. Requires
    python-fcl.
    """
    from ...srdf.content import format_positions
    from ...srdf.existing import BARE
    from ...srdf.verdicts import CAN_TOUCH

    for found in _judge_disabled(robot, description):
        if found.code == BARE and found.verdict is not None:
            pair, verdict = found.pair, found.verdict
            touching = ""
            if verdict.kind == CAN_TOUCH:
                touching = f", and they touch at {format_positions(verdict.positions)}"
            yield Problem(
                pair,
                f"links '{pair.link1}' and '{pair.link2}' are disabled as Adjacent, but no joint "
                f"connects them{touching}",
                at=pair.element,
                data={"positions": dict(verdict.positions)},
            )


@disabled_pair_can_touch.fix(UNSAFE)
@adjacent_through_bare_link.fix(UNSAFE)
def enable_pair(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the pair, so that MoveIt checks it."""
    pair = problem.at
    return unsafe("check the pair", remove_element(pair)) if isinstance(pair, Element) else None


@rule(
    INFO,
    on=_ON,
    default=False,
    effects={
        "moveit": "checks the pair at each state, which takes time",
    },
)
def pair_never_touches(robot: Robot, description: Description) -> Iterator[Problem]:
    """Links that never touch are not disabled in the SRDF.

    A proof shows that the links touch at no joint positions within the limits. The rule is not
    enabled by default, because the proof takes seconds; ``urdftool srdf --update`` adds the pairs.
    Requires python-fcl.
    """
    from ...srdf.verdicts import NEVER, Options, decide

    for document in get_srdf_documents(robot, description):
        content = read_semantic(document.root)
        disabled = {pair.links for pair in content.list_disabled(robot.link)}
        verdicts = decide(robot, Options(boxes=BOXES, jobs=1, search=False))
        names = [
            f"'{verdict.link1}' and '{verdict.link2}'"
            for verdict in verdicts.pairs
            if verdict.kind == NEVER and verdict.links not in disabled
        ]
        if names:
            yield Problem(
                document.root,
                f"links that never touch are not disabled: {join_some(names, 'pairs')}",
                data={"pairs": len(names)},
            )
