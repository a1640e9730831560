"""Output formats of ``urdftool lint``, by name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from ..diagnostic import Severity
from ..lint.outcome import Outcome
from .findings import format_statistics as count_by_rule
from .findings_screen import format_screen


def as_text(
    outcome: Outcome,
    style: str,
    *,
    colors: bool = False,
    fail_on: Severity = Severity.WARNING,
    statistics: bool = False,
    whole: bool = True,
    cut: bool = False,
    pictures: Mapping[str, bytes | str] = MappingProxyType({}),
    fixes: Mapping[str, Any] | None = None,
) -> str:
    """Format a run."""
    if statistics:
        return _format_joined(count_by_rule(outcome))
    if style in ("full", "concise"):
        lines = format_screen(outcome.findings, style, colors=colors, whole=whole, cut=cut)
        text = _format_joined(lines)
    elif style == "html":
        from .findings_html import to_html

        text = to_html(outcome, pictures)
    else:
        text = _format_in_style(outcome, style, fail_on, fixes)
    return text.encode("utf-8", "backslashreplace").decode()  # file names may contain any bytes


def _format_in_style(
    outcome: Outcome, style: str, fail_on: Severity, fixes: Mapping[str, Any] | None
) -> str:
    if style == "json":
        from .findings_json import to_json

        return to_json(outcome, fixes)
    if style == "sarif":
        from .findings_sarif import to_sarif

        return to_sarif(outcome)
    if style == "junit":
        from .findings_junit import to_junit

        return to_junit(outcome, fail_on)
    from .findings_github import format_github

    return _format_joined(format_github(outcome))


def _format_joined(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)
