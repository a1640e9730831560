"""The formats of ``urdftool lint``, by name."""

from __future__ import annotations

from collections.abc import Iterable

from ..finding import Severity
from ..lint.outcome import Outcome
from . import findings


def as_text(
    outcome: Outcome,
    style: str,
    *,
    colors: bool = False,
    fail_on: Severity = Severity.WARNING,
    statistics: bool = False,
) -> str:
    """What there is to say of a run.

    Args:
        outcome: The run.
        style: ``full``, ``concise``, ``json``, ``sarif``, ``github``, ``junit`` or ``html``.
        colors: Whether text is coloured.
        fail_on: From which severity on a finding fails the run.
        statistics: Count findings by rule instead.
    """
    if statistics:
        return _joined(findings.statistics(outcome))
    text = _in_style(outcome, style, colors, fail_on)
    return text.encode("utf-8", "backslashreplace").decode()  # names of files may be any bytes


def _in_style(outcome: Outcome, style: str, colors: bool, fail_on: Severity) -> str:
    if style == "json":
        from .findings_json import to_json

        return to_json(outcome)
    if style == "sarif":
        from .findings_sarif import to_sarif

        return to_sarif(outcome)
    if style == "junit":
        from .findings_junit import to_junit

        return to_junit(outcome, fail_on)
    if style == "html":
        from .findings_html import to_html

        return to_html(outcome)
    if style == "github":
        from .findings_github import github

        return _joined(github(outcome))
    write = findings.full if style == "full" else findings.concise
    return _joined(write(outcome.findings, colors=colors))


def _joined(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)
