"""Help of a command with its options in groups, and its examples after them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from inspect import cleandoc
from typing import Any

import click

SHARED = "Shared options"
SHARED_OPTIONS = (
    *("named", "gltf_up", "package", "package_path", "cache_dir", "no_cache", "help"),
)
"""Parameters of the last group, which have the same meaning in every command."""

NAMED = "\0"
"""Start of a word that is the name of a robot; no word of a command line contains it."""

_MAX_COLUMN = 26  # characters; a longer option has a line of its own; chosen
_EXAMPLES = "\n\n\b\n"


class CommandGroup(click.Group):
    """Command group whose help lists its commands with whole sentences."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write each command with the whole first sentence of its help."""
        names = self.list_commands(ctx)
        commands = [(name, command) for name in names if (command := self.get_command(ctx, name))]
        if commands:
            with formatter.section("Commands"):
                formatter.write_dl([(name, _get_first_sentence(one)) for name, one in commands])


def _get_first_sentence(command: click.Command) -> str:
    """Return the first paragraph of a help up to the end of its first sentence."""
    paragraph = " ".join(cleandoc(command.help or "").partition("\n\n")[0].split())
    return re.split(r"(?<=[^.]\.) (?=[A-Z'])", paragraph, maxsplit=1)[0]


class GroupedCommand(click.Command):
    """Command whose help lists its options in groups, the most used ones first.

    The help text ends before its examples, so that the first groups are on the first screen; the
    examples and what follows them come after the options.

    Attributes:
        groups: Titles, each with the parameter names of its options separated by spaces. Options
            of ``SHARED_OPTIONS`` belong to no group; all others must be in one.
    """

    def __init__(self, *arguments: Any, groups: Mapping[str, str], **settings: Any) -> None:
        """Make a command; all other arguments are those of :class:`click.Command`."""
        super().__init__(*arguments, **settings)
        self.groups = {title: tuple(names.split()) for title, names in groups.items()}

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments; a robot by name, ``-r NAME``, keeps its place among the paths."""
        if any(parameter.name == "named" for parameter in self.params):
            args = list(_mark_names(args))
        return super().parse_args(ctx, args)

    def list_groups(self, ctx: click.Context) -> Iterator[tuple[str, list[click.Option]]]:
        """Yield the title of each group and its options, in the order of the group."""
        options = [
            ("help" if "--help" in parameter.opts else parameter.name, parameter)
            for parameter in self.get_params(ctx)
            if isinstance(parameter, click.Option) and not parameter.hidden
        ]
        for title, names in (*self.groups.items(), (SHARED, SHARED_OPTIONS)):
            shown = [option for name in names for of, option in options if of == name]
            if shown:
                yield title, shown

    def format_help_text(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the help text up to its examples."""
        text = self._split_help()[0]
        formatter.write_paragraph()
        with formatter.indentation():
            formatter.write_text(text)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options in groups, with descriptions that begin in the same column."""
        groups = [
            (title, [record for p in shown if (record := p.get_help_record(ctx)) is not None])
            for title, shown in self.list_groups(ctx)
        ]
        lengths = [len(names) for _, records in groups for names, _ in records]
        column = max((length for length in lengths if length <= _MAX_COLUMN), default=0)
        for title, records in groups:
            with formatter.section(title):
                rows = [(names.ljust(column), text) for names, text in records]
                formatter.write_dl(rows, col_max=column)

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the examples and the text after them."""
        examples, _, rest = self._split_help()[1].partition("\n\n")
        if examples:
            formatter.write_paragraph()
            formatter.write("Examples:\n")
            formatter.write(f"{examples}\n")
        if rest:
            formatter.write_paragraph()
            formatter.write_text(rest)

    def _split_help(self) -> tuple[str, str]:
        """Split the help into the text before the examples, and the examples with what follows."""
        text, _, rest = cleandoc(self.help or "").partition(_EXAMPLES)
        return text, rest


def _mark_names(words: Iterable[str]) -> Iterator[str]:
    """Yield words with each ``-r NAME`` as one word that begins with ``NAMED``."""
    rest = iter(words)
    for word in rest:
        if word == "--":
            yield word
            yield from rest
        elif word == "-r":
            name = next(rest, None)
            yield word if name is None else NAMED + name
        elif word.startswith("-r") and word[2:].isidentifier():
            yield NAMED + word[2:]
        else:
            yield word
