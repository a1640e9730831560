"""An existing SRDF, compared with the verdicts on its pairs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import ModelError
from ..model.elements import Robot
from ..model.semantic import DisabledPair, SemanticDescription, read_semantic
from ..source.description import read_description
from ..source.packages import Packages
from ..workspace import Workspace
from .verdicts import ADJACENT, ALWAYS, CAN_TOUCH, NEVER, OPEN, Verdict, Verdicts

INTENDED = ("User", "Default", "Always")
"""Reasons of pairs that are disabled although they may touch."""

REFUTED, UNPROVED, BARE = "disabled-pair-can-touch", "not-proved", "adjacent-through-bare-link"
INTENDED_CONTACT, UNKNOWN, REPEATED = "intended", "unknown-link", "repeated"
CONFIRMED, MISSING = "proved", "pair-never-touches"


@dataclass(frozen=True)
class Judgement:
    """A pair of an SRDF, and what is known of it.

    Attributes:
        code: One of the codes of this module.
        pair: The pair; one without a place is missing in the file.
        verdict: What is known of it; None if a link does not exist.
    """

    code: str
    pair: DisabledPair
    verdict: Verdict | None = None


def read_srdf(
    path: str | Path,
    arguments: Mapping[str, str] | None,
    packages: Packages | None,
    workspace: Workspace | None = None,
) -> SemanticDescription:
    """Read an SRDF, also in xacro.

    Raises:
        SourceError: The file cannot be read or expanded.
        ModelError: Its root element is not ``<robot>``.
    """
    finder = None if packages is None else packages.make_finder_for(path)
    root = read_description(
        str(path), arguments or {}, finder=finder, workspace=workspace
    ).document.root
    if root.tag != "robot":
        raise ModelError(
            f"the root element is <{root.tag}>; an SRDF file starts with <robot>", at=root.place
        )
    return read_semantic(root)


def check_robot(robot: Robot, content: SemanticDescription) -> None:
    """Check that an SRDF belongs to a robot.

    Raises:
        ModelError: It names links, and the robot has none of them.
    """
    named = {name for pair in content.disabled for name in pair.links}
    named |= {link.name for link in content.unchecked}
    if named and not named & set(robot.link):
        raise ModelError(
            f"the SRDF is of another robot ('{content.name}'): '{robot.name}' has none of the "
            f"{len(named)} links in its pairs",
            at=content.element.place,
        )


def judge(content: SemanticDescription, robot: Robot, verdicts: Verdicts) -> Iterator[Judgement]:
    """Judge the disabled pairs of an SRDF in its order, then the pairs that it lacks.

    Pairs of links without geometry are skipped: they cannot touch.
    """
    known = {verdict.links: verdict for verdict in verdicts.pairs}
    seen: set[frozenset[str]] = set()
    for pair in content.list_disabled(robot.link):
        if any(name not in robot.link for name in pair.links):
            yield Judgement(UNKNOWN, pair)
        elif pair.links in seen:
            yield Judgement(REPEATED, pair, known.get(pair.links))
        elif pair.links in known:
            yield Judgement(_judge(pair, known[pair.links]), pair, known[pair.links])
        seen.add(pair.links)
    for verdict in verdicts.pairs:
        if verdict.links not in seen and verdict.kind in (NEVER, ALWAYS, ADJACENT):
            missing = DisabledPair(None, verdict.link1, verdict.link2)
            yield Judgement(MISSING, missing, verdict)


def _judge(pair: DisabledPair, verdict: Verdict) -> str:
    """Return the code for a pair whose links have geometry."""
    if verdict.kind in (NEVER, ADJACENT, ALWAYS):
        return CONFIRMED
    if pair.reason in INTENDED:
        return INTENDED_CONTACT
    if pair.reason == "Adjacent":
        return BARE
    return {CAN_TOUCH: REFUTED, OPEN: UNPROVED}.get(verdict.kind, INTENDED_CONTACT)
