"""Published SRDF files, each pair proved, refuted with a pose, or open: the table of a page."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from urdftool.errors import UrdftoolError
from urdftool.model.load import load
from urdftool.srdf.content import format_positions
from urdftool.srdf.existing import (
    BARE,
    CONFIRMED,
    INTENDED_CONTACT,
    REFUTED,
    REPEATED,
    UNKNOWN,
    UNPROVED,
    Judgement,
    judge,
    read_srdf,
)
from urdftool.srdf.verdicts import CAN_TOUCH, Options, decide

COLUMNS = (CONFIRMED, REFUTED, BARE, UNPROVED, INTENDED_CONTACT)


def judge_file(robot_path: Path, path: Path, boxes: int) -> list[Judgement]:
    """Judge the pairs of an SRDF; those that it lacks are not looked at.

    Args:
        robot_path: The description.
        path: The SRDF.
        boxes: Largest number of boxes for each two bodies.
    """
    robot = load(robot_path)
    content = read_srdf(path, {}, None)
    pairs = frozenset(pair.links for pair in content.disabled)
    return list(judge(content, robot, decide(robot, Options(boxes=boxes, jobs=1, only=pairs))))


def format_row(name: str, found: list[Judgement], pairs: int) -> str:
    """Format the row of a file."""
    counts = Counter(judgement.code for judgement in found)
    others = counts[UNKNOWN] + counts[REPEATED]
    return f"| {name} | {pairs} | " + " | ".join(str(counts[c]) for c in COLUMNS) + f" | {others} |"


def list_poses(name: str, found: list[Judgement]) -> Iterator[str]:
    """Yield a row for each disabled pair that can touch."""
    for judgement in found:
        pair, verdict = judgement.pair, judgement.verdict
        if judgement.code not in (REFUTED, BARE) or verdict is None or verdict.kind != CAN_TOUCH:
            continue
        reason, at = pair.reason or "none", format_positions(verdict.positions)
        yield f"| {name} | {pair.link1}, {pair.link2} | {reason} | {at} |"


def main() -> None:
    """Print the rows of the files: pairs of arguments ROBOT SRDF after the number of boxes."""
    boxes, *paths = sys.argv[1:]
    for robot, path in zip(paths[::2], paths[1::2], strict=True):
        name = Path(path).name
        try:
            found = judge_file(Path(robot), Path(path), int(boxes))
        except UrdftoolError as error:
            print(f"{name}: {error}", file=sys.stderr)
            continue
        pairs = len(read_srdf(path, {}, None).disabled)
        print("\n".join([format_row(name, found, pairs), *list_poses(name, found)]), flush=True)


if __name__ == "__main__":
    main()
