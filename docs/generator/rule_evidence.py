"""The table of evidence: what is known of each rule, from runs, judged findings and real robots."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import urdftool
from urdftool.rules import get_all_rules
from urdftool.rules.rule import Rule

_PRECISION = Path(__file__).resolve().parents[2] / "measure" / "precision"
_RULES = Path(urdftool.__file__).parent / "rules"
_RUN = "run: "

VERDICTS = ("useful", "noise", "wrong")


@cache
def _read_json(path: Path) -> Any:
    return json.loads(path.read_text("utf-8"))


@cache
def count_verdicts() -> dict[str, Counter[str]]:
    """Count the verdicts of judged findings by rule."""
    found: dict[str, Counter[str]] = {}
    for line in (_PRECISION / "verdicts.jsonl").read_text("utf-8").splitlines():
        judged = json.loads(line)
        found.setdefault(judged["rule"], Counter())[judged.get("verdict", "")] += 1
    return found


def count_effects(rule: Rule) -> tuple[int, int, int]:
    """Count the effects of a rule that were run, that reject the robot, and that a source proves.

    An effect counts once, however many readers have it.
    """
    sources = _read_json(_RULES / "effect_sources.json").get(rule.name, {})
    kinds = _read_json(_RULES / "effect_kinds.json").get(rule.name, {})
    run = sum(how.startswith(_RUN) for how in sources.values())
    return run, sum("rejects" in of_kind for of_kind in kinds.values()), len(sources) - run


def list_evidence(rule: Rule) -> list[str]:
    """List the kinds of evidence of a rule: ``run``, ``source``, ``judged``, ``declared``."""
    run, _, source = count_effects(rule)
    useful = count_verdicts().get(rule.name, Counter())["useful"]
    kinds = (("run", run), ("source", source), ("judged", useful), ("declared", rule.evidence))
    return [kind for kind, there in kinds if there]


def write_evidence() -> Iterator[str]:
    """Yield the lines of the table."""
    fired = _read_json(_PRECISION / "fired.json")
    rules = list(get_all_rules())
    kinds = Counter(kind for rule in rules for kind in list_evidence(rule))
    bare = sum(not list_evidence(rule) for rule in rules)
    yield from ("", "## Evidence", "")
    yield (
        f"{kinds['run']} rules have an effect that was run in a reader, {kinds['source']} one that "
        f"is in the source of a reader, {kinds['judged']} a finding that was judged as useful, "
        f"{kinds['declared']} evidence of another kind; {bare} have none of these, and are about "
        "lint itself or off by default. "
        f"*fired* counts the files with a finding among {fired['files']} of example-robot-data, "
        "pybullet_data and 20 repositories, checked with the defaults; "
        "[judged findings](../measurements/lint-precision.md) are useful / noise / wrong. "
        "An effect may be that a reader takes the value as written."
    )
    yield ""
    yield "| rule | default | effects run | of which reject | effects by source | judged | fired |"
    yield "|---|---|---|---|---|---|---|"
    for rule in rules:
        run, rejecting, source = count_effects(rule)
        judged = count_verdicts().get(rule.name)
        verdicts = " / ".join(str(judged[one]) for one in VERDICTS) if judged else ""
        cells = [run, rejecting, source, verdicts, fired["rules"].get(rule.name, 0)]
        shown = " | ".join(str(cell) if cell else "" for cell in cells)
        yield f"| [{rule.name}]({rule.name}.md) | {'on' if rule.default else 'off'} | {shown} |"
    yield from _write_declared(rules)


def _write_declared(rules: list[Rule]) -> Iterator[str]:
    declared = [rule for rule in rules if rule.evidence]
    if declared:
        yield ""
    for rule in declared:
        yield f"- {rule.name}: {rule.evidence}"
