"""Proofs of the pairs of an SRDF that an export takes over."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..diagnostic import Severity
from ..finding import Finding
from ..model.elements import Robot

if TYPE_CHECKING:
    from ..srdf.existing import Judgement

BOXES = 1000
"""Boxes for each two bodies, as in lint: an export is to be fast. Chosen, no source."""

_SHOWN = 3
"""Pairs that one message names. Chosen, no source."""


@dataclass(frozen=True)
class PairProofs:
    """What is known of the pairs that an SRDF disables.

    Attributes:
        texts: Reason of each pair and whether it is proved, by the names of its links.
        findings: A warning for each pair that can touch, and one note on those that are open.
    """

    texts: dict[frozenset[str], str] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)


def prove_srdf_pairs(
    robot: Robot,
    path: str | Path | None,
    progress: Callable[[int, int, str], None] | None = None,
) -> PairProofs:
    """Prove the pairs of an SRDF with few boxes.

    Args:
        robot: The robot.
        path: The SRDF; None for no pairs.
        progress: Called when two bodies are begun.

    Raises:
        SourceError: The SRDF cannot be read.
        ModelError: It is not an SRDF.
    """
    from ..extras import is_installed
    from ..srdf.existing import judge, read_srdf
    from ..srdf.verdicts import Options, decide

    if path is None:
        return PairProofs()
    packages = robot.source.packages if robot.source is not None else None
    content = read_srdf(path, None, packages)
    pairs = frozenset(pair.links for pair in content.list_disabled(robot.link))
    if not pairs:
        return PairProofs()
    if not (is_installed("fcl") and is_installed("manifold3d")):
        message = (
            f"the {len(pairs)} pairs of the SRDF are taken over without proof, since python-fcl "
            "is not installed; install urdftool[srdf]"
        )
        place = content.element.place
        return PairProofs({}, [Finding("srdf-pair-open", Severity.INFO, message, place)])
    options = Options(boxes=BOXES, jobs=1, only=pairs, search=False)
    found = list(judge(content, robot, decide(robot, options, progress)))
    texts = {j.pair.links: _describe(j) for j in found if j.pair.provenance is not None}
    return PairProofs(texts, [*_warn(found), *_report_open(found)])


def _describe(judgement: Judgement) -> str:
    """Describe a pair in a few words for the file of an export."""
    from ..srdf.content import REASONS
    from ..srdf.verdicts import ADJACENT, ALWAYS, CAN_TOUCH, NEVER

    reason, verdict = judgement.pair.reason or "no reason", judgement.verdict
    if verdict is None:
        return reason
    word = {
        NEVER: "proved never to touch",
        ADJACENT: "joined by a joint",
        ALWAYS: "fixed to each other",
        CAN_TOUCH: "can touch",
    }.get(verdict.kind, "not proved")
    given = reason if reason in (*REASONS.values(), "User", "no reason") else "another reason"
    return f"{given}, {word}"


def _warn(found: Sequence[Judgement]) -> list[Finding]:
    from ..srdf.content import format_positions
    from ..srdf.existing import BARE, REFUTED
    from ..srdf.verdicts import CAN_TOUCH

    return [
        Finding(
            REFUTED,
            Severity.WARNING,
            f"links '{j.pair.link1}' and '{j.pair.link2}' have no contact, as the SRDF disables "
            f"them, but touch at {format_positions(j.verdict.positions)}",
            j.pair.element.place,
            "link",
            j.pair.link1,
            data={"positions": dict(j.verdict.positions)},
        )
        for j in found
        if j.code in (REFUTED, BARE) and j.verdict is not None and j.verdict.kind == CAN_TOUCH
    ]


def _report_open(found: Sequence[Judgement]) -> list[Finding]:
    from ..srdf.existing import BARE, UNPROVED
    from ..srdf.verdicts import OPEN

    left = [
        j.pair
        for j in found
        if j.code in (UNPROVED, BARE) and j.verdict is not None and j.verdict.kind == OPEN
    ]
    if not left:
        return []
    names = ", ".join(f"'{pair.link1}' and '{pair.link2}'" for pair in left[:_SHOWN])
    more = f", and {len(left) - _SHOWN} more" if len(left) > _SHOWN else ""
    message = (
        f"pairs that the SRDF disables are not proved with {BOXES} boxes: {names}{more}; "
        "'urdftool srdf --check' uses more"
    )
    place = left[0].element.place
    return [Finding("srdf-pair-open", Severity.INFO, message, place, data={"pairs": len(left)})]
