"""Count what an export to the own format keeps: ``python -m measure.same_format``.

With files, the world poses of their parts are compared with those of their exports:
``python -m measure.same_format FILE.xml ...``.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from urdftool.errors import UrdftoolError

from .run import measure_mjcf
from .sdf import measure_sdf
from .states import compare_file


def main() -> int:
    """Print a row for each addition; return 1 if one is neither kept nor reported."""
    with tempfile.TemporaryDirectory() as name:
        results = [*measure_mjcf(Path(name)), *measure_sdf(Path(name))]
    for result in results:
        print(f"| {result.what} | {result.verdict} | {', '.join(result.codes)} |")
    lost = sum(result.verdict.startswith(("lost", "proof")) for result in results)
    print(f"{len(results)} additions, {lost} lost without a report")
    return int(lost > 0)


def compare_files(paths: list[str]) -> int:
    """Print a row for each MJCF with the largest differences; return 1 if there is one."""
    found = 0
    for path in paths:
        try:
            result = compare_file(Path(path))
        except (ValueError, UrdftoolError) as error:
            print(f"| {path} | not compared: {str(error)[:90]!r} |")
            continue
        found += bool(result.differing)
        worst = sorted(result.differing.items(), key=lambda item: -item[1])[:5]
        count = sum(result.compared.values())
        text = ", ".join(f"{name} {off:.1e}" for name, off in worst) or "equal"
        print(f"| {path} | {result.moved} | {count} | {text} | {', '.join(sorted(result.codes))} |")
    print(f"{len(paths)} files, {found} with a difference")
    return int(found > 0)


if __name__ == "__main__":
    sys.exit(compare_files(sys.argv[1:]) if sys.argv[1:] else main())
