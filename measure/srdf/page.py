"""The page of the numbers of ``urdftool srdf``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

Results = Mapping[str, dict[str, Any]]

HEAD = """\
# Numbers of the proofs of `srdf`

Robots are those of the packages example-robot-data and pybullet; `python -m measure.srdf` repeats
all of this. Times are processor time of one process on a machine that was shared. A package may
have the same arm twice.

## Decided pairs

*Pairs* are those of links with collision geometry that are not adjacent. *Candidates* are those
that 10,000 random poses do not show in contact, so that MoveIt's Setup Assistant would disable
them; known for arms, on which its sampling was repeated. A candidate is decided if it is proved
or a contact was found.
"""

SAMPLED = """\
## Proved pairs, at random poses

Random poses of all joints within their limits, uniform, and a directed search on each proved
pair: Powell's method on the distance of FCL, from the random poses at which the spheres around
parts of the links are nearest. The poses of the links are computed by another program than that
of the proof, in `measure/`, and contacts are those of FCL. The number of poses was a
million, or what the processor time allowed. *Contacts* are of proved pairs.
"""

MOVEIT = """\
## MoveIt's way, repeated

The steps of MoveIt's `compute_default_collisions.cpp`, written again from their description:
adjacent links (a link without geometry connects its neighbors), links that touch at the default
pose, in more than 95 % of 200 poses, or in none of 10,000 random poses. MoveIt itself was not
run. *Wrong* are the pairs that were never seen in contact, and that touch at a pose that `srdf`
found.
"""

BOXES = """\
## Boxes, checked by coal

All proofs of a robot, with each pair of convex pieces that was cleared in a box: coal finds their
distance at the center of the box and at a random one of its corners, with the poses of another
program. The boxes in which two pieces were cleared fill all joint positions; the last column is
the least part that they fill. A disagreement is a contact of more than 0.1 mm. These are the proofs
with all joints; `tests/srdf/test_sweep.py` tests that swept links contain the links.
"""


def format_page(decided: Results, sampled: Results, boxes: Results) -> str:
    """Format the page.

    Args:
        decided: Verdicts by robot.
        sampled: Random poses and MoveIt's steps by robot.
        boxes: Answers of coal by robot.
    """
    parts = [HEAD, *_list_decided(decided, sampled), "", SAMPLED, *_list_sampled(sampled), ""]
    parts += [MOVEIT, *_list_moveit(decided, sampled), "", BOXES, *_list_boxes(boxes)]
    return "\n".join([*parts, ""])


def find_candidates(verdicts: dict[str, Any], matrix: dict[str, Any]) -> list[str]:
    """Return the verdicts on the pairs that the sampling would disable as never in contact."""
    kinds = {frozenset(pair["links"]): pair["verdict"] for pair in verdicts["pairs"]}
    found = [kinds.get(frozenset(pair), "adjacent") for pair in matrix["never"]]
    return [kind for kind in found if kind != "adjacent"]


def find_wrong(verdicts: dict[str, Any], matrix: dict[str, Any]) -> list[list[str]]:
    """Return the pairs that the sampling disables as never in contact, and that can touch."""
    kinds = {frozenset(pair["links"]): pair["verdict"] for pair in verdicts["pairs"]}
    return [pair for pair in matrix["never"] if kinds.get(frozenset(pair)) == "can-touch"]


def _list_decided(decided: Results, sampled: Results) -> Iterator[str]:
    names = "robot, class, pairs, never, can touch, open, decided, candidates, decided of these"
    yield _format_heads(f"{names}, time [s]")
    yield "|---|---|---|---|---|---|---|---|---|---|"
    sums: dict[str, list[int]] = {}
    for name, result in decided.items():
        count = result["summary"]
        pairs = sum(count.values()) - count["adjacent"]
        left = count["open"]
        matrix = sampled.get(name, {}).get("moveit")
        matrix = matrix if matrix and matrix["pairs"] else None
        candidates = find_candidates(result, matrix) if matrix else []
        known = sum(kind != "open" for kind in candidates)
        total = sums.setdefault(result["kind"], [0, 0, 0, 0])
        for index, value in enumerate((pairs, pairs - left, len(candidates), known)):
            total[index] += value
        of_them = f"{len(candidates)} | {known}" if matrix else "– | –"
        yield (
            f"| {name} | {result['kind']} | {pairs} | {count['never']} | {count['can-touch']} "
            f"| {left} | {_share(pairs - left, pairs)} | {of_them} | {result['seconds']:.1f} |"
        )
    for kind, (pairs, done, candidates_of, known) in sums.items():
        of_them = f"{candidates_of} | {_share(known, candidates_of)}" if candidates_of else "– | –"
        yield f"| all | {kind} | {pairs} | | | | {_share(done, pairs)} | {of_them} | |"


def _format_heads(names: str) -> str:
    return "| " + " | ".join(names.split(", ")) + " |"


def _share(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f} %" if whole else "–"


def _list_sampled(sampled: Results) -> Iterator[str]:
    names = (
        "robot, proved pairs, random poses, contacts, distances of the search, contacts, nearest"
    )
    yield _format_heads(names)
    yield "|---|---|---|---|---|---|---|"
    poses = contacts = found = 0
    for name, result in sampled.items():
        r = result["proved"]
        seen = sum(r["contacts"].values())
        nearest = "–" if r["nearest"] is None else f"{r['nearest'] * 1000:.2f} mm"
        poses, contacts, found = poses + r["poses"], contacts + seen, found + len(r["found"])
        yield (
            f"| {name} | {r['searched']} | {r['poses']:,} | {seen} | {r['distances']:,} "
            f"| {len(r['found'])} | {nearest} |"
        )
    yield f"| all {len(sampled)} | | {poses:,} | {contacts} | | {found} | |"


def _list_moveit(decided: Results, sampled: Results) -> Iterator[str]:
    yield "| robot | adjacent | default | always | never | of these wrong | time [s] |"
    yield "|---|---|---|---|---|---|---|"
    for name, result in sampled.items():
        m = result["moveit"]
        if not m or not m["pairs"]:
            continue
        wrong = find_wrong(decided[name], m)
        names = ": " + "; ".join(", ".join(pair) for pair in wrong) if wrong else ""
        counts = " | ".join(str(len(m[key])) for key in ("adjacent", "default", "always", "never"))
        yield f"| {name} | {counts} | {len(wrong)}{names} | {m['seconds']:.1f} |"


def _list_boxes(boxes: Results) -> Iterator[str]:
    names = "robot, proofs, boxes, cleared pairs of pieces, poses asked, disagreements, filled"
    yield _format_heads(names)
    yield "|---|---|---|---|---|---|---|"
    for name, r in boxes.items():
        yield (
            f"| {name} | {r['proofs']} | {r['boxes']:,} | {r['claims']:,} | {r['poses']:,} "
            f"| {r['disagreements']} | {r['least_filled']:.9f} |"
        )
