"""Files in searched folders that are not checked separately, with the reason."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING

from ..configuration import find_configuration
from ..errors import ConfigError, SourceError
from ..listing import list_first
from ..workspace import Workspace
from .discover import has_ending, list_parts
from .options import Options
from .outcome import Report

if TYPE_CHECKING:
    from ..source.description import Description

Check = Callable[[str, Options], Report]

_NAMES = 3
"""Number of macros that a message names. Chosen, no source."""


def explain_no_links(description: Description) -> str:
    """Return why a xacro file that expands to no link is not checked."""
    from ..rules.xacro.definitions import get_macro_names

    macros = sorted(get_macro_names(description))
    tags = dict.fromkeys(child.tag for child in description.document.root.children)
    if macros:
        what = f"only macros ({list_first(macros, _NAMES)})"
    elif tags:
        what = f"only {', '.join(f'<{tag}>' for tag in tags)}"
    else:
        what = "only properties or nothing"
    return f"{what}, without a link; lint the robot that includes it"


_STOPPED = "a part of a robot that was not expanded; only its source was checked"


def add_skipped_parts(
    reports: Iterable[Report],
    paths: Iterable[str],
    check: Check,
    options: Options,
    belonging: Collection[str] = (),
) -> Iterator[Report]:
    """Yield the reports, then one for each ``.xacro`` file of named folders that no robot read.

    The source of such a file is checked, and that of a file without links that has the name of a
    robot. A part of a robot that stopped before it has no report unless its source has findings.
    """
    read: set[str] = set()
    without_links: dict[str, Report] = {}
    for report in reports:
        if report.skipped and has_ending(report.path, ".xacro"):
            without_links[os.path.realpath(report.path)] = report
            continue
        read.update(os.path.realpath(path) for path in (report.path, *report.files))
        yield report
    for real, report in without_links.items():
        source = None if real in read else _check_part(report.path, check, options)
        yield replace(report, findings=source.findings) if source else report
    read.update(without_links)
    for path in list_parts(paths, belonging):
        real = os.path.realpath(path)
        if real in read:
            continue
        source = _check_part(path, check, options)
        if real not in belonging:
            source.skipped = _explain_skipped(path)
            yield source
        elif source.findings:
            source.skipped = _STOPPED
            yield source


def _check_part(path: str, check: Check, options: Options) -> Report:
    """Check the source of a file that no robot read, unless it is excluded."""
    if _get_pattern(path, options.config, options.workspace) is not None:
        return Report(path)
    report = check(path, replace(options, expand=False, fixes=False))
    return replace(report, error=None, stopped="")


def _explain_skipped(path: str) -> str:
    """Return why a ``.xacro`` file in a folder is not checked separately."""
    from ..source.document import parse, read_file

    try:
        root = parse(read_file(path)).root
    except SourceError as error:
        return error.message
    if root.find_child("link") is not None and not root.get("name"):
        return (
            "has links, but its <robot> has no name, and none of the robots includes it; name it "
            "in lint.robots of the configuration if it is a robot"
        )
    return "a part that none of the robots includes"


def exclude_files(
    files: Sequence[str], named: Collection[str], config: str | None, workspace: Workspace
) -> tuple[list[str], list[Report]]:
    """Return the files to check, and reports on those that are excluded unless named by the user.

    Raises:
        ConfigError: ``lint.exclude`` is not a list of patterns.
    """
    kept: list[str] = []
    excluded: list[Report] = []
    for file in files:
        pattern = None if file in named else _get_pattern(file, config, workspace)
        if pattern is None:
            kept.append(file)
        else:
            excluded.append(Report(file, skipped=f"excluded by '{pattern}' of the configuration"))
    return kept, excluded


def _get_pattern(file: str, config: str | None, workspace: Workspace) -> str | None:
    """Return the pattern that excludes a file; None if there is none."""
    configuration = find_configuration(file, config, workspace)
    patterns = configuration.lint.get("exclude", [])
    if not isinstance(patterns, list) or not all(isinstance(word, str) for word in patterns):
        raise ConfigError("lint.exclude must be a list of patterns", path=configuration.path)
    if not patterns:
        return None
    folder = Path(os.path.abspath(configuration.path or ".")).parent
    relative = os.path.relpath(os.path.abspath(file), folder).replace(os.sep, "/")
    return next((pattern for pattern in patterns if fnmatch(relative, pattern)), None)
