"""Reports of edited robots as text and JSON."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..compare.rows import NOT_COMPARED
from ..compare.several import Agreement
from ..edit.finish import Edited, Proof
from .counted import format_count
from .exports import format_check_table
from .findings_json import build_finding_record
from .json_text import format_json
from .verification import format_text as format_differences

_UNPROVED = ("text of plugins", "gains of controllers", "recorded data", *NOT_COMPARED)


def to_json(output: str | None, written: Sequence[Path], edited: Edited) -> str:
    """Format the result of an operation as one object."""
    report = {
        "version": 1,
        "output": output,
        "files": sorted(map(str, written)),
        "findings": [build_finding_record(finding) for finding in edited.notes],
        "proofs": [
            {
                "source": proof.name,
                "map": [" ".join(words) for words in proof.lines],
                "equal": proof.comparison.is_equal,
                "checks": [check.as_dict() for check in proof.comparison.make_checks()],
                "not_comparable": proof.comparison.not_comparable,
                "skipped": dict(sorted(proof.comparison.skipped.items())),
            }
            for proof in edited.proofs
        ],
        "not_compared": list(_UNPROVED),
        "proved": edited.is_proved,
    }
    return format_json(report, 1) + "\n"


def format_text(edited: Edited) -> str:
    """Format the comparisons as tables, with the differences of those that are not equal."""
    return "\n".join(_format_proof(edited, proof) for proof in edited.proofs)


def _format_proof(edited: Edited, proof: Proof) -> str:
    comparison = proof.comparison
    title = f"compared with {proof.name}, by urdftool verify --map:\n"
    if not comparison.is_different:
        reasons: dict[str, list[str]] = {}
        for row, reason in comparison.skipped.items():
            reasons.setdefault(reason, []).append(row)
        rest = [f"{', '.join(sorted(rows))} ({reason})" for reason, rows in reasons.items()]
        missing = (*comparison.not_comparable, *rest, *_UNPROVED)
        return title + format_check_table(comparison.make_checks(), missing)
    agreement = Agreement(comparison.rows, {(0, 1): comparison})
    return title + format_differences([proof.name, "the result"], agreement)


def summarize(
    output: str | None, written: Sequence[Path], edited: Edited, lost: int, *, is_written: bool
) -> str:
    """Return the last line: files, what is not kept, and whether the result is proved."""
    joints = format_count(len(edited.robot.joints), "joint")
    place = output or "-"
    if not is_written:
        return f"{place}: not written, because it differs from what the operation declares"
    verdict = "equal except for what is declared" if edited.is_proved else "different"
    facts = [format_count(len(edited.robot.links), "link"), joints]
    if written:
        facts.append(format_count(len(written), "file"))
    facts.append(verdict)
    if lost:
        facts.append(f"{format_count(lost, 'warning')} above")
    return f"{place}: {', '.join(facts)}"
