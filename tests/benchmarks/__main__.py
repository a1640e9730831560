"""``python -m tests.benchmarks [NAME …]``: time both sides in turn in one run, and print the table.

Machines are noisy: what counts are ratios of medians, each pair timed in turn. Nothing here passes
or fails; a number that got worse is for a reader to see.
"""

from __future__ import annotations

import sys

from . import expand, lint, simulate, startup, view

BENCHMARKS = {
    "startup": startup,
    "expand": expand,
    "lint": lint,
    "view": view,
    "simulate": simulate,
}


def main(names: list[str]) -> int:
    unknown = [name for name in names if name not in BENCHMARKS]
    if unknown:
        print(f"no benchmark is called {unknown[0]}; there are {', '.join(BENCHMARKS)}")
        return 2
    for name in names or BENCHMARKS:
        print(f"\n{name}: {(BENCHMARKS[name].__doc__ or '').strip().splitlines()[0]}")
        for line in BENCHMARKS[name].rows():
            print(f"  {line}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
