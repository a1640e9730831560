"""Lint of a robot before and after, and what is new."""

from __future__ import annotations

import random
import re
import tempfile
from pathlib import Path
from xml.etree import ElementTree

from urdftool.finding import Finding
from urdftool.lint.options import Options
from urdftool.lint.run import check_file

from .kinds import KINDS, Robot
from .robots import Sample


def findings(text: str, sample: Sample, folder: Path) -> list[Finding]:
    """What lint says of a robot."""
    path = folder / "robot.urdf"
    path.write_text(text, "utf-8")
    report = check_file(path, Options(packages=sample.packages))
    assert report.error is None, report.error
    assert not report.failed_rules, report.failed_rules
    return report.findings


def said(finding: Finding) -> tuple[str, str, str]:
    """What makes a finding another one."""
    return finding.code, finding.name, finding.message


def names(finding: Finding, damaged: set[str]) -> bool:
    """Whether a finding is about one of the damaged things, or names it."""
    if finding.name in damaged:
        return True
    quoted = set(re.findall(r"'([^']*)'", finding.message))
    quoted |= {name for name, _ in finding.others}
    return not quoted.isdisjoint(damaged)


def list_said(sample: Sample) -> set[tuple[str, str, str]]:
    """List what lint says of a robot without damage."""
    with tempfile.TemporaryDirectory() as folder:
        return {said(finding) for finding in findings(sample.text, sample, Path(folder))}


def try_damage(
    sample: Sample, before: set[tuple[str, str, str]], kind: str, seed: int
) -> tuple[bool, str] | None:
    """Whether a damage raises a new finding that names it, and what is new.

    None where the robot has nothing that can be damaged so.

    Args:
        sample: The robot.
        before: What lint says of it without damage: :func:`list_said`.
        kind: The damage.
        seed: What chooses the damaged element.
    """
    with tempfile.TemporaryDirectory() as folder:
        root = ElementTree.fromstring(sample.text)
        robot = Robot(root, Path(folder))
        damaged = KINDS[kind](robot, random.Random(f"{sample.path.stem} {kind} {seed}"))
        if damaged is None:
            return None
        text = ElementTree.tostring(root, encoding="unicode")
        new = [f for f in findings(text, sample, Path(folder)) if said(f) not in before]
        hits = [f for f in new if names(f, damaged)]
        what = ", ".join(sorted({f.code for f in hits or new}))
        return bool(hits), f"{sorted(damaged)}: {what}"


def table(samples: list[Sample], seeds: int = 1, kinds: list[str] | None = None):
    """For each kind of damage: how many mutants, how many found, and those that were not."""
    rows = {}
    before = [list_said(sample) for sample in samples]
    for kind in kinds or KINDS:
        tried = found = 0
        missed = []
        for sample, known in zip(samples, before, strict=True):
            for seed in range(seeds):
                result = try_damage(sample, known, kind, seed)
                if result is None:
                    continue
                tried += 1
                found += result[0]
                if not result[0]:
                    missed.append(f"{sample.name} {result[1]}")
        rows[kind] = tried, found, missed
    return rows
