"""Measure ``urdftool server``: ``python -m measure.server [--write] [definitions] [changes]``.

Measured are the xacro robots of the corpus. ``--write`` writes the tables into
docs/measurements/server.md.
"""

from __future__ import annotations

import argparse
import sys

from .changes import EDITS, measure_changes
from .definitions import measure_definitions
from .page import format_changes, format_definitions, write_page
from .robots import CORPUS


def main() -> int:
    """Measure, print and write; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--missed", action="store_true", help="list what was not found")
    parser.add_argument("--edits", type=int, default=EDITS, help="edits of each robot")
    parser.add_argument("what", nargs="*", choices=["definitions", "changes", []])
    options = parser.parse_args()
    if not CORPUS.exists():
        print("skipped: the corpus is not next to the project", file=sys.stderr)
        return 2
    what = options.what or ["definitions", "changes"]
    parts = {}
    if "definitions" in what:
        found = measure_definitions()
        parts["definitions"] = format_definitions(found)
        if options.missed:
            print(*found.missed, sep="\n", file=sys.stderr)
    if "changes" in what:
        parts["changes"] = format_changes(measure_changes(options.edits))
    print("\n\n".join("\n".join(lines) for lines in parts.values()))
    if options.write:
        write_page(parts)
    return 0


if __name__ == "__main__":
    sys.exit(main())
