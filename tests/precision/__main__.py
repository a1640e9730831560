"""``python -m tests.precision``: draw findings of real robots by rule, for a person to judge.

    python -m tests.precision [--seed N] [--count N]     draws, and prints them as JSON lines
    python -m tests.precision --page                     writes docs/lint-precision.md

The descriptions of example-robot-data, pybullet_data and the corpus, where they are installed, are
checked with the defaults. Rules are shuffled and gone through in turn; each time one of the rule's
findings that were not drawn yet is drawn, at most one of a robot and rule. A verdict is a line as
drawn with ``verdict`` (useful, noise or wrong) and ``reason``, written by somebody who read the
finding beside the source and, where it speaks of a reader, asked that reader. They are kept in
``verdicts.jsonl``.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from tests.benchmarks.robots import CORPUS, ROOT, bullet_robots, example_folder, example_robots
from urdftool.finding import Finding
from urdftool.lint.discover import find_descriptions
from urdftool.lint.outcome import Options
from urdftool.lint.parallel import lint_files

PAGE = ROOT / "docs" / "lint-precision.md"
KEPT = Path(__file__).with_name("verdicts.jsonl")
SEED = 2026
VERDICTS = ("useful", "noise", "wrong")


def descriptions() -> dict[str, str]:
    """Find the descriptions: path by the name that is shown, which starts with the collection."""
    found: dict[str, str] = {}
    examples = example_folder()
    for path in example_robots():
        assert examples is not None
        found[f"example-robot-data/{path.relative_to(examples)}"] = str(path)
    for path in bullet_robots():
        parts = path.parts
        found["/".join(parts[parts.index("pybullet_data") :])] = str(path)
    if CORPUS.exists():
        for name in find_descriptions([str(CORPUS)]):
            found[f"corpus/{Path(name).relative_to(CORPUS)}"] = name
    return found


def draw(seed: int, count: int) -> list[dict[str, Any]]:
    """Draw findings, the same for the same seed, rules and robots."""
    named = descriptions()
    by_rule: dict[str, list[tuple[str, Finding]]] = {}
    reports = lint_files(list(named.values()), Options())
    for name, report in zip(named, reports, strict=True):
        for finding in report.findings:
            by_rule.setdefault(finding.rule, []).append((name, finding))
    chance = random.Random(seed)
    rules = sorted(by_rule)
    chance.shuffle(rules)
    for rule in rules:
        chance.shuffle(by_rule[rule])
    drawn: list[dict[str, Any]] = []
    seen: set[tuple[str, str]] = set()
    while len(drawn) < count and any(by_rule.values()):
        for rule in rules:
            while by_rule[rule]:
                name, finding = by_rule[rule].pop()
                if (rule, name) not in seen:
                    seen.add((rule, name))
                    drawn.append(_record(len(drawn) + 1, name, named[name], finding))
                    break
    return drawn[:count]


def _record(number: int, name: str, path: str, finding: Finding) -> dict[str, Any]:
    return {
        "number": number,
        "robot": name,
        "path": path,
        "file": finding.place.path,
        "line": finding.place.line,
        "rule": finding.rule,
        "severity": finding.severity.label,
        "message": finding.message,
        "hint": finding.hint,
        "effects": finding.effects,
        "expansions": finding.expansions,
    }


def judged() -> list[dict[str, Any]]:
    """Read the verdicts."""
    text = KEPT.read_text("utf-8")
    return [json.loads(line) for line in text.splitlines() if line.strip()]


def page(rows: list[dict[str, Any]], seed: int) -> str:
    """Write the page: the counts, and a row for each finding."""
    counts = Counter(row["verdict"] for row in rows)
    share = {verdict: counts[verdict] / len(rows) for verdict in VERDICTS}
    lines = [
        "# How precise lint is",
        "",
        f"{len(rows)} findings of real robots (example-robot-data, pybullet_data, descriptions",
        "of public repositories), drawn by rule with",
        f"`python -m tests.precision --seed {seed}`, were each read beside the source, and what",
        "they say of a reader was compared with what that reader does. *Useful*: a maintainer",
        "would change the file or wants to know. *Noise*: true, but nobody would act on it.",
        "*Wrong*: not true, or its advice makes the robot worse, or a sentence about any reader is",
        "false in this case. Each rule counts the same here, however rare its findings are. The",
        "findings are those before what was learned from them was changed in the rules.",
        "",
        "| verdict | findings | share |",
        "|---|---:|---:|",
        *(f"| {v} | {counts[v]} | {share[v]:.1%} |" for v in VERDICTS),
        "",
        "| # | robot | rule | finding | verdict | why |",
        "|---:|---|---|---|---|---|",
    ]
    for row in rows:
        assert row["verdict"] in VERDICTS, row
        place = f"{row['robot']}:{row['line']}"
        message = _cell(f"{row['severity']}: {row['message']}")
        lines.append(
            f"| {row['number']} | {_cell(place)} | [{row['rule']}](rules/{row['rule']}.md) "
            f"| {message} | {row['verdict']} | {_cell(row['reason'])} |"
        )
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "\\<").replace("*", "\\*").replace("\n", " ")


def main(words: list[str]) -> int:
    """Draw, or write the page."""
    parser = argparse.ArgumentParser(prog="python -m tests.precision")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--count", type=int, default=120)
    parser.add_argument("--page", action="store_true", help="write docs/lint-precision.md")
    arguments = parser.parse_args(words)
    if arguments.page:
        PAGE.write_text(page(judged(), arguments.seed), "utf-8")
        return 0
    for row in draw(arguments.seed, arguments.count):
        print(json.dumps(row, ensure_ascii=False))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
