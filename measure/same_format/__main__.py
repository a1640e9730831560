"""Count what an export to the own format keeps: ``python -m measure.same_format``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from .run import measure_mjcf
from .sdf import measure_sdf


def main() -> int:
    """Print a row for each addition; return 1 if one is neither kept nor reported."""
    with tempfile.TemporaryDirectory() as name:
        results = [*measure_mjcf(Path(name)), *measure_sdf(Path(name))]
    for result in results:
        print(f"| {result.what} | {result.verdict} | {', '.join(result.codes)} |")
    lost = sum(result.verdict.startswith(("lost", "proof")) for result in results)
    print(f"{len(results)} additions, {lost} lost without a report")
    return int(lost > 0)


if __name__ == "__main__":
    sys.exit(main())
