"""Apply fixes to a description until none is left, and prove each step before it is kept.

Nothing is written here. The edited bytes are read in place of the files; they must be well-formed,
expand, and have fewer findings than before. A fix that makes things worse is our bug: it is taken
back and said.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..errors import UrdftoolError
from ..finding import Finding, Remake, Severity
from ..rules.fixes.remakes import remade
from ..source.document import reading_instead
from ..source.nearby import bytes_of
from .outcome import Options, Report
from .run import lint_file

MAX_ROUNDS = 200

REVEALING = frozenset(
    (
        "not-well-formed",
        "content-before-declaration",
        "missing-xmlns",
        "unknown-macro",
        "undeclared-arg",
        "include-not-found",
        "non-boolean-conditional",
        "unprefixed-xacro-tag",
        "bad-substitution-command",
        "unknown-element",
        "unknown-attribute",
        "wrong-case-keyword",
        "unexpanded-expression",
        "not-a-number",
        "wrong-arity",
        "unknown-extension",
        "dangling-reference",
        "misplaced-extension",
        "padded-reference",
        "unknown-joint-type",
        "classic-plugin-in-gz",
        "ros2-control-nested",
        "several-shapes-in-geometry",
        "unknown-parent-link",
        "unknown-child-link",
        "missing-limit",
        "empty-geometry",
        "repeated-element",
    )
)
"""Rules whose fix lets readers see what they passed over, with what is wrong in it."""

_Key = tuple[Any, ...]


@dataclass
class Mended:
    """A description with fixes applied.

    Attributes:
        report: What is wrong with it now.
        before: The bytes of each file that changed, as they were; None for one that is new.
        after: The same as they are to be.
        applied: How many fixes of each rule were made.
        broken: Rules whose fix would have made things worse, with how.
        unmade: Rules whose fix wants a file made of one that cannot be read, with which.
    """

    report: Report
    before: dict[str, bytes | None] = field(default_factory=dict)
    after: dict[str, bytes] = field(default_factory=dict)
    applied: Counter[str] = field(default_factory=Counter)
    broken: dict[str, str] = field(default_factory=dict)
    unmade: dict[str, str] = field(default_factory=dict)


class _Wrong(NamedTuple):
    """Why fixes are not kept, and whether that is for a file they are made of."""

    text: str
    of_a_file: bool = False


def mend(
    report: Report,
    options: Options,
    *,
    unsafe: bool = False,
    others: Sequence[Report] = (),
    keep: Iterable[str] = (),
) -> Mended:
    """Apply the fixes of a description.

    Args:
        report: The description, checked with the same options.
        options: What the command line says; ``fixes`` must be on.
        unsafe: Whether unsafe fixes are applied as well.
        others: Descriptions that may read the same files; they must not become worse.
        keep: Paths of files that are not edited.

    Raises:
        ConfigError: The configuration is wrong.
    """
    mended = Mended(report)
    kept, banned = set(keep), set[_Key]()
    for _ in range(MAX_ROUNDS):
        chosen = _choose(mended.report, unsafe, kept, banned)
        if not chosen:
            break
        if _attempt(mended, chosen, options):
            _one_by_one(mended, chosen, options, banned)
    shared = _worse_for_others(mended, others, options)
    if shared:
        return mend(report, options, unsafe=unsafe, others=others, keep=kept | shared)
    return mended


def _choose(report: Report, unsafe: bool, kept: set[str], banned: set[_Key]) -> list[Finding]:
    """Findings whose fixes do not overlap; what several of them do alike is done once."""
    chosen: list[Finding] = []
    taken: dict[str, list[tuple[int, int, bytes]]] = {}
    for finding in report.findings:
        fix = finding.fix
        if fix is None or not (fix.safe or unsafe) or _key(finding) in banned:
            continue
        if not kept.isdisjoint(fix.paths):
            continue
        spans = [(r.place.path, r.place.start, r.place.end, r.data) for r in fix.replacements]
        spans += [(r.path, 0, _ALL, r.how.encode()) for r in fix.remakes]
        if any(_meets(taken.get(path, []), a, b, data) for path, a, b, data in spans):
            continue
        for path, start, end, data in spans:
            taken.setdefault(path, []).append((start, end, data))
        chosen.append(finding)
    return chosen


_ALL = 1 << 62


def _meets(taken: Sequence[tuple[int, int, bytes]], start: int, end: int, data: bytes) -> bool:
    """Whether bytes are taken; several things may be put in one place, each once."""
    for begin, stop, other in taken:
        if (begin < end and start < stop) or begin < start == end < stop or start < begin < end:
            return True
        if begin == stop == start == end and data == other:
            return True
    return False


def _attempt(mended: Mended, chosen: Sequence[Finding], options: Options) -> _Wrong | None:
    """Apply some fixes at once; gives what would become worse, and None where it was done."""
    replaced: dict[str, list[tuple[int, int, bytes]]] = {}
    files: dict[str, bytes] = {}
    for finding in chosen:
        assert finding.fix is not None
        for replacement in finding.fix.replacements:
            place = replacement.place
            files.setdefault(place.path, _bytes_of(mended, place.path, place.file.data))
            replaced.setdefault(place.path, []).append((place.start, place.end, replacement.data))
    edited = {path: _edited(files[path], spans) for path, spans in replaced.items()}
    before: dict[str, bytes | None] = dict(files)
    try:
        with reading_instead(mended.after):
            for remake in _remakes(chosen):
                now, made = _now(remake.path), remade(remake)
                if now != made:
                    before[remake.path], edited[remake.path] = now, made
    except (UrdftoolError, OSError) as error:
        return _Wrong(f"{remake.origin} cannot be made {remake.how}: {error}", True)
    after = {**mended.after, **edited}
    with reading_instead(after):
        report = lint_file(mended.report.path, options)
    wrong = _worse(mended.report, report, chosen)
    if wrong:
        return _Wrong(wrong)
    for path, data in before.items():
        mended.before.setdefault(path, data)
    mended.after = after
    mended.report = report
    mended.applied.update(finding.rule for finding in chosen)
    return None


def _remakes(chosen: Sequence[Finding]) -> Iterator[Remake]:
    for finding in chosen:
        yield from finding.fix.remakes if finding.fix is not None else ()


def _now(path: str) -> bytes | None:
    """What is in a file; None where it is not there."""
    return bytes_of(path) if os.path.lexists(path) else None


def _bytes_of(mended: Mended, path: str, data: bytes) -> bytes:
    """The bytes that places in a file mean; of one that had to be mended to be read, its own."""
    if path in mended.after:
        return mended.after[path]
    for other in mended.report.findings:
        if other.place.path == path and other.rule in ("not-well-formed", _LATE):
            return other.place.file.data
    return data


_LATE = "content-before-declaration"


def _edited(data: bytes, spans: Sequence[tuple[int, int, bytes]]) -> bytes:
    parts, position = [], 0
    for start, end, new in sorted(spans, key=lambda span: span[:2]):
        parts += [data[position:start], new]
        position = end
    return b"".join([*parts, data[position:]])


def _one_by_one(
    mended: Mended, chosen: Sequence[Finding], options: Options, banned: set[_Key]
) -> None:
    """Apply the fixes of one rule, or one fix; what cannot be applied alone is given up."""
    for rule in dict.fromkeys(finding.rule for finding in chosen):
        some = [finding for finding in chosen if finding.rule == rule]
        if len(some) < len(chosen) and not _attempt(mended, some, options):
            return
        for finding in some:
            wrong = _attempt(mended, [finding], options)
            if wrong is None:
                return
            banned.add(_key(finding))
            kind = mended.unmade if wrong.of_a_file else mended.broken
            kind.setdefault(rule, f"{finding.place}: {wrong.text}")


def _key(finding: Finding) -> _Key:
    """What stands for a finding, also when bytes above it have changed."""
    place = finding.place
    key: _Key = (finding.rule, place.path, finding.kind, finding.name, finding.message)
    return (*key, place.start) if finding.kind == "file" else key


def _worse(before: Report, after: Report, chosen: Sequence[Finding]) -> str:
    """What is worse after some fixes; empty where nothing is."""
    if after.error is not None and before.error is None:
        return f"the file could not be read: {after.error.message}"
    if after.skipped and not before.skipped:
        return f"the file would not be checked: {after.skipped}"
    broke = after.failed_rules.keys() - before.failed_rules.keys()
    if broke:
        return f"the rule {min(broke)} breaks"
    stops = [_stops(before), _stops(after)]
    if len(stops[1]) > len(stops[0]) or (stops[1] and not stops[0]):
        return f"the file could not be read: {stops[1][0].message}"
    left = Counter(map(_key, after.findings))
    there = Counter(map(_key, before.findings))
    for finding in chosen:
        if left[_key(finding)] >= there[_key(finding)]:
            return "the finding is still there"
    if stops[0] or any(finding.rule in REVEALING for finding in chosen):
        return ""
    for level in (Severity.ERROR, Severity.WARNING):
        if _count(after, level) > _count(before, level):
            new = [f for f in after.findings if f.severity >= level and not there[_key(f)]]
            what = f"then {new[0].message} [{new[0].rule}]" if new else ""
            return what or "there would be more findings"
    return ""


def _stops(report: Report) -> list[Finding]:
    """What keeps the robot from being known."""
    return [f for f in report.findings if f.kind == "file" and f.severity is Severity.ERROR]


def _count(report: Report, level: Severity) -> int:
    return sum(finding.severity >= level for finding in report.findings)


def _worse_for_others(mended: Mended, others: Sequence[Report], options: Options) -> set[str]:
    """Edited files whose edits make another description worse that reads them."""
    shared: set[str] = set()
    for other in others:
        common = {path for path in mended.after if path in other.files}
        if not common or other.path == mended.report.path or not other.checked:
            continue
        with reading_instead(mended.after):
            try:
                report = lint_file(other.path, options)
            except UrdftoolError:
                shared |= common
                continue
        if _worse(other, report, ()):
            shared |= common
    return shared


def concerns(report: Report, paths: Iterable[str]) -> bool:
    """Whether a description, or a fix of it, is of any of these files."""
    theirs = set(report.files).union(*(f.fix.paths for f in report.findings if f.fix is not None))
    return not theirs.isdisjoint(paths)


def changed(before: Mapping[str, bytes | None], after: Mapping[str, bytes]) -> list[str]:
    """Paths of the files whose bytes differ."""
    return [path for path, data in after.items() if data != before.get(path)]
