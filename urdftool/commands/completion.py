"""What the shell completes beyond commands and options: paths, rules and targets.

Only a shell that asks for completions comes here. What is to be completed follows from how a
parameter's value is called in the help.
"""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem

_PATHS = ("FILE", "IN", "OUT", "PATH", "A [")


def prepare() -> None:
    """Let parameters that take any text complete it; for the rest of this process."""
    click.STRING.shell_complete = complete_text  # type: ignore[assignment]


def complete_text(
    ctx: click.Context, parameter: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """What can stand for a value; a path the shell completes itself."""
    metavar = parameter.metavar or ""
    if metavar == "DIR":
        return [CompletionItem(incomplete, type="dir")]
    if metavar.startswith(_PATHS):
        return [CompletionItem(incomplete, type="file")]
    before, comma, begun = incomplete.rpartition(",")
    names = (name for name in _names(metavar) if name.startswith(begun))
    return [CompletionItem(f"{before}{comma}{name}") for name in names]


def _names(metavar: str) -> list[str]:
    if metavar in ("RULE", "RULES"):
        from ..rules.table import RULES

        rules = [name for groups in RULES.values() for group in groups.values() for name in group]
        return rules if metavar == "RULE" else [*RULES, *rules]
    if metavar == "TARGET":
        from ..rules.rule import TARGETS

        return list(TARGETS)
    return []
