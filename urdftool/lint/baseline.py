"""Baselines: files of known findings, so that only new findings fail.

An entry identifies its finding by :func:`fingerprint` instead of its line, and its file by the path
relative to the folder of the baseline. ``count`` is the number of equal findings in the file.
"""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from ..errors import ConfigError
from ..finding import Finding
from ..rules.old_names import resolve_rule
from .fingerprint import compute_fingerprint
from .outcome import Outcome

_KEYS = {"path", "rule", "element", "fingerprint", "count"}


class Entry(NamedTuple):
    """Identity of a finding.

    Attributes:
        path: File, relative to the folder of the baseline.
        rule: Name of the rule.
        kind: Kind of the object: ``link``, ``joint``, …
        name: Name of the object.
        fingerprint: Fingerprint, which covers attributes too.
    """

    path: str
    rule: str
    kind: str
    name: str
    fingerprint: str


@dataclass
class Baseline:
    """Known findings and their numbers.

    Attributes:
        path: Path of the file.
        counts: Number of findings by entry.
    """

    path: str
    counts: Mapping[Entry, int] = field(default_factory=dict)

    def get_entry(self, finding: Finding) -> Entry:
        """Return the entry of a finding in this file."""
        path = finding.location.path
        if finding.location.file.path != "<stdin>":
            folder = os.path.dirname(os.path.abspath(self.path))
            path = os.path.relpath(os.path.abspath(path), folder).replace(os.sep, "/")
        return Entry(path, finding.code, finding.kind, finding.name, compute_fingerprint(finding))

    def get_file(self, entry: Entry) -> str:
        """Return the absolute path of the file of an entry."""
        return os.path.abspath(
            os.path.join(os.path.dirname(os.path.abspath(self.path)), entry.path)
        )


def read_baseline(path: str) -> Baseline:
    """Read a baseline.

    Raises:
        ConfigError: It cannot be read, or is not in the format of ``--write-baseline``.
    """
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            raise ConfigError("is not a file; give the path of a baseline", path=path)
        with open(path, encoding="utf-8") as stream:
            table = json.load(stream)
    except OSError as error:
        raise ConfigError(
            f"cannot be read: {error.strerror}; create one with --write-baseline", path=path
        ) from None
    except json.JSONDecodeError as error:
        where = f"line {error.lineno}, column {error.colno}"
        raise ConfigError(f"is not valid JSON ({where}: {error.msg})", path=path) from None
    except (UnicodeDecodeError, RecursionError):
        raise ConfigError(
            "is not a baseline; create one with --write-baseline", path=path
        ) from None
    if not isinstance(table, dict) or not isinstance(table.get("findings"), list):
        raise ConfigError("is not a baseline; create one with --write-baseline", path=path)
    if table.get("version") != 1:
        version = table.get("version")
        raise ConfigError(
            f"is a baseline of version {version!r}; urdftool reads version 1", path=path
        )
    counts: dict[Entry, int] = {}
    for number, record in enumerate(table["findings"], start=1):
        entry, count = _read_entry(record, number, path)
        counts[entry] = max(count, counts.get(entry, 0))
    return Baseline(path, counts)


def _read_entry(record: Any, number: int, path: str) -> tuple[Entry, int]:
    fault = f"entry {number} must have path, rule, element, fingerprint and count"
    if not isinstance(record, dict) or set(record) != _KEYS:
        raise ConfigError(fault, path=path)
    element, count = record["element"], record["count"]
    if not isinstance(element, dict) or set(element) != {"kind", "name"}:
        raise ConfigError(f"{fault}: an element must have a kind and a name", path=path)
    words = (record["path"], record["rule"], element["kind"], element["name"])
    entry = Entry(*words, record["fingerprint"])
    if not all(isinstance(word, str) for word in entry):
        raise ConfigError(f"{fault}: all values but the count must be text", path=path)
    entry = entry._replace(rule=resolve_rule(entry.rule))
    if isinstance(count, bool) or not isinstance(count, int) or count < 1:
        raise ConfigError(f"{fault}: the count must be at least 1", path=path)
    return entry, count


def compare(outcome: Outcome, baseline: Baseline) -> tuple[Outcome, list[Entry]]:
    """Separate the known findings of a run; return the run and the entries without a finding."""
    left = Counter(baseline.counts)
    new: list[Finding] = []
    known: list[Finding] = []
    matched: set[Entry] = set()
    for finding in outcome.findings:
        entry = baseline.get_entry(finding)
        if left[entry] > 0 and not finding.unchecked:
            left[entry] -= 1
            matched.add(entry)
            known.append(finding)
        else:
            new.append(finding)
    unmatched = [entry for entry in baseline.counts if entry not in matched]
    return replace(outcome, findings=new, known=known), unmatched


def make_baseline(path: str, findings: Iterable[Finding], kept: Mapping[Entry, int]) -> Baseline:
    """Return a baseline with the present findings."""
    counts = Counter(map(Baseline(path).get_entry, findings))
    return Baseline(path, {**kept, **counts})


def to_text(baseline: Baseline) -> str:
    """Return a baseline as JSON with one sorted entry per line, so that changes merge well."""
    lines = []
    for entry, count in sorted(baseline.counts.items()):
        record = {
            "path": entry.path,
            "rule": entry.rule,
            "element": {"kind": entry.kind, "name": entry.name},
            "fingerprint": entry.fingerprint,
            "count": count,
        }
        lines.append("  " + json.dumps(record))
    inside = "\n" + ",\n".join(lines) + "\n " if lines else ""
    return f'{{\n "version": 1,\n "findings": [{inside}]\n}}\n'
