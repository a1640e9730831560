"""``python -m measure.damage.pairs [COUNT [SEED]]``: two random damages in one random robot.

Counted are pairs of which lint names both, or one; numbers that ``--fix --unsafe-fixes`` writes and
that neither the damaged file, the original nor a message has; and findings after fixing that the
damaged robot did not have. Damages whose parts overlap are not planted together.
"""

from __future__ import annotations

import math
import random
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file

from .kinds import KINDS, Robot
from .robots import Sample, samples
from .run import findings, names, said

NUMBER = re.compile(r"(?<![\w.])-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def list_numbers(text: str) -> set[str]:
    """List the numbers of a text, without signs, with four digits."""
    return {f"{abs(float(number)):.4g}" for number in NUMBER.findall(text)}


def _find_unknown(numbers: set[str], known: set[str]) -> list[str]:
    """Find the numbers that no known one is equal to, but for rounding to four digits."""
    values = [float(number) for number in known]
    return sorted(
        number
        for number in numbers - known
        if not any(math.isclose(float(number), value, rel_tol=1e-3) for value in values)
    )


def plant_pair(
    sample: Sample, kinds: tuple[str, str], folder: Path, seed: int
) -> tuple[str, list[set[str]]] | None:
    """Plant two damages; None if one has no place, or both have the same.

    Returns:
        The damaged text, and the names that each damage hit.
    """
    root = ElementTree.fromstring(sample.text)
    robot = Robot(root, folder)
    hit: list[set[str]] = []
    for kind in kinds:
        try:
            damaged = KINDS[kind](robot, random.Random(f"{sample.path.stem} {kind} {seed}"))
        except (RecursionError, KeyError):  # the first damage is a circle, or a missing link
            return None
        if damaged is None or any(damaged & other for other in hit):
            return None
        hit.append(damaged)
    return ElementTree.tostring(root, encoding="unicode"), hit


def try_pair(
    sample: Sample, kinds: tuple[str, str], seed: int, known: set[tuple[str, str, str]]
) -> Iterator[str]:
    """Yield what is counted of one pair, or ``not planted``."""
    with tempfile.TemporaryDirectory() as folder:
        planted = plant_pair(sample, kinds, Path(folder), seed)
        if planted is None:
            yield "not planted"
            return
        text, hit = planted
        new = [f for f in findings(text, sample, Path(folder)) if said(f) not in known]
        named = sum(any(names(f, damaged) for f in new) for damaged in hit)
        yield f"{named} of 2 named"
        path = Path(folder) / "robot.urdf"
        options = Options(packages=sample.packages, fixes=True)
        report = check_file(path, options)
        before = {(f.code, f.name) for f in report.findings}
        shown = " ".join(
            f"{f.message} {f.hint} {' '.join(x.message for x in f.fixes)}" for f in report.findings
        )
        done = fix_description(report, options, unsafe=True)
        for after in done.after.values():
            known_numbers = list_numbers(text + sample.text + shown) | {"0", "1"}
            unknown = _find_unknown(list_numbers(after.decode()), known_numbers)
            if unknown:
                yield "numbers of no message"
                yield f"  {sample.name} {kinds}: {unknown[:4]} by {dict(done.applied)}"
                break
        appeared = {(f.code, f.name) for f in done.report.findings} - before
        if appeared:
            yield "findings that were not there"
            yield f"  {sample.name} {kinds}: {sorted(appeared)[:3]} by {dict(done.applied)}"


def main(count: int = 500, seed: int = 0) -> None:
    rng = random.Random(seed)
    robots = [sample for sample in samples() if len(sample.text) < 80_000]
    known: dict[str, set[tuple[str, str, str]]] = {}
    counts: Counter[str] = Counter()
    planted = 0
    while planted < count:
        sample = rng.choice(robots)
        if sample.name not in known:
            with tempfile.TemporaryDirectory() as folder:
                known[sample.name] = {said(f) for f in findings(sample.text, sample, Path(folder))}
        first, second = rng.sample(sorted(KINDS), 2)
        lines = list(try_pair(sample, (first, second), rng.randrange(10**6), known[sample.name]))
        planted += "not planted" not in lines
        for line in lines:
            if line.startswith("  "):
                print(line, flush=True)
            else:
                counts[line] += 1
        if planted % 25 == 0:
            print(planted, dict(counts), flush=True)
    print(f"{planted} pairs in {len(known)} robots")
    for what, number in sorted(counts.items()):
        print(f"{number:5} {what}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
