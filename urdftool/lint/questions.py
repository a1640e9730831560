"""Which checks a description requires, and their reports in the cache; imports no rule."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..configuration import Configuration, find_configuration
from .options import Options
from .outcome import Report
from .settings import Settings, read_settings
from .variants import as_one, get_variants, label

if TYPE_CHECKING:
    from .queries import Row

Question = tuple[str | Path, Options, Configuration, Settings]


def list_questions(path: str | Path, options: Options) -> list[Question]:
    """Return the checks of a description: one for each set of xacro arguments."""
    configuration = find_configuration(path, options.config, options.workspace)
    settings = read_settings(path, configuration, options.settings)
    variants: list[dict[str, str]] = []
    if options.expand and not options.arguments:
        variants = get_variants(path, configuration) or options.variants.get(
            options.workspace.resolve_links(path), []
        )
    each = [replace(options, arguments=variant) for variant in variants] or [options]
    return [(path, chosen, configuration, settings) for chosen in each]


def find_cached_report(path: str | Path, options: Options) -> Report | None:
    """Return the cached report of a description; None if it must be checked.

    Raises:
        ConfigError: The configuration is invalid.
    """
    cache = options.cache
    if cache is None or str(path) == "-":
        return None
    reports = []
    for question in list_questions(path, options):
        _, chosen, configuration, settings = question
        report = cache.read(chosen.get_key(cache, path, configuration, settings))
        if report is None:
            return None
        reports.append((label(chosen.arguments), report))
    return join_variants(reports)


def join_variants(reports: list[tuple[str, Report]]) -> Report:
    """Return one report for those of each set of xacro arguments, by its label."""
    if len(reports) == 1:
        return reports[0][1]
    rows = join_rows(report for _, report in reports)
    joined = as_one(dict(reports))
    joined.rows = rows
    return joined


def join_rows(reports: Iterable[Report]) -> list[Row] | None:
    """Return the rows of all reports, each once; None if a report is not in a cache."""
    each = [report.rows for report in reports]
    if any(rows is None for rows in each):
        return None
    return list(dict.fromkeys(row for rows in each for row in rows or ()))
