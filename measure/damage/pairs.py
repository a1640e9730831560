"""``python -m measure.damage.pairs [COUNT [SEED]]``: two random damages in one random robot.

Counted are pairs of which lint names both, or one; why one is not named, which the robot with that
damage alone shows: its finding waits for one of the pair (``caused_by``), or one of the pair has a
fix that ``reveals``; numbers that ``--fix --unsafe-fixes`` writes and that neither the damaged
file, the original nor a message has; and findings after fixing that the damaged robot did not have.
Those that the robot has with one of the damages, or with none, are counted separately: the other
damage hid them. Damages whose parts overlap are not planted together.
"""

from __future__ import annotations

import math
import random
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree

from urdftool.diagnostic import Severity
from urdftool.finding import Finding
from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.outcome import Report
from urdftool.lint.run import check_file
from urdftool.rules.table import FIXES

from .kinds import KINDS, Robot
from .robots import Sample, samples
from .run import findings, names, said

Known = set[tuple[str, str, str]]
"""What is said of a robot without damage."""

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


def plant(
    sample: Sample, kinds: Sequence[str], folder: Path, seed: int
) -> tuple[str, list[set[str]]] | None:
    """Plant damages; None if one has no place, or two have the same.

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


def find_alone(sample: Sample, kind: str, seed: int) -> tuple[list[Finding], set[str]]:
    """Return the findings of a robot with one damage, and the names that it hit."""
    with tempfile.TemporaryDirectory() as folder:
        planted = plant(sample, (kind,), Path(folder), seed)
        if planted is None:
            return [], set()
        return findings(planted[0], sample, Path(folder)), planted[1][0]


def explain_silence(sample: Sample, kind: str, seed: int, known: Known, new: list[Finding]) -> str:
    """Return why no finding of a pair names one of its damages.

    Args:
        sample: The robot.
        kind: The damage that is not named.
        seed: Of the damage.
        known: Findings of the robot without damage.
        new: Findings of the pair that the robot did not have.
    """
    alone, hit = find_alone(sample, kind, seed)
    own = [f for f in alone if said(f) not in known and names(f, hit)]
    if not own:
        return "not named without the other damage either"
    waits = {rule for finding in own if finding.cause for rule in finding.cause.rules}
    if any(finding.code in waits for finding in new):
        return "named by its cause"
    hiding = {f.code for f in new if f.code in FIXES and FIXES[f.code].reveals}
    hiding |= {f.code for f in new if f.kind == "file" and f.severity is Severity.ERROR}
    if hiding:
        return "hidden by a finding whose fix reveals"
    return f"neither named nor a cause: {sorted({f.code for f in own})}"


def find_appeared(
    sample: Sample, kinds: Sequence[str], seed: int, before: Report, after: Report
) -> tuple[list[tuple[str, str]], bool]:
    """Return the findings that a fixed pair has and the damaged one had not, and which are new.

    A part that a fix renamed is compared by the rule alone.

    Returns:
        Code and name of each, and whether a robot with one of the damages, or with none, has
        all of them: then the other damage hid them.
    """
    there = {(f.code, f.name) for f in before.findings}
    names_before = {f.name for f in before.findings}
    left = Counter(f.code for f in before.findings)
    left.subtract(f.code for f in after.findings if (f.code, f.name) in there)
    appeared = []
    for finding in after.findings:
        if (finding.code, finding.name) in there:
            continue
        left[finding.code] -= 1
        if finding.name in names_before or left[finding.code] < 0:
            appeared.append((finding.code, finding.name))
    hidden = set()
    for kind in kinds if appeared else ():
        hidden |= {(f.code, f.name) for f in find_alone(sample, kind, seed)[0]}
    with tempfile.TemporaryDirectory() as folder:
        if appeared:
            hidden |= {(f.code, f.name) for f in findings(sample.text, sample, Path(folder))}
    return sorted(appeared), set(appeared) <= hidden


def try_pair(sample: Sample, kinds: tuple[str, str], seed: int, known: Known) -> Iterator[str]:
    """Yield what is counted of one pair, or ``not planted``."""
    with tempfile.TemporaryDirectory() as folder:
        planted = plant(sample, kinds, Path(folder), seed)
        if planted is None:
            yield "not planted"
            return
        text, hit = planted
        new = [f for f in findings(text, sample, Path(folder)) if said(f) not in known]
        silent = [
            kind
            for kind, damaged in zip(kinds, hit, strict=True)
            if not any(names(f, damaged) for f in new)
        ]
        yield f"{2 - len(silent)} of 2 named"
        for kind in silent:
            why = explain_silence(sample, kind, seed, known, new)
            yield f"  not named: {why.partition(':')[0]}"
            yield f"    {sample.name} {kinds} {seed}, {kind}: {why}"
        path = Path(folder) / "robot.urdf"
        options = Options(packages=sample.packages, fixes=True)
        report = check_file(path, options)
        shown = " ".join(
            f"{f.message} {f.hint} {' '.join(x.message for x in f.fixes)}" for f in report.findings
        )
        done = fix_description(report, options, unsafe=True)
        for after in done.after.values():
            known_numbers = list_numbers(text + sample.text + shown) | {"0", "1"}
            unknown = _find_unknown(list_numbers(after.decode()), known_numbers)
            if unknown:
                yield "numbers of no message"
                yield f"    {sample.name} {kinds} {seed}: {unknown[:4]} by {dict(done.applied)}"
                break
        appeared, is_hidden = find_appeared(sample, kinds, seed, report, done.report)
        if appeared:
            hidden = "findings that the other damage hid" if is_hidden else ""
            yield hidden or "findings that were not there"
            what = f"{'hidden' if is_hidden else 'new'} {appeared[:3]} by {dict(done.applied)}"
            yield f"    {sample.name} {kinds} {seed}: {what}"


def main(count: int = 500, seed: int = 0) -> None:
    rng = random.Random(seed)
    robots = [sample for sample in samples() if len(sample.text) < 80_000]
    known: dict[str, Known] = {}
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
            if line.startswith("    "):
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
