"""Compare two records: what programs read, and what people read."""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

WRITTEN_FOR_PEOPLE = frozenset(
    ("message", "hint", "effects", "text", "notes", "note", "reason", "markdown", "description")
)
"""Keys of JSON whose values are sentences."""

CHANGES_EVERY_RUN = frozenset(("seconds", "elapsed", "duration_ms", "cpu_seconds", "wall_seconds"))
"""Keys of JSON whose values are times [s]."""

_TIME = re.compile(r"\d+(?:\.\d+)? (?:s|ms|seconds)\b")


def _stripped(value: Any, leave_out: frozenset[str]) -> Any:
    """Leave out keys of JSON, and round numbers to 12 digits."""
    if isinstance(value, dict):
        return {k: _stripped(v, leave_out) for k, v in value.items() if k not in leave_out}
    if isinstance(value, list):
        return [_stripped(item, leave_out) for item in value]
    return float(f"{value:.12g}") if isinstance(value, float) else value


def _parsed(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return None


def _lines(path: Path, *, sentences: bool) -> list[str] | None:
    """Read a file as lines to compare.

    Args:
        path: The file; one that is absent has no lines.
        sentences: Whether what is written for people is compared, too.

    Returns:
        The lines; None for text that holds nothing but sentences, where these are left out.
    """
    if not path.exists():
        return ["(absent)"]
    try:
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        return [path.read_bytes().hex(" ", 64)]
    parsed = _parsed(text)
    if isinstance(parsed, dict | list):
        leave_out = CHANGES_EVERY_RUN if sentences else CHANGES_EVERY_RUN | WRITTEN_FOR_PEOPLE
        return json.dumps(_stripped(parsed, leave_out), indent=1, sort_keys=True).splitlines()
    if not sentences and path.name in ("stdout", "stderr") and not _holds_edits(path):
        return None
    return _TIME.sub("TIME", text).splitlines()


def _holds_edits(path: Path) -> bool:
    """Tell whether a stream is the edits that a command would make."""
    command = json.loads((path.parent / "run.json").read_bytes())["command"]
    return path.name == "stdout" and "--diff" in command


def differences(old: Path, new: Path, *, sentences: bool) -> Iterator[tuple[str, list[str]]]:
    """List what differs between the records of one command.

    Args:
        old: Its folder before.
        new: Its folder after.
        sentences: Whether what is written for people is compared, too.

    Yields:
        The file's name, and a unified diff.
    """
    names = {path.relative_to(root) for root in (old, new) for path in root.rglob("*")}
    for name in sorted(names):
        a, b = old / name, new / name
        if a.is_dir() or b.is_dir():
            continue
        before, after = _lines(a, sentences=sentences), _lines(b, sentences=sentences)
        if before is not None and after is not None and before != after:
            yield str(name), list(difflib.unified_diff(before, after, lineterm="", n=1))[2:]


def compare(old: Path, new: Path, only: str, most: int) -> int:
    """Print what differs between two records.

    Args:
        old: The record before.
        new: The record after.
        only: Commands whose name holds this word.
        most: Lines that are shown of one difference.

    Returns:
        0 where they are equal, 1 where sentences differ alone, 2 where more does.
    """
    names = sorted({path.name for root in (old, new) for path in root.iterdir() if path.is_dir()})
    names = [name for name in names if only in name]
    code = 0
    for title, sentences in (("without sentences", False), ("sentences", True)):
        wrong = 0
        for name in names:
            for file, diff in differences(old / name, new / name, sentences=sentences):
                wrong += 1
                print(f"{name}/{file}")
                for line in diff[:most]:
                    print(f"    {line[:200]}")
                if len(diff) > most:
                    print(f"    … {len(diff) - most} more lines")
        print(f"{title}: {wrong} files of {len(names)} commands differ")
        if wrong:
            return 2 if not sentences else 1
    return code
