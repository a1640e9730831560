"""Run the readers of the table: ``python -m tests.effects [--write | --pages] [RULE…]``.

Without ``--write`` it prints what is not as expected; with it, what the readers did is recorded,
and what rule pages quote is made of it. Further versions of readers are found in the folder that
``URDFTOOL_READERS`` names, where ``python -m tests.effects.install`` puts them.
"""

from __future__ import annotations

import argparse
import json
import sys
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from . import table
from .readers import READERS, installed, read


def main() -> int:
    """Run what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="Record what the readers did.")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--missing", action="store_true", help="Run only what has no record.")
    parser.add_argument("rules", nargs="*")
    parser.add_argument("--pages", action="store_true", help="Write only what rule pages quote.")
    arguments = parser.parse_args()
    if arguments.pages:
        write_packaged()
        return 0
    there = installed()
    for name in READERS.keys() - there.keys():
        print(f"{name} is not installed; its records are kept", file=sys.stderr)
    for name in there:
        READERS[name].command()  # compiles it once, before there are threads
    wanted = {r: p for r, p in table.pairs().items() if not arguments.rules or r in arguments.rules}
    with ThreadPoolExecutor(arguments.jobs) as pool:
        records = pool.map(lambda rule: record(rule, there, arguments.missing), wanted)
        found = dict(zip(wanted, records, strict=True))
    wrong = 0
    for row in table.rows():
        for run in row.runs:
            if run.rule in found and run.reader in found[run.rule].get(run.robot, {}):
                for line in run.wrong(found[run.rule]):
                    wrong += 1
                    print(f"{run.rule}: {run.reader}: {run.robot}: {line}")
    if arguments.write:
        write(found, there, everything=not arguments.rules)
    return 1 if wrong else 0


def record(rule: str, there: dict[str, str], only_missing: bool) -> dict[str, dict[str, Any]]:
    """Run all of a rule; a reader that is not installed keeps its record."""
    old = table.record_of(rule)
    new: dict[str, dict[str, Any]] = {}
    for robot, readers in sorted(table.pairs()[rule].items()):
        for reader in sorted(readers):
            kept = old.get(robot, {}).get(reader)
            if kept is not None and (only_missing or reader not in there):
                new.setdefault(robot, {})[reader] = kept
            elif reader in there:
                new.setdefault(robot, {})[reader] = read(reader, table.robot_of(rule, robot))
    uses_text = any(
        path.partition(".")[0] == "sdf"
        for row in table.rows()
        if row.rule == rule
        for run in row.runs
        for path in run.expected
    )
    if not uses_text:
        for facts in (facts for readers in new.values() for facts in readers.values()):
            facts.pop("sdf", None)
    return new


def write(found: dict[str, dict[str, Any]], there: dict[str, str], *, everything: bool) -> None:
    """Write records, versions, and what rule pages quote."""
    table.RUNS.mkdir(exist_ok=True)
    for rule, record_ in found.items():
        (table.RUNS / f"{rule}.json").write_text(as_text(record_), "utf-8")
    if everything:
        for path in table.RUNS.glob("*.json"):
            if path.stem not in found:
                path.unlink()
    old = table.versions() if table.VERSIONS.exists() else {}
    titles = {**old, **{name: f"{READERS[name].title} {v}" for name, v in there.items()}}
    table.VERSIONS.write_text(json.dumps(titles, indent=1, sort_keys=True) + "\n", "utf-8")
    write_packaged()


def as_text(record_: dict[str, dict[str, Any]]) -> str:
    """A record as JSON, a line a run."""
    lines = []
    for robot, readers in record_.items():
        runs = [f"  {json.dumps(name)}: {json.dumps(facts)}" for name, facts in readers.items()]
        lines.append(f" {json.dumps(robot)}: {{\n" + ",\n".join(runs) + "\n }")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def write_packaged() -> None:
    """Write what rule pages quote, of the table and the recorded versions, a line a rule."""
    for path, record_ in (
        (table.PACKAGED, table.packaged()),
        (table.KINDS, table.kinds()),
    ):
        rules = (json.dumps({name: facts}, ensure_ascii=False) for name, facts in record_.items())
        path.write_text("{\n" + ",\n".join(rule[1:-1] for rule in rules) + "\n}\n", "utf-8")


if __name__ == "__main__":
    sys.exit(main())
