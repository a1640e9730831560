"""Diagnostics of all robots by file: merged, and moved by edits until the next check."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from .moves import Point, TextChange

Found = dict[str, list[dict[str, Any]]]
"""Diagnostics by path."""


@dataclass
class _Result:
    """Last findings of one robot.

    Attributes:
        findings: Findings of the last check that read the robot, moved by the edits since then.
        errors: Why the present text could not be read.
        has_rules: Whether ``findings`` are those of a complete check.
    """

    findings: Found = field(default_factory=dict)
    errors: Found = field(default_factory=dict)
    has_rules: bool = False


class Publication:
    """Diagnostics to show, for each file."""

    def __init__(self) -> None:
        """Create an empty publication."""
        self._results: dict[str, _Result] = {}

    def receive(self, part: Mapping[str, Any]) -> set[str]:
        """Store what a check found, and return the paths whose diagnostics may have changed.

        Args:
            part: A part of the answer to ``check``; ``findings`` is None before the rules ran.
        """
        result = self._results.setdefault(part["robot"], _Result())
        changed = {*result.findings, *result.errors}
        errors, findings = part["errors"], part["findings"]
        if not errors and findings is not None:
            result.findings, result.errors, result.has_rules = findings, {}, True
        else:
            result.errors = errors
            if not result.has_rules and findings is not None:
                result.findings = _subtract(findings, errors)
        return changed | {*result.findings, *result.errors}

    def move(self, path: str, change: TextChange) -> None:
        """Move the diagnostics of a document by an edit, and drop those whose text it removes."""
        for result in self._results.values():
            for found in (result.findings, result.errors):
                if path in found:
                    found[path] = [one for one in found[path] if not _is_removed(one, change)]
                for diagnostics in found.values():
                    for one in diagnostics:
                        _move_diagnostic(
                            one, path, change, is_of_path=diagnostics is found.get(path)
                        )

    def keep(self, robots: Iterable[str]) -> set[str]:
        """Forget all but some robots, and return the paths whose diagnostics may have changed."""
        gone = self._results.keys() - set(robots)
        results = [self._results.pop(robot) for robot in gone]
        return {path for one in results for path in (*one.findings, *one.errors)}

    def list_diagnostics(self, path: str) -> list[dict[str, Any]]:
        """Return the diagnostics of a file, each once, errors of reading first."""
        found: list[dict[str, Any]] = []
        seen = set()
        results = self._results.values()
        for one in [
            *(one for result in results for one in result.errors.get(path, ())),
            *(one for result in results for one in result.findings.get(path, ())),
        ]:
            key = one["code"], one["message"], str(one["range"])
            if key not in seen:
                seen.add(key)
                found.append(one)
        return found


def _subtract(findings: Found, errors: Found) -> Found:
    """Return findings without the errors among them."""
    return {
        path: [one for one in some if one not in errors.get(path, ())]
        for path, some in findings.items()
    }


def _is_removed(diagnostic: dict[str, Any], change: TextChange) -> bool:
    span = diagnostic["range"]
    return change.is_around(_make_point(span["start"]), _make_point(span["end"]))


def _move_diagnostic(
    diagnostic: dict[str, Any], path: str, change: TextChange, *, is_of_path: bool
) -> None:
    if is_of_path:
        diagnostic["range"] = _move_range(diagnostic["range"], change)
    for related in diagnostic.get("relatedInformation", ()):
        if related["location"]["path"] == path:
            related["location"]["range"] = _move_range(related["location"]["range"], change)


def _move_range(span: Mapping[str, Any], change: TextChange) -> dict[str, Any]:
    return {side: _make_position(change.move(_make_point(span[side]))) for side in ("start", "end")}


def _make_point(position: Mapping[str, int]) -> Point:
    return position["line"], position["character"]


def _make_position(point: Point) -> dict[str, int]:
    return {"line": point[0], "character": point[1]}
