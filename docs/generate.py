"""Write the parts of the documentation that come from code: ``python docs/generate.py [--check]``.

These are a page per rule, from its docstring, its decorator and its fixtures; an index of rules;
the help of each command, between marks in its page; what the exports to MJCF and SDF make of each
element; the reference of the Python API; man pages and completion scripts; and the output of each
``$ command`` of a ``console`` block, run in a copy of the fixtures. ``--check`` writes nothing and
prints the files that would change, and ``--rule NAME`` writes the page of that rule and the index
alone.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import click
from generator import mjcf_mapping, rule_pages, sdf_mapping
from generator.completions import list_completions
from generator.console import BLOCK, insert_output, is_same, list_pages, read_mode
from generator.man import list_man_pages
from generator.python_page import insert_names

from urdftool import cli
from urdftool.rules import FAMILY_OF, get_all_rules, get_rule
from urdftool.suggestions import find_nearest

DOCS = Path(__file__).resolve().parent
BEGIN, END = "<!-- help begins", "<!-- help ends -->"
HELP = re.compile(rf"(?P<begin>{BEGIN}(?:: (?P<words>[a-z -]*[a-z]))? -->).*?{END}", re.DOTALL)


def list_generated() -> Iterator[tuple[Path, str]]:
    """Yield every generated file with its text."""
    for rule in get_all_rules():
        yield DOCS / "rules" / f"{rule.name}.md", rule_pages.write_page(rule)
    yield DOCS / "rules" / "index.md", rule_pages.write_index()
    for path in sorted([*DOCS.glob("commands/*.md"), *DOCS.glob("edit/*.md")]):
        yield path, insert_help(path)
    for name, text in (
        ("mjcf", mjcf_mapping.format_markdown()),
        ("sdf", sdf_mapping.format_mapping()),
    ):
        yield DOCS / "formats" / f"{name}.md", insert_mapping(DOCS / "formats" / f"{name}.md", text)
    yield DOCS / "python.md", insert_names((DOCS / "python.md").read_text("utf-8"))
    yield from list_man_pages()
    yield from list_completions()


def insert_help(path: Path) -> str:
    """Return a page with the current help between its marks.

    The mark names the command, as in ``<!-- help begins: export sdf -->``; without a name, it is
    the command of the page.
    """

    def format_block(match: re.Match[str]) -> str:
        words = (match["words"] or path.stem).split()
        return f"{match['begin']}\n```text\n{format_help(words)}\n```\n{END}"

    return HELP.sub(format_block, path.read_text("utf-8"))


def insert_mapping(path: Path, text: str) -> str:
    """Return the page of a format with what its writer makes of each element between its marks."""
    before, begin, rest = path.read_text("utf-8").partition("<!-- mapping begins -->")
    _, end, after = rest.partition("<!-- mapping ends -->")
    return f"{before}{begin}\n\n{text}\n\n{end}{after}"


def format_help(words: list[str]) -> str:
    """Return the output of ``urdftool WORDS --help`` in 88 columns."""
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
    """Yield every page with commands: its text, and its text with the current output."""
    for path in only or list_pages():
        text = path.read_text("utf-8")
        if BLOCK.search(text) and read_mode(text).is_possible:
            yield path, text, insert_output(text, pictures)


def find_stale() -> list[Path]:
    """Return the generated files that would change, and pages of rules that no longer exist."""
    fresh = dict(list_generated())
    wrong = [p for p, text in fresh.items() if not p.exists() or p.read_text("utf-8") != text]
    return wrong + [path for path in (DOCS / "rules").glob("*.md") if path not in fresh]


def write_rules(names: list[str]) -> int:
    """Write the pages of some rules and the index of rules; return the exit code."""
    for name in names:
        if name not in FAMILY_OF:
            near = find_nearest(name, FAMILY_OF)
            hint = f"did you mean '{near}'?" if near else "make rule NAME=… FILE=… adds one"
            print(f"no rule is called '{name}'; {hint}", file=sys.stderr)
            return 2
        page = DOCS / "rules" / f"{name}.md"
        page.write_text(rule_pages.write_page(get_rule(name)), "utf-8")
        print(f"wrote {page}")
    (DOCS / "rules" / "index.md").write_text(rule_pages.write_index(), "utf-8")
    return 0


def run() -> int:
    """Write the pages, or check them; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; print stale files")
    parser.add_argument("--no-commands", action="store_true", help="do not run console blocks")
    parser.add_argument("--rule", action="append", help="write only the page of this rule")
    parser.add_argument("page", nargs="*", type=Path, help="run only the commands of these pages")
    options = parser.parse_args()
    if options.rule:
        return write_rules(options.rule)
    wrong: list[Path] = []
    if options.page:
        fresh = {}
    elif options.check:
        wrong = find_stale()
    else:
        fresh = dict(list_generated())
        for path in set((DOCS / "rules").glob("*.md")) - set(fresh):
            path.unlink()
        for path, text in fresh.items():
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, "utf-8")
    pictures = None if options.check else DOCS / "pictures"
    for path, old, new in () if options.no_commands else run_pages(options.page, pictures):
        if is_same(old, new, read_mode(old)):
            continue
        if options.check:
            wrong.append(path)
        else:
            path.write_text(new, "utf-8")
    for path in wrong if options.check else ():
        print(f"{path}: is stale; run python docs/generate.py")
    return int(options.check and bool(wrong))


if __name__ == "__main__":
    sys.exit(run())
