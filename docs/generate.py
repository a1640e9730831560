"""Write the parts of the documentation that the code knows: ``python docs/generate.py [--check]``.

A page a rule, from its docstring, its decorator and its fixtures; an index of them; the help of
each command, between marks in its page; and what each ``$ command`` of a ``console`` block prints,
run in a copy of the fixtures. With ``--check`` nothing is written, and stale pages are named.
"""

from __future__ import annotations

import argparse
import inspect
import re
import sys
from collections.abc import Iterator
from difflib import unified_diff
from pathlib import Path

import click
from generator.completions import completions
from generator.console import BLOCK, how, same, with_output, written_pages
from generator.man import man_pages
from generator.python_page import with_names

from urdftool import cli
from urdftool.diagnostic import Severity
from urdftool.report.file_diff import file_diff
from urdftool.report.rule_pages import facts
from urdftool.rules import all_rules, get_rule
from urdftool.rules.effect_sources import effect_source
from urdftool.rules.rule import TARGETS, Rule
from urdftool.rules.table import FIXES, RULES

DOCS = Path(__file__).resolve().parent
FIXTURES = DOCS.parent / "fixtures" / "rules"
BEGIN, END = "<!-- help begins", "<!-- help ends -->"
HELP = re.compile(rf"(?P<begin>{BEGIN}(?:: (?P<words>[a-z ]+))? -->).*?{END}", re.DOTALL)


def pages() -> Iterator[tuple[Path, str]]:
    """Every generated page with its text."""
    for rule in all_rules():
        yield DOCS / "rules" / f"{rule.name}.md", rule_page(rule)
    yield DOCS / "rules" / "index.md", rule_index()
    for path in sorted((DOCS / "commands").glob("*.md")):
        yield path, with_help(path)
    yield DOCS / "python.md", with_names((DOCS / "python.md").read_text("utf-8"))
    yield from man_pages()
    yield from completions()


def rule_page(rule: Rule) -> str:
    """A rule's page: the fact, why it hurts, what readers do, and its fixtures."""
    fact, _, rest = inspect.cleandoc(rule.check.__doc__ or "").partition("\n")
    parts = [f"# {rule.name}", _markdown(fact), _markdown(rest.strip())]
    parts.append("\n".join(f"- {label}: {value}" for label, value in facts(rule)))
    if rule.effects:
        rows = "\n".join(
            f"| {readers} | {effect} | {effect_source(rule.name, readers)} |"
            for readers, effect in rule.effects.items()
        )
        parts.append(f"| reader | what it does | how it is known |\n|---|---|---|\n{rows}")
    for title, pattern in (("Found", "bad.*"), ("Right", "good.*")):
        for path in sorted((FIXTURES / rule.name).glob(pattern)):
            if path.suffix in (".urdf", ".xacro"):
                text = path.read_text("utf-8", "replace").rstrip()
                parts.append(f"## {title}\n\n```xml\n{text}\n```")
                parts += _controllers(path)
                break
    if rule.name in FIXES:
        parts.append(fix_shown(rule.name))
    parts.append(
        f"Silence it where it is meant: `<!-- urdftool-ignore[{rule.name}] reason -->` "
        "on the line or before the element."
    )
    return "\n\n".join(part for part in parts if part) + "\n"


def _controllers(path: Path) -> list[str]:
    """The file of controllers that a fixture names."""
    file = path.parent / "config" / f"{path.name.split('.')[0]}.yaml"
    if not file.exists():
        return []
    return [f"with `config/{file.name}`:\n\n```yaml\n{file.read_text('utf-8').rstrip()}\n```"]


def fix_shown(rule: str) -> str:
    """What the fix of a rule makes of a fixture, as a diff."""
    option = "--fix" if FIXES[rule].applicability == "safe" else "--fix --unsafe-fixes"
    option += " --fix-meshes" if FIXES[rule].writes_meshes else ""
    lines: list[str] = []
    found = sorted((FIXTURES / rule).glob("fixed*"), key=lambda path: (path.is_dir(), path.name))
    stem = found[0].name.split(".")[0]
    for fixed in (path for path in found if path.name.split(".")[0] == stem):
        if fixed.is_dir():
            for path in sorted(filter(Path.is_file, fixed.rglob("*"))):
                inside = path.relative_to(fixed).as_posix()
                lines += _difference(FIXTURES / rule / inside, path, inside)
        else:
            bad = fixed.with_name(fixed.name.replace("fixed", "bad", 1))
            lines += _difference(bad, fixed, bad.name)
    text = "\n".join(line.rstrip() for line in lines)
    how = f"`urdftool lint {option}`, which is {FIXES[rule].applicability}:"
    return f"## Fixed\n\n{how}\n\n```diff\n{text}\n```"


def _difference(old: Path, new: Path, name: str) -> list[str]:
    """What ``--diff`` shows of a file of a fixture; one that is not there yet is empty."""
    before, after = (path.read_bytes() if path.is_file() else b"" for path in (old, new))
    if b"\0" in before + after:
        return file_diff(name, before if old.is_file() else None, after).splitlines()
    texts = (data.decode("utf-8", "replace").splitlines() for data in (before, after))
    return list(unified_diff(*texts, name, name, n=2, lineterm=""))


def _markdown(text: str) -> str:
    return text.replace("``", "`")


ELSEWHERE = {
    "a xacro argument without a default": "expansion-failed",
    "a property whose name cannot be one": "expansion-failed",
    "a property or macro used above its definition": ("undefined-name", "unknown-macro"),
    "arithmetic outside of `${…}`": "not-a-number",
    "a hardware interface in the actuator alone": "missing-hardware-interface",
    "a joint in two transmissions, two transmissions of one name": "duplicate-transmission",
    "two sensors or plugins of one name": ("duplicate-sensor-name", "duplicate-plugin-name"),
    "what ros2_control refuses of joints that mimic": "ros2-control-mimic",
    "a parameter of ros2_control without a name": "ros2-control-bad-param",
}
"""What has no rule of its own, and which rule says it."""


def rule_index() -> str:
    """All rules by family, and by target."""
    lines = ["# Rules", ""]
    lines.append(f"{len(list(all_rules()))} rules. `urdftool lint --explain RULE` shows a page.")
    lines.append("")
    lines.append(
        "What a page says of a reader was run in it on a minimal robot, with the version that is "
        "named, or is from its source, with the file in which it was read. Gazebo reads URDF with "
        "sdformat, so `gz` and `gazebo-classic` stand for the sdformat that was run."
    )
    for family in RULES:
        names = [name for group in RULES[family].values() for name in group]
        if not names:
            continue
        lines += [
            "",
            f"## {family}",
            "",
            "| rule | severity | what it says | fix |",
            "|---|---|---|---|",
        ]
        for name in names:
            rule = get_rule(name)
            off = "" if rule.default else " *(off)*"
            fact = _markdown(rule.fact).replace("|", "\\|")
            fix = FIXES[name].applicability if name in FIXES else ""
            lines.append(f"| [{name}]({name}.md) | {rule.severity.label} | {fact}{off} | {fix} |")
    lines += ["", "## Said by another rule", "", "| what | rule |", "|---|---|"]
    for what, rules in ELSEWHERE.items():
        named = [rules] if isinstance(rules, str) else rules
        links = ", ".join(f"[{name}]({name}.md)" for name in named)
        lines.append(f"| {what} | {links} |")
    lines += ["", "An entry of a [baseline](../commands/lint.md) that matches nothing any more is"]
    lines.append("a note of the run and not a finding: no line of the robot is wrong.")
    lines += ["", "## By target", ""]
    lines.append(
        "What is on only for a target, or matters more for it; all others hold everywhere."
    )
    for target in TARGETS:
        lines += ["", f"### {target}", "", "| severity | rules |", "|---|---|"]
        special = [r for r in all_rules() if target in (r.on or ()) or target in r.raised]
        for severity in reversed(Severity):
            some = [r for r in special if r.severity_for(frozenset([target])) is severity]
            links = ", ".join(f"[{rule.name}]({rule.name}.md)" for rule in some)
            lines += [f"| {severity.label} | {links} |"] if links else []
    return "\n".join(lines).rstrip() + "\n"


def with_help(path: Path) -> str:
    """A page with the help between its marks as it is now.

    The mark names the command, as in ``<!-- help begins: export sdf -->``; the first of a command's
    page need not.
    """

    def shown(match: re.Match[str]) -> str:
        words = (match["words"] or path.stem).split()
        return f"{match['begin']}\n```text\n{help_of(words)}\n```\n{END}"

    return HELP.sub(shown, path.read_text("utf-8"))


def help_of(words: list[str]) -> str:
    """What ``urdftool WORDS --help`` prints, in 88 columns."""
    command: click.Command = cli.main
    settings = {**cli.main.context_settings, "terminal_width": 88}
    context = click.Context(cli.main, info_name="urdftool", **settings)
    for word in words:
        of = getattr(command, "get_command", None)
        found = of(context, word) if of else None
        assert found is not None, f"no command {' '.join(words)}"
        if not isinstance(command, click.Group):  # collision, that is a command itself
            word, context = f"{context.info_name} {word}", context.parent
        command = found
        context = click.Context(command, info_name=word, parent=context, terminal_width=88)
    return command.get_help(context)


def run_pages(only: list[Path], pictures: Path | None = None) -> Iterator[tuple[Path, str, str]]:
    """Every page with commands: as it is, and with what they print now."""
    for path in only or written_pages():
        text = path.read_text("utf-8")
        if BLOCK.search(text) and how(text).is_possible:
            yield path, text, with_output(text, pictures)


def stale() -> list[Path]:
    """Generated files that are not as they would be written now, or whose rule is gone."""
    fresh = dict(pages())
    wrong = [p for p, text in fresh.items() if not p.exists() or p.read_text("utf-8") != text]
    return wrong + [path for path in (DOCS / "rules").glob("*.md") if path not in fresh]


def main() -> int:
    """Write the pages, or check them."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; name stale pages")
    parser.add_argument("--no-commands", action="store_true", help="run no command of a page")
    parser.add_argument("page", nargs="*", type=Path, help="only these, and only their commands")
    options = parser.parse_args()
    wrong: list[Path] = []
    if options.page:
        fresh = {}
    elif options.check:
        wrong = stale()
    else:
        fresh = dict(pages())
        for path in set((DOCS / "rules").glob("*.md")) - set(fresh):
            path.unlink()
        for path, text in fresh.items():
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, "utf-8")
    pictures = None if options.check else DOCS / "pictures"
    for path, old, new in () if options.no_commands else run_pages(options.page, pictures):
        if same(old, new, how(old)):
            continue
        if options.check:
            wrong.append(path)
        else:
            path.write_text(new, "utf-8")
    for path in wrong if options.check else ():
        print(f"{path}: is stale; run python docs/generate.py")
    return int(options.check and bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
