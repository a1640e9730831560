"""``[[lint.variants]]``: several sets of xacro arguments for one file, with merged findings."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..configuration import Configuration
from ..errors import ConfigError
from ..finding import Finding
from .fingerprint import get_fact
from .merge import sort_findings
from .outcome import Report
from .settings import suggest_word

_KEYS = ("file", "args")


def get_variants(file: str | Path, configuration: Configuration) -> list[dict[str, str]]:
    """Return the sets of arguments that the configuration has for a file.

    Raises:
        ConfigError: A variant has an unknown key, an invalid value or a missing file.
    """
    table, path = configuration.lint.get("variants", []), configuration.path
    if not isinstance(table, list):
        raise ConfigError("lint.variants must be written as [[lint.variants]]", path=path)
    folder = os.path.dirname(os.path.abspath(path)) if path else os.getcwd()
    real = os.path.realpath(file)
    found: list[dict[str, str]] = []
    for number, variant in enumerate(table, start=1):
        name, arguments = _read(variant, number, path)
        described = os.path.realpath(os.path.join(folder, name))
        if not os.path.isfile(described):
            raise ConfigError(f"lint.variants {number}: file {name} does not exist", path=path)
        if described == real and arguments not in found:
            found.append(arguments)
    return found


def list_variant_files(configuration: Configuration) -> list[str]:
    """Return the files of ``lint.variants``, relative to the configuration.

    Raises:
        ConfigError: A variant has an unknown key or an invalid value.
    """
    table = configuration.lint.get("variants", [])
    if not isinstance(table, list):
        return []
    each = (_read(variant, number, configuration.path) for number, variant in enumerate(table, 1))
    return list(dict.fromkeys(name for name, _ in each))


def _read(variant: Any, number: int, path: str | None) -> tuple[str, dict[str, str]]:
    where = f"lint.variants {number}"
    for key in variant if isinstance(variant, dict) else ():
        if key not in _KEYS:
            hint = suggest_word(key, _KEYS) or "; there are file and args"
            raise ConfigError(f"{where} has no option '{key}'{hint}", path=path)
    if not isinstance(variant, dict) or not isinstance(variant.get("file"), str):
        raise ConfigError(f"{where} must have a file and its args", path=path)
    arguments = variant.get("args", {})
    if not isinstance(arguments, dict):
        raise ConfigError(f"{where}: args must be a table, {{name = 'value'}}", path=path)
    return variant["file"], {k: _check_text(v, f"{where}: {k}", path) for k, v in arguments.items()}


def _check_text(value: Any, where: str, path: str | None) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str | int | float):
        return str(value)
    raise ConfigError(f"{where} must be a text, a number, true or false", path=path)


def label(arguments: Mapping[str, str]) -> str:
    """Return a set of arguments as text: ``prefix=left_ gripper=true``."""
    return " ".join(f"{name}={value}" for name, value in arguments.items()) or "no arguments"


def as_one(reports: Mapping[str, Report]) -> Report:
    """Merge the reports of the variants of a file, given by label.

    A finding that some variants do not have lists those that have it. An unused item that another
    variant uses is not reported. A file counts as not checked if one of its variants is not.
    """
    checked = {
        name: report
        for name, report in reports.items()
        if report.error is None and not report.skipped
    }
    if not checked:
        return next(iter(reports.values()))
    stopped = {name: report.stopped for name, report in checked.items() if report.stopped}
    findings = _merge({name: report.findings for name, report in checked.items()}, len(reports))
    reasons = {_get_key(f): reason for report in checked.values() for f, reason in report.ignored}
    first = next(iter(checked.values()))
    hidden = _merge(
        {name: [finding for finding, _ in report.ignored] for name, report in checked.items()},
        len(reports),
    )
    return replace(
        first,
        findings=sort_findings(
            f for f in findings if not (f.variants and f.code.startswith("unused-"))
        ),
        targets=frozenset().union(*(report.targets for report in checked.values())),
        overruled="; ".join(sorted({report.overruled for report in checked.values()} - {""})),
        rejected={
            reader: tuple(sorted({rule for r in checked.values() for rule in r.rejected[reader]}))
            for reader in first.rejected
            if all(reader in report.rejected for report in checked.values())
        },
        ignored=[(finding, reasons[_get_key(finding)]) for finding in hidden],
        files=tuple(dict.fromkeys(f for report in checked.values() for f in report.files)),
        stopped="; ".join(f"with {name}: {reason}" for name, reason in stopped.items()),
        failed_rules={k: v for r in checked.values() for k, v in r.failed_rules.items()},
        skipped_rules={k: v for r in checked.values() for k, v in r.skipped_rules.items()},
        unread_meshes={k: v for r in checked.values() for k, v in r.unread_meshes.items()},
        unread_files={k: v for r in checked.values() for k, v in r.unread_files.items()},
        for_other_readers={
            rule: max(r.for_other_readers.get(rule, 0) for r in checked.values())
            for rule in sorted({rule for r in checked.values() for rule in r.for_other_readers})
        },
        about_dynamics=max(report.about_dynamics for report in checked.values()),
        minor=max(report.minor for report in checked.values()),
    )


def _get_key(finding: Finding) -> tuple[str, str, int, int]:
    place = finding.location
    return finding.code, place.file.path, place.start, place.end


def _merge(by_variant: Mapping[str, Sequence[Finding]], number: int) -> list[Finding]:
    """Merge findings of one rule at one place, even if arguments change their messages."""
    groups: dict[tuple[str, str, int, int], list[tuple[Finding, list[str]]]] = {}
    for name, findings in by_variant.items():
        for finding in findings:
            group = groups.setdefault(_get_key(finding), [])
            open_ones = [pair for pair in group if name not in pair[1]]
            same = [pair for pair in open_ones if get_fact(pair[0]) == get_fact(finding)]
            chosen = next(iter(same or open_ones), None)
            if chosen is None:
                group.append((replace(finding), [name]))
            else:
                chosen[1].append(name)
                chosen[0].severity = max(chosen[0].severity, finding.severity)
    merged = []
    for finding, names in (pair for group in groups.values() for pair in group):
        finding.variants = tuple(names) if len(names) < number else ()
        merged.append(finding)
    return merged
