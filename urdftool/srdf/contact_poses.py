"""Poses at which links touch: of all pairs, and of those that an SRDF disables."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from ..model.elements import Robot
from ..model.pair_pose import PairPose
from ..model.semantic import SemanticDescription
from .existing import BARE, INTENDED, REFUTED, Judgement, check_robot, judge, read_srdf
from .verdicts import CAN_TOUCH, Options, Progress, Verdicts, decide


def list_contact_poses(verdicts: Verdicts) -> list[PairPose]:
    """List the pairs that can touch, in the order of the file."""
    return [PairPose(v.link1, v.link2, v.positions) for v in verdicts.pairs if v.kind == CAN_TOUCH]


def list_disabled_contacts(found: Iterable[Judgement]) -> list[PairPose]:
    """List the pairs that an SRDF disables, unintended, and that can touch."""
    return [
        PairPose(j.pair.link1, j.pair.link2, j.verdict.positions, j.pair.reason)
        for j in found
        if j.code in (REFUTED, BARE) and j.verdict is not None and j.verdict.kind == CAN_TOUCH
    ]


def find_disabled_contacts(
    robot: Robot,
    path: str | Path,
    arguments: dict[str, str],
    options: Options | None = None,
    progress: Progress | None = None,
) -> list[PairPose]:
    """Find the pairs that an SRDF file disables, unintended, and that can touch.

    Raises:
        SourceError: The SRDF cannot be read.
        ModelError: It is not an SRDF, or of another robot.
        MissingDependency: python-fcl is not installed.
    """
    content = read_srdf_of(robot, path, arguments)
    options = replace(options or Options(), only=_list_unintended(robot, content))
    verdicts = decide(robot, options, progress)
    return list_disabled_contacts(judge(content, robot, verdicts))


def read_srdf_of(robot: Robot, path: str | Path, arguments: dict[str, str]) -> SemanticDescription:
    """Read an SRDF, and check that it belongs to a robot.

    Raises:
        SourceError: The SRDF cannot be read.
        ModelError: It is not an SRDF, or of another robot.
    """
    packages = robot.source.packages if robot.source is not None else None
    content = read_srdf(path, arguments if str(path).endswith(".xacro") else {}, packages)
    check_robot(robot, content)
    return content


def _list_unintended(robot: Robot, content: SemanticDescription) -> frozenset[frozenset[str]]:
    pairs = content.list_disabled(robot.link)
    return frozenset(pair.links for pair in pairs if pair.reason not in INTENDED)
