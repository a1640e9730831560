"""``urdftool lint --explain-targets``: for which targets robots are checked, and why."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from ..report.counted import format_count

if TYPE_CHECKING:
    from ..lint.options import Options
    from ..lint.repository import Repository


def print_targets(
    files: Sequence[str], found: Repository, options: Options, style: str | None
) -> int:
    """Print the targets of each robot with their evidence, and return the exit code."""
    from ..lint.explained_targets import explain_targets
    from ..report.targets import format_targets_as_json, format_targets_as_text

    if style not in (None, "full", "json"):
        raise click.UsageError(f"targets are printed as text or JSON, not with --format {style}")
    robots = [(path, found.robots.get(os.path.realpath(path))) for path in files]
    explained = [explain_targets(path, options, robot) for path, robot in robots]
    show = format_targets_as_json if style == "json" else format_targets_as_text
    click.echo(show(explained), nl=False)
    missing = [one.path for one in explained if one.not_checked]
    if missing:
        click.echo(f"{format_count(len(missing), 'file')} not checked", err=True)
    return 2 if missing else 0
