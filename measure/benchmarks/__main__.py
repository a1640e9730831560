"""``python -m measure.benchmarks [NAME …] [--write]``: time both sides in turn, and print tables.

Machines are noisy: what counts are ratios of medians, each pair timed in turn. Nothing here passes
or fails; a number that got worse is for a reader to see. ``--write`` puts each table into its
section of docs/measurements/benchmarks.md, and ``--list`` says which there are.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import time
import traceback
from types import ModuleType

from . import page, peers

BENCHMARKS = (
    "startup", "expand", "lint", "graph", "sdf", "mjcf", "inertia", "simplify", "collision",
    "coacd", "heavy", "simulate", "links", "files", "triangles", "view", "install",
)  # fmt: skip
"""The benchmarks, in the order of the page."""

LONG = ("coacd", "heavy", "install")
"""Those that take long, and run only when they are named."""

MODULES = {"inertia": "inertia_mesh"}


def main(words: list[str]) -> int:
    """Run what is named, or all that take no long time."""
    parser = argparse.ArgumentParser(prog="python -m measure.benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="without one, all but the long")
    parser.add_argument("--write", action="store_true", help=f"into {page.relative(page.PAGE)}")
    parser.add_argument("--list", action="store_true", help="name the benchmarks")
    arguments = parser.parse_args(words)
    unknown = [name for name in arguments.names if name not in BENCHMARKS]
    if unknown:
        parser.error(f"no benchmark is called {unknown[0]}; there are {', '.join(BENCHMARKS)}")
    if arguments.list:
        for name in BENCHMARKS:
            print(f"{name:10} {_title(_module(name))}{' (long)' if name in LONG else ''}")
        return 0
    if peers.python() is None:
        print(f"no other tools are at {peers.FOLDER}; make bench-peers installs them")
    begin = time.perf_counter()
    names = [name for name in BENCHMARKS if name in arguments.names] or [
        name for name in BENCHMARKS if name not in LONG
    ]
    failed = []
    for name in names:
        try:
            text = measure(name)
        except Exception:  # one that breaks must not cost the others
            traceback.print_exc()
            failed.append(name)
            continue
        print(f"\n{text}\n", flush=True)
        if arguments.write:
            page.write({name: text}, BENCHMARKS, LONG)
    print(f"{len(names)} benchmarks in {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    if failed:
        print(f"these did not run to their end: {', '.join(failed)}", file=sys.stderr)
    return int(bool(failed))


def measure(name: str) -> str:
    """The section of a benchmark, measured now."""
    print(f"{name}:", file=sys.stderr, flush=True)
    module = _module(name)
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0
    begin = time.perf_counter()
    blocks: list[str] = []
    bulleted = False
    for part in module.rows():
        line = isinstance(part, str)
        text = f"- {part}" if line else str(part)
        if line and bulleted:
            blocks[-1] += f"\n{text}"
        else:
            blocks.append(text)
        bulleted = line
    facts = page.conditions(getattr(module, "PEERS", ()), load)
    print(f"  {time.perf_counter() - begin:.0f} s", file=sys.stderr, flush=True)
    return page.section(
        name, _title(module), getattr(module, "ABOUT", ""), "\n\n".join(blocks), facts
    )


def _module(name: str) -> ModuleType:
    return importlib.import_module(f".{MODULES.get(name, name)}", __package__)


def _title(module: ModuleType) -> str:
    line = (module.__doc__ or "").strip().splitlines()[0]
    return line.replace("``", "`").rstrip(".")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
