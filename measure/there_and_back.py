"""Robots of one format in the three other formats and back: ``python -m measure.there_and_back``.

Each file is exported to the other formats with ``--verify``, and each result back to the format of
the file, with ``--verify`` again. The table has what each step reported, by code, and the rows of
each proof that are not equal.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import NamedTuple

NAMES = {"urdf": "r.urdf", "sdf": "r.sdf", "mjcf": "r.xml", "usd": "r.usda"}
"""Name of the exported file, by format."""

LIMIT = 240
"""Longest time of one export [s]; a longer one is reported as not ended."""

UNCHANGED = ("equal", "none")
"""Verdicts of rows without a difference."""


class Step(NamedTuple):
    """What one export reported.

    Attributes:
        losses: Number of findings by code.
        rows: Verdicts of the rows of the proof that are not equal.
        error: Last message, if nothing was written.
    """

    losses: Counter[str]
    rows: dict[str, str]
    error: str = ""

    def __str__(self) -> str:
        """Return the cell of the table for the losses, and that for the proof."""
        if self.error:
            return f"not written: {self.error} | –"
        codes = (f"{code} {n}" if n > 1 else code for code, n in sorted(self.losses.items()))
        verdicts = sorted(set(self.rows.values()), key=lambda word: word != "differs")
        proof = [
            f"{word}: {', '.join(n for n in self.rows if self.rows[n] == word)}"
            for word in verdicts
        ]
        return f"{', '.join(codes) or '–'} | {'; '.join(proof) or 'equal'}"


def export(source: Path, target: str, place: Path, words: list[str]) -> Step:
    """Export a file with ``--verify`` and return what was reported."""
    command = [sys.executable, "-m", "urdftool", "export", target, str(source), "-o", str(place)]
    command += ["--verify", "--force", "--format", "json", *words]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return Step(Counter(), {}, f"did not end in {LIMIT} s")
    if not place.exists():
        lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        return Step(Counter(), {}, lines[0].replace("|", "/")[-160:])
    report = json.loads(done.stdout)
    losses = Counter(finding["rule"] for finding in report["findings"])
    rows = {row["check"]: row["verdict"] for row in report["checks"]}
    return Step(losses, {name: v for name, v in rows.items() if v not in UNCHANGED})


def measure(path: Path, own: str, words: list[str]) -> list[str]:
    """Return the lines of the table for a file of a format."""
    lines = []
    for target in (name for name in NAMES if name != own):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder)
            there = export(path, target, out / "there" / NAMES[target], words)
            back = Step(Counter(), {}, "no file")
            if not there.error:
                back = export(out / "there" / NAMES[target], own, out / "back" / NAMES[own], [])
        lines.append(f"| {path.parent.name}/{path.name} | {target} | {there} | {back} |")
        print(lines[-1], flush=True)
    return lines


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("own", choices=NAMES, help="format of the files")
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--package-path", action="append", default=[])
    options = parser.parse_args()
    words = [word for path in options.package_path for word in ("--package-path", path)]
    print(
        "| robot | format | losses | proof | losses back | proof back |", "|" + "---|" * 6, sep="\n"
    )
    lines = [line for path in options.files for line in measure(path, options.own, words)]
    print(f"{len(lines)} ways, {sum('differs:' in line for line in lines)} with a row that differs")


if __name__ == "__main__":
    main()
