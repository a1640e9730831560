"""Completion of values in the shell: paths, rules and targets.

The kind of value is derived from the metavar of a parameter. Imported only for completion.
"""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem

_PATHS = ("FILE", "IN", "OUT", "PATH", "A [")


def prepare() -> None:
    """Install :func:`complete_text` for all parameters that accept any text."""
    click.STRING.shell_complete = complete_text  # type: ignore[assignment]


def complete_text(
    ctx: click.Context, parameter: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Return the completions of a value; for a path, the shell completes it."""
    metavar = parameter.metavar or ""
    if metavar == "DIR":
        return [CompletionItem(incomplete, type="dir")]
    if metavar.startswith(_PATHS):
        return [CompletionItem(incomplete, type="file")]
    before, comma, begun = incomplete.rpartition(",")
    names = (name for name in _collect_names(metavar) if name.startswith(begun))
    return [CompletionItem(f"{before}{comma}{name}") for name in names]


def _collect_names(metavar: str) -> list[str]:
    if metavar in ("RULE", "RULES"):
        from ..rules.table import RULES

        rules = [name for groups in RULES.values() for group in groups.values() for name in group]
        return rules if metavar == "RULE" else [*RULES, *rules]
    if metavar == "TARGET":
        from ..rules.targets import TARGETS

        return list(TARGETS)
    return []
