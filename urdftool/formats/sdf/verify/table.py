"""The comparison as a table at the terminal."""

from __future__ import annotations

from collections.abc import Iterable
from io import StringIO

from .check import Check

_STYLES = {"equal": "green", "announced": "yellow", "DIFFERS": "bold red", "not done": "dim"}
_SHOWN = 8


def table(checks: Iterable[Check], *, color: bool = False) -> str:
    """All checks, one line each; what differs is listed below."""
    from rich.console import Console
    from rich.table import Table

    checks = list(checks)
    made = Table(box=None, pad_edge=False)
    for head, side in (("check", "left"), ("compared", "right"), ("worst", "right"),
                       ("tolerance", "right"), ("verdict", "left")):  # fmt: skip
        made.add_column(head, justify=side)  # type: ignore[arg-type]
    for check in checks:
        verdict = check.verdict
        if check.announced:
            verdict += f" ({len(check.announced)})" if not check.failed else ""
        style = _STYLES[check.verdict]
        made.add_row(
            check.name,
            str(check.compared or ""),
            "" if check.worst is None else f"{check.worst:.1e}",
            "" if check.tolerance is None else f"{check.tolerance:.0e}",
            f"[{style}]{verdict}[/]",
        )
    out = StringIO()
    console = Console(
        file=out, width=110, force_terminal=color, color_system="standard" if color else None
    )
    console.print(made)
    text = "\n".join(line.rstrip() for line in out.getvalue().splitlines()) + "\n"
    return text + "".join(_details(checks))


def _details(checks: list[Check]) -> Iterable[str]:
    for check in checks:
        for said, found in (("differs", check.differences), ("announced", check.announced)):
            for text in found[:_SHOWN]:
                yield f"  {said}: {text}\n"
            if len(found) > _SHOWN:
                yield f"  … and {len(found) - _SHOWN} more\n"
        if check.skipped:
            yield f"  {check.name}: {check.skipped}\n"
