"""``python -m measure.precision``: draw findings of real robots, for a person to judge.

    python -m measure.precision [--by finding|rule] [--only robots] [--seed N] [--count N] [FOLDER…]
    python -m measure.precision --page

The first prints JSON lines, the second writes the page.

The descriptions of example-robot-data, pybullet_data and the corpus, where they are installed, or
those below the folders are checked with the defaults. Findings are drawn from all, or from the
rules in turn, at most one of a robot and rule. ``--only robots`` leaves out what ``robots.py``
knows to be no robot: inputs of tests of parsers, steps of lessons, and objects without a moving
joint. A verdict is a line as drawn with ``verdict`` (useful, noise or wrong) and ``reason``,
written by somebody who read the finding beside the source and, where it speaks of a reader, asked
that reader. They are kept in ``verdicts.jsonl``.
"""

from __future__ import annotations

import argparse
import json
import random
import re
import sys
from collections import Counter
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any

from measure.benchmarks.robots import CORPUS, ROOT, bullet_robots, example_folder, example_robots
from measure.precision.robots import is_robot
from urdftool.finding import Finding
from urdftool.lint.discover import find_descriptions
from urdftool.lint.group import group
from urdftool.lint.options import Options
from urdftool.lint.parallel import check_files
from urdftool.lint.robot_search import find_robots

PAGE = ROOT / "docs" / "measurements" / "lint-precision.md"
KEPT = Path(__file__).with_name("verdicts.jsonl")
HEAD = """\
# How precise lint is

Readers compared findings on real robots (example-robot-data, pybullet_data, descriptions of public
repositories) with the source, and each statement about a simulator with that simulator.

## Scale

A finding is one entry as `lint FOLDER` prints it with the defaults; a group is one. The reader
takes the first verdict that holds:

1. *Wrong*: the message, a number, the advice or one printed effect is false of this file in a
   reader that was run, or the robot is worse if the advice is followed. One false effect is enough.
2. *Noise*: all is true, but nothing is to be done. One of these must be shown:
   - No reader that the project uses gives another result after the change. Its dependencies,
     imports and launch files say which these are; without any, they are those of the effects.
   - The value is meant: a comment, the code that loads the file, or the maker's data shows it.
   - One edit for another finding of the same run cures this one too (`"repeats": true`). If the
     file has to be edited at this place as well, the finding has its own verdict.
3. *Useful*: the rest. A maintainer changes the file, or has to know it to use the robot in one of
   the readers that are named.

A copied model is judged as by its maker, and a file that no code loads as if it were loaded. An
error that no named reader rejects, or loads as another robot, is marked `"error": false`.

All samples but the last six were judged before this scale was written: *useful* was what a
maintainer would change or needs to know, and *noise* what is true and requires no action.

## Samples

`python -m measure.precision` draws a sample: `--by finding` from all findings, as
users meet them; `--by rule` from the rules in turn, so that rare rules count as much as common
ones. At most one finding of a rule and robot is drawn. `--only robots` leaves out test files of
parsers, steps of lessons and objects without a moving joint (`measure/precision/robots.py`), where
no reader can decide what should change. The samples were drawn before rules were changed because
of them. The collections contain test files of parsers and steps of lessons; the readers of seed
11235 counted true findings there as noise (23 of 35), earlier readers did not. The samples
"packages" are of 48 robots, at most four of each of 15 packages of PyPI that no test uses, drawn
with seed 4711; one reader looked the elements up in the files, or judged by the message where the
reason names it, and ran a simulator only where the reason names the run. Rules were changed
later. So were seeds 4721 and 4722 drawn, of 73 other robots: mani_skill, compas_fab, phosphobot,
reachy_mini, hex_util_urdf, rex_gym and three more packages, and robots of the 15 packages that were
not drawn before. After the kinds of findings that were noise or wrong there had been changed, seeds
9101 and 9102 ("again") were drawn of 37 robots of these packages that no sample has; the two wrong
findings among them were of a kind that was changed afterwards. One reader; numbers were recomputed,
contacts with coal, and loading with PyBullet and pinocchio, where the reason names it. The reader
of seed 4711 called some findings useful that are of kinds which the reader of 4721 found wrong
(`joint-not-mirrored` of iCub, visuals in glTF files that were turned); they stand as they were
judged. Seeds 52711 and 52712 ("independent") were drawn of 76 robots of nine packages of PyPI that
no earlier sample has, and were judged by a reader who had changed no rule, and who recomputed
numbers, compared contacts with coal and FCL, and ran MuJoCo and PyBullet, where the reason names
it. A line with `"error": false` is an error that deserved a lower severity. The kinds of findings
that were wrong there were changed afterwards, so these counts are of the rules before. After that,
seeds 61001 and 61002 were drawn of the packages of all these samples, and judged by a third reader,
who had changed no rule and saw no other verdict. Seeds 71001 and 71002 ("unseen") were drawn of 91
robots of nine packages, eight of which no earlier sample has, after many kinds of noise had been
changed, and judged by a fourth reader, who ran the readers for each file that they load. Five of
the seven wrong findings are of kinds that were changed afterwards. Seeds 81001 and 81002 ("new")
were drawn of 82 robots of 13 packages that no earlier sample has, after cases of rules that were
mostly noise had been put off by default, and judged by a fifth reader. Five of the six wrong
findings are true but for an effect: MuJoCo does not find the mesh whose convex hull it is to use.
The sixth expects MuJoCo to reject a mesh which `<compiler meshdir>` lets it find. Later, some more
cases were put off by default. Seeds 91001 and 91002 ("stricter") were drawn of 18 packages that no
earlier sample has, and that gave only 148 findings, by a sixth reader with a stricter scale: one
cause in several findings counts as useful once and else as noise, and a finding about dynamics is
noise in a package that computes kinematics only. The two samples share 36 findings. After them,
findings were grouped, and those put off by default that concern no reader which the package
imports, or that are about markers. Seeds 92001 and 92002 ("grouped") were drawn then,
of 17 packages that no earlier sample has and that gave 134 findings, by a seventh reader; the two
samples share 23. Nine of the 16 wrong ones of both are true but for an effect: MuJoCo rejects a
robot with `package://` URIs, whose remaining effects are stated as if these had been replaced.
Seeds 100101 and 100102 ("by the scale") were drawn of 20 packages that no earlier sample has and
that gave 433 findings, and judged by an eighth reader by the scale above; they share 11. Readers of
47 of their 109 findings could also take another verdict, which the reason names. Infos were useful
in 25 %, warnings in 47 %, errors in 76 %. Afterwards infos of some rules, and some rules that are
infos, were put off by default, and findings of one cause in several files became one.
Seeds 110111 and 110112 ("after the scale") were drawn of 30 packages that no earlier sample has and
that gave 253 findings, and judged by a ninth reader by the scale above; they share 18. Of the 19
wrong findings of both, 17 are true but for an effect, most of them on Gazebo, which rejects the
robot for two links of mass 0. The two of `axis-not-unit` are true of positions: PyBullet normalizes
the axis there, but not for torques and gravity (run later). Afterwards targets came from what a
project imports, effects on readers that do not get the robot or the part were left out, and some
kinds that were noise were put off by default.
Seeds 130113 and 130114 ("readers by imports") were drawn of 20 packages that no earlier sample has
and that gave 160 findings, 59 of them of one package for Drake, and judged by a tenth reader by the
scale above; they share 24. Infos were useful in 19 %, warnings in 55 %, errors in 31 %. Six of
the ten wrong findings are about robots for Drake or Tesseract, which were no known readers.
Afterwards they became readers, dynamics are left out where the code computes none, infos are on
only of rules whose infos were useful, and many conditions were added (`test_judged_strictly.py`).
Seeds 150115 and 150116 ("infos off") were drawn of 17 packages that no earlier sample has, nine of
which gave no finding and one 55 of the 110, and judged by an eleventh reader by the scale above;
they share 16. Errors were useful in 11 of 31, warnings in 16 of 36. Of the noise, ten findings are
about tensors that PyBullet does not take from the file, of robots which the project's code loads
without the flag for that, and five about names that stand twice in text that xacro would leave out.
"""
RULES = """\
## Rules with findings that were wrong

{judged_wrong} of {rules} rules have a finding that was wrong when it was judged; these have {often}
or more. The page of a rule has its own counts.
[measure/precision/verdicts.jsonl](https://github.com/urdftool/urdftool/blob/main/measure/precision/verdicts.jsonl)
has every finding with its verdict and the reason, one JSON object in each line:
`grep '"rule": "missing-dynamics"' measure/precision/verdicts.jsonl`.
"""
OFTEN = 4
"""Wrong findings of a rule for which it is listed: chosen, so that the table is short."""
VERDICTS = ("useful", "noise", "wrong")


def descriptions(only_robots: bool = False) -> dict[str, str]:
    """Find the descriptions: path by the name that is shown, which starts with the collection.

    Args:
        only_robots: Whether to leave out what is no robot.
    """
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
    if only_robots:
        found = {name: path for name, path in found.items() if is_robot(name, path)}
    return found


def descriptions_below(folders: list[str], only_robots: bool = False) -> dict[str, str]:
    """Find the robots of folders as ``lint FOLDER`` does, by their name from the folder's on.

    Args:
        folders: Folders, such as unpacked packages.
        only_robots: Whether to leave out what is not a robot.
    """
    found: dict[str, str] = {}
    for folder in map(Path, folders):
        robots = find_robots([str(folder)], workspace=Options().workspace).robots.values()
        for path in sorted(robot.path for robot in robots):
            found[f"{folder.name}/{Path(path).relative_to(folder)}"] = path
    if only_robots:
        found = {name: path for name, path in found.items() if is_robot(name, path)}
    return found


def draw(
    seed: int,
    count: int,
    by: str = "finding",
    only_robots: bool = False,
    folders: list[str] | None = None,
) -> list[dict[str, Any]]:
    """Draw findings as ``lint`` prints them, the same for the same seed, rules and robots."""
    named = descriptions_below(folders, only_robots) if folders else descriptions(only_robots)
    sample = f"{by} {seed}{', packages' if folders else ''}{', robots' if only_robots else ''}"
    return choose(sample, collect(named), named, random.Random(seed), count)


def collect(named: dict[str, str]) -> list[tuple[str, Finding]]:
    """Check descriptions, and return their findings as ``lint`` groups them, with the names."""
    found: list[tuple[str, Finding]] = []
    reports = check_files(list(named.values()), Options())
    for name, report in zip(named, reports, strict=True):
        found += [(name, finding) for finding in group(report.findings)]
    return found


def choose(
    sample: str,
    found: list[tuple[str, Finding]],
    named: dict[str, str],
    chance: random.Random,
    count: int,
) -> list[dict[str, Any]]:
    """Choose findings of a sample whose name says how: ``finding …`` or ``rule …``."""
    by = sample.partition(" ")[0]
    found = list(_by_rule(found, chance) if by == "rule" else chance.sample(found, len(found)))
    firsts = {(finding.code, name): finding for name, finding in reversed(found)}
    drawn = [(name, f) for name, f in found if firsts[f.code, name] is f][:count]
    return [
        _record(number, sample, name, named[name], finding)
        for number, (name, finding) in enumerate(drawn, 1)
    ]


def _by_rule(
    found: list[tuple[str, Finding]], chance: random.Random
) -> Iterator[tuple[str, Finding]]:
    """Shuffle rules and the findings of each, and go through the rules in turn."""
    by_rule: dict[str, list[tuple[str, Finding]]] = {}
    for name, finding in found:
        by_rule.setdefault(finding.code, []).append((name, finding))
    rules = sorted(by_rule)
    chance.shuffle(rules)
    for rule in rules:
        chance.shuffle(by_rule[rule])
    for turn in zip_longest(*(by_rule[rule] for rule in rules)):
        yield from (one for one in turn if one is not None)


def _record(number: int, sample: str, name: str, path: str, finding: Finding) -> dict[str, Any]:
    return {
        "sample": sample,
        "number": number,
        "robot": name,
        "path": path,
        "file": finding.location.path,
        "line": finding.location.line,
        "rule": finding.code,
        "severity": finding.severity.label,
        "message": _without_folders(finding.message),
        "hint": finding.hint,
        "effects": finding.effects,
        "expansions": finding.expansions,
    }


def _without_folders(text: str) -> str:
    """Leave out where the collections happen to be."""
    text = text.replace(f"{CORPUS.resolve()}/", "").replace(f"{CORPUS}/", "")
    return re.sub(r"[^' ]*/site-packages/", "", text)


def judged() -> list[dict[str, Any]]:
    """Read the verdicts."""
    text = KEPT.read_text("utf-8")
    return [json.loads(line) for line in text.splitlines() if line.strip()]


def page(rows: list[dict[str, Any]]) -> str:
    """Write the page: the counts of each sample, and of the rules with findings that were wrong."""
    titles = {row["sample"]: _title(row["sample"]) for row in rows}
    rules = {row["rule"]: f"[{row['rule']}](../rules/{row['rule']}.md)" for row in rows}
    wrong = Counter(row["rule"] for row in rows if row["verdict"] == "wrong")
    often = {rule: rules[rule] for rule, count in wrong.most_common() if count >= OFTEN}
    parts = [
        HEAD.strip(),
        _table("sample", "sample", titles, rows),
        RULES.format(often=OFTEN, rules=len(rules), judged_wrong=len(wrong)).strip(),
        _table("rule", "rule", often, rows),
    ]
    return "\n\n".join(parts) + "\n"


def _table(head: str, key: str, titles: dict[str, str], rows: list[dict[str, Any]]) -> str:
    """Make a table with a row for each value of a key, and the counts and shares of verdicts."""
    lines = [f"| {head} | findings | useful | noise | wrong |", "|---|---:|---:|---:|---:|"]
    for value, title in titles.items():
        counts = Counter(row["verdict"] for row in rows if row[key] == value)
        shares = (f"{counts[v]} ({counts[v] / counts.total():.1%})" for v in VERDICTS)
        lines.append(f"| {title} | {counts.total()} | {' | '.join(shares)} |")
    return "\n".join(lines)


def _title(sample: str) -> str:
    """Write the title of a sample such as ``finding 1`` or ``finding 1, robots``."""
    by, _, rest = sample.partition(" ")
    return f"by {by}, seed {rest}"


def main(words: list[str]) -> int:
    """Draw, or write the page."""
    parser = argparse.ArgumentParser(prog="python -m measure.precision")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=120)
    parser.add_argument("--by", choices=("finding", "rule"), default="finding")
    parser.add_argument("--only", choices=("robots",), help="leave out tests, lessons, objects")
    parser.add_argument("--page", action="store_true", help="write the page of docs/measurements")
    parser.add_argument("folders", nargs="*", help="draw from the robots below these folders")
    arguments = parser.parse_args(words)
    if arguments.page:
        PAGE.write_text(page(judged()), "utf-8")
        return 0
    only_robots = arguments.only == "robots"
    for row in draw(arguments.seed, arguments.count, arguments.by, only_robots, arguments.folders):
        print(json.dumps(row, ensure_ascii=False))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
