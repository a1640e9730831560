"""Pages of rules: a page per rule, from its docstring, decorator and fixtures, and the index."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from difflib import unified_diff
from pathlib import Path

from generator.rule_evidence import write_evidence
from urdftool.diagnostic import Severity
from urdftool.report.file_diff import format_file_diff
from urdftool.report.rule_pages import get_effect_source, get_facts
from urdftool.rules import get_all_rules, get_rule
from urdftool.rules.rule import Rule
from urdftool.rules.table import FIXES, RULES
from urdftool.rules.targets import TARGETS

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures" / "rules"
DESCRIPTIONS = (".urdf", ".xacro", ".usda")
LANGUAGES = {".urdf": "xml", ".xacro": "xml", ".srdf": "xml", ".yaml": "yaml"}

COVERED = {
    "a xacro argument without a default": "expansion-failed",
    "a property with an invalid name": "expansion-failed",
    "a property or macro used above its definition": ("undefined-name", "unknown-macro"),
    "arithmetic outside of `${…}`": "not-a-number",
    "a hardware interface only in the actuator": "missing-hardware-interface",
    "a joint in two transmissions, two transmissions with one name": "duplicate-transmission",
    "two sensors or plugins with one name": ("duplicate-sensor-name", "duplicate-plugin-name"),
    "mimic joints that ros2_control rejects": "ros2-control-mimic",
    "a parameter of ros2_control without a name": "ros2-control-bad-param",
}
"""Defects without a rule of their own, and the rules that report them."""


NOT_REPORTED = {
    "effort and velocity of a `<limit>` exchanged": "the values of a small fast drive look the "
    "same; a velocity above 200 rad/s is `implausible-velocity`",
    "limits of ±3.1416 on a joint that turns further": "the file does not say how far the drive "
    "turns; compare with the data sheet",
    "a part that touches nothing": "sensors and casters are often mounted on parts without "
    "geometry; `simulate` and `view` show the gap",
    "an axis reversed on a joint without a counterpart": "nothing in the file shows the direction; "
    "`axis-against-others` compares joints that have counterparts",
    "a joint displaced along its rail": "it is another zero of the same motion",
    "a collision that reaches below the floor": "a description has no floor; `simulate` reports it",
}
"""Defects that no rule reports, with the reason."""


def write_page(rule: Rule) -> str:
    """Return the page of a rule: what is wrong, what readers do, the changed lines, the fix."""
    fact, _, rest = inspect.cleandoc(rule.check.__doc__ or "").partition("\n")
    parts = [f"# {rule.name}", as_markdown(fact), as_markdown(rest.strip())]
    parts.append(
        "\n".join(f"- {label}: {_mark_options(value)}" for label, value in get_facts(rule))
    )
    if rule.effects:
        rows = "\n".join(
            f"| {readers} | {effect} | {get_effect_source(rule.name, readers)} |"
            for readers, effect in rule.effects.items()
        )
        parts.append(f"| reader | what it does | how it is known |\n|---|---|---|\n{rows}")
    example = _list_example_lines(rule.name)
    parts += _write_example(rule.name, example)
    if rule.name in FIXES:
        parts.append(_write_fix(rule.name, example))
    parts.append(
        "## Accept it on purpose\n\n"
        f"Add `<!-- urdftool-ignore[{rule.name}] reason -->` on the line or before the element."
    )
    return "\n\n".join(part for part in parts if part) + "\n"


def write_index() -> str:
    """Return the list of all rules, by family and by target."""
    lines = ["# Rules", ""]
    lines.append(
        f"{len(list(get_all_rules()))} rules. `urdftool lint --explain RULE` shows a page."
    )
    lines.append("")
    lines.append(
        "A rule with *(off)* is off by default, and of one with *(in part)* the cases that its "
        "page names, because most findings of this kind on real robots were judged as noise. So "
        "are the infos of every rule whose page does not list them as on. "
        "`--extend-select RULE` reports them, and `--extend-select pedantic` those of all rules."
    )
    lines.append("")
    lines.append(
        "What a page states about a reader was run in that reader on a minimal robot, with the "
        "version given, or was read in its source, with the file given. Gazebo reads URDF with "
        "sdformat: `gz` and `gazebo-classic` stand for the version of sdformat that was run."
    )
    for family in RULES:
        names = [name for group in RULES[family].values() for name in group]
        if not names:
            continue
        lines += ["", f"## {family}", "", "| rule | severity | defect | fix |", "|---|---|---|---|"]
        for name in names:
            rule = get_rule(name)
            off = (" *(in part)*" if rule.pedantic else "") if rule.default else " *(off)*"
            fact = as_markdown(rule.fact).replace("|", "\\|")
            fix = FIXES[name].applicability if name in FIXES else ""
            lines.append(f"| [{name}]({name}.md) | {rule.severity.label} | {fact}{off} | {fix} |")
    lines += ["", "## Reported by another rule", "", "| defect | rule |", "|---|---|"]
    for defect, rules in COVERED.items():
        named = [rules] if isinstance(rules, str) else rules
        links = ", ".join(f"[{name}]({name}.md)" for name in named)
        lines.append(f"| {defect} | {links} |")
    lines += ["", "## Not reported", "", "| defect | reason |", "|---|---|"]
    lines += [f"| {defect} | {reason} |" for defect, reason in NOT_REPORTED.items()]
    lines += ["", "A [baseline](../commands/lint.md) entry that no longer matches a finding is"]
    lines.append("reported as a note of the run, not as a finding.")
    lines += _write_target_sections()
    lines += write_evidence()
    return "\n".join(lines).rstrip() + "\n"


def as_markdown(text: str) -> str:
    """Convert the code marks of a docstring to Markdown."""
    return text.replace("``", "`")


def _mark_options(text: str) -> str:
    """Mark the options in a text as code."""
    return re.sub(r"--[a-z][a-z-]*(?: --[a-z][a-z-]*)*(?: [a-z]+(?:-[a-z]+)+)?", r"`\g<0>`", text)


def _write_target_sections() -> Iterator[str]:
    yield from ("", "## By target", "")
    yield (
        "Rules that run only for a target, or have a higher severity for it. "
        "All other rules run for every target."
    )
    for target in TARGETS:
        yield from ("", f"### {target}", "", "| severity | rules |", "|---|---|")
        special = [r for r in get_all_rules() if target in (r.on or ()) or target in r.raised]
        for severity in reversed(Severity):
            some = [r for r in special if r.get_severity(frozenset([target])) is severity]
            links = ", ".join(f"[{rule.name}]({rule.name}.md)" for rule in some)
            if links:
                yield f"| {severity.label} | {links} |"


def _list_example_lines(rule: str) -> list[str]:
    """Return the difference between the wrong and the right example of a rule."""
    bad, good = _find_description(rule, "bad.*"), _find_description(rule, "good.*")
    if bad is None or good is None:
        return []
    lines: list[str] = []
    for wrong, right in [(bad, good), *_list_companions(bad)]:
        names = (path.relative_to(FIXTURES / rule).as_posix() for path in (wrong, right))
        texts = (_read_lines(rule, path.read_bytes()) for path in (wrong, right))
        lines += unified_diff(*texts, *names, n=2, lineterm="")
    return [line.rstrip() for line in lines]


def _write_example(rule: str, lines: list[str]) -> list[str]:
    """Return the changed lines of a rule's example, and its files, folded."""
    bad, good = _find_description(rule, "bad.*"), _find_description(rule, "good.*")
    if bad is None or good is None:
        return []
    parts = ["## Example"]
    if lines:
        shown = "\n".join(lines)
        parts.append(f"Wrong (`-`) and right (`+`):\n\n```diff\n{shown}\n```")
    companions = _list_companions(bad)
    wrong, right = [bad, *(p for p, _ in companions)], [good, *(p for _, p in companions)]
    parts.append(_fold("The whole example, with the defect", wrong))
    parts.append(_fold("The whole example, correct", right))
    return parts


def _find_description(rule: str, pattern: str) -> Path | None:
    """Return the first robot description of a rule's fixtures that matches a pattern."""
    found = (path for path in sorted((FIXTURES / rule).glob(pattern)))
    return next((path for path in found if path.suffix in DESCRIPTIONS), None)


def _list_companions(bad: Path) -> list[tuple[Path, Path]]:
    """Return the files next to an example that have a wrong and a right version."""
    stem = bad.name.split(".")[0]
    found = []
    for path in sorted((*bad.parent.glob(f"{stem}.srdf"), *bad.parent.glob(f"config/{stem}.yaml"))):
        right = path.with_name(path.name.replace("bad", "good", 1))
        if right.is_file():
            found.append((path, right))
    return found


def _read_lines(rule: str, data: bytes) -> list[str]:
    """Return the lines of a fixture without the comments that mark reported places."""
    mark = re.compile(rf"[ \t]*(<!-- *{re.escape(rule)} *-->|# {re.escape(rule)}$)", re.MULTILINE)
    return mark.sub("", data.decode("utf-8", "replace")).splitlines()


def _fold(title: str, files: list[Path]) -> str:
    """Return files as a part of a page that is closed until it is clicked."""
    blocks = []
    for path in files:
        text = path.read_text("utf-8", "replace").rstrip()
        language = LANGUAGES.get(path.suffix, "text")
        blocks.append(f"`{path.name}`:\n\n```{language}\n{text}\n```")
    shown = "\n\n".join(blocks)
    return f"<details>\n<summary>{title}</summary>\n\n{shown}\n\n</details>"


def _write_fix(rule: str, example: list[str]) -> str:
    """Return the section with the change that a rule's fix makes in a fixture."""
    fix = FIXES[rule]
    option = "--fix" if fix.applicability == "safe" else "--fix --unsafe-fixes"
    option += " --fix-meshes" if fix.writes_meshes else ""
    lines = [line.rstrip() for line in _list_fix_lines(rule)]
    command = f"`urdftool lint {option}`"
    if lines[2:] == example[2:]:
        return f"## Fix\n\n{command} makes the change of the example ({fix.applicability} fix)."
    text = "\n".join(lines)
    return (
        f"## Fix\n\n{command} makes this change ({fix.applicability} fix):\n\n```diff\n{text}\n```"
    )


def _list_fix_lines(rule: str) -> Iterator[str]:
    found = sorted((FIXTURES / rule).glob("fixed*"), key=lambda path: (path.is_dir(), path.name))
    stem = found[0].name.split(".")[0]
    for fixed in (path for path in found if path.name.split(".")[0] == stem):
        if fixed.is_dir():
            for path in sorted(filter(Path.is_file, fixed.rglob("*"))):
                inside = path.relative_to(fixed).as_posix()
                yield from _compare_files(rule, FIXTURES / rule / inside, path, inside)
        else:
            bad = fixed.with_name(fixed.name.replace("fixed", "bad", 1))
            yield from _compare_files(rule, bad, fixed, bad.name)


def _compare_files(rule: str, old: Path, new: Path, name: str) -> list[str]:
    """Return what ``--diff`` prints for a file of a fixture; a missing file counts as empty."""
    before, after = (path.read_bytes() if path.is_file() else b"" for path in (old, new))
    if b"\0" in before + after:
        return format_file_diff(name, before if old.is_file() else None, after).splitlines()
    texts = (_read_lines(rule, data) for data in (before, after))
    return list(unified_diff(*texts, name, name, n=2, lineterm=""))
