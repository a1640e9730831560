"""Application of fixes until none is left, with a check of each step.

Nothing is written here. Edited bytes are read through a workspace overlay; they must be
well-formed, expand, and have fewer findings. A fix that makes the report worse is a bug of
urdftool: it is reverted and reported.

Fixes of all descriptions are applied together and linted once. If the result is worse, they are
bisected until the fix that causes it is found.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ..diagnostic import FileRewrite
from ..errors import UrdftoolError
from ..finding import Finding
from ..rules.file_rewrites import compute_rewritten_bytes
from ..rules.table import FIXES
from ..workspace import Workspace
from .fix_proof import Key, Wrong, find_regression, get_key, get_likeness, get_subject
from .options import Options
from .outcome import Report
from .run import check_file

MAX_ROUNDS = 200
"""Number of rounds of fixes, so that two fixes that undo each other end. Chosen, no source."""


class AppliedFix(NamedTuple):
    """Applied fix.

    Attributes:
        finding: The finding, with its fix.
        round: Number of its round, from 1; the places of its edits are those before the round.
    """

    finding: Finding
    round: int

    @property
    def paths(self) -> set[str]:
        """Paths of the files that it changed."""
        assert self.finding.fix is not None
        return self.finding.fix.paths


@dataclass
class FixResult:
    """Descriptions with fixes applied.

    Attributes:
        reports: Present report of each description, in the order given.
        before: Original bytes of each changed file; None for a new file.
        after: New bytes of the same files.
        applied: Number of applied fixes by rule.
        broken: Reason for reverted fixes, by rule.
        unmade: Reason for fixes that need a file that cannot be computed, by rule.
        made: The applied fixes.
        reverted: Findings whose fixes were not applied, with what would be worse.
        unwritten: Fixes that were made, but whose files could not be written.
        groups: Sets of files that are written together or not at all.
        is_exhausted: Whether fixes were left out after ``MOST_TRIALS`` attempts.
    """

    reports: list[Report]
    before: dict[str, bytes | None] = field(default_factory=dict)
    after: dict[str, bytes] = field(default_factory=dict)
    applied: Counter[str] = field(default_factory=Counter)
    broken: dict[str, str] = field(default_factory=dict)
    unmade: dict[str, str] = field(default_factory=dict)
    made: list[AppliedFix] = field(default_factory=list)
    reverted: list[tuple[Finding, Wrong]] = field(default_factory=list)
    unwritten: list[AppliedFix] = field(default_factory=list)
    groups: list[set[str]] = field(default_factory=list)
    is_exhausted: bool = False

    def forget_reverted(self) -> None:
        """Discard what is known of fixes that were not applied, before they are tried again."""
        self.broken, self.unmade, self.reverted = {}, {}, []

    def drop(self, paths: set[str]) -> None:
        """Discard the changes of files that are not written, and the count of their fixes."""
        for path in paths:
            del self.before[path], self.after[path]
        self.unwritten += [one for one in self.made if not one.paths.isdisjoint(paths)]
        self.made = [one for one in self.made if one.paths.isdisjoint(paths)]
        self.applied = Counter(one.finding.code for one in self.made)


@dataclass
class FixedDescription:
    """Description with fixes applied.

    Attributes:
        report: Present report.
        before: Original bytes of each changed file; None for a new file.
        after: New bytes of the same files.
        applied: Number of applied fixes by rule.
        broken: Reason for reverted fixes, by rule.
        unmade: Reason for fixes that need a file that cannot be computed, by rule.
    """

    report: Report
    before: dict[str, bytes | None] = field(default_factory=dict)
    after: dict[str, bytes] = field(default_factory=dict)
    applied: Counter[str] = field(default_factory=Counter)
    broken: dict[str, str] = field(default_factory=dict)
    unmade: dict[str, str] = field(default_factory=dict)


def fix_description(
    report: Report, options: Options, *, unsafe: bool = False, meshes: bool = False
) -> FixedDescription:
    """Apply the fixes of one description.

    Args:
        report: Report of the description, made with the same options.
        options: Options of the command line; ``fixes`` must be on.
        unsafe: Whether to apply unsafe fixes too.
        meshes: Whether to apply fixes that write mesh files too.

    Raises:
        ConfigError: The configuration is invalid.
    """
    done = apply_fixes([report], options, unsafe=unsafe, meshes=meshes)
    return FixedDescription(
        done.reports[0], done.before, done.after, done.applied, done.broken, done.unmade
    )


def apply_fixes(
    reports: Sequence[Report], options: Options, *, unsafe: bool = False, meshes: bool = False
) -> FixResult:
    """Apply the fixes of many descriptions; no description gets worse.

    Arguments are those of :func:`fix_description`.

    Raises:
        ConfigError: The configuration is invalid.
    """
    result = FixResult(list(reports))
    number = 0
    while number < MAX_ROUNDS:
        begun, banned, doubted = len(result.made), set[Key](), set[Key]()
        result.forget_reverted()
        while number < MAX_ROUNDS and not result.is_exhausted:
            chosen = _choose(result.reports, banned, unsafe=unsafe, meshes=meshes)
            if not chosen:
                break
            number += 1
            _Round(result, options, banned, doubted, number).prove(chosen)
        if len(result.made) == begun or not banned or result.is_exhausted:
            break  # other fixes were made since: a reverted one may be right now
    result.groups = _get_groups(result)
    return result


MOST_TRIALS = 120
"""Attempts to apply fixes of one description, or of several that share files, in one round.

Each attempt checks them. Chosen, no source.
"""


class _Wanted(NamedTuple):
    """Candidate fix: the index of its report, and the finding."""

    number: int
    finding: Finding

    @property
    def paths(self) -> set[str]:
        assert self.finding.fix is not None
        return self.finding.fix.paths


def _choose(
    reports: Sequence[Report], banned: set[Key], *, unsafe: bool, meshes: bool
) -> list[_Wanted]:
    """Return findings with non-overlapping fixes; identical changes are chosen once."""
    chosen: list[_Wanted] = []
    taken: dict[str, list[tuple[int, int, bytes]]] = {}
    for number, report in enumerate(reports):
        for finding in report.findings:
            fix = finding.fix
            if fix is None or not (fix.safe or unsafe) or (fix.rewrites and not meshes):
                continue
            if finding.is_deferred or get_key(finding) in banned:
                continue
            spans = [(r.place.path, r.place.start, r.place.end, r.data) for r in fix.replacements]
            spans += [(r.path, 0, _ALL, r.how.encode()) for r in fix.rewrites]
            if any(_meets(taken.get(path, []), a, b, data) for path, a, b, data in spans):
                continue
            for path, start, end, data in spans:
                taken.setdefault(path, []).append((start, end, data))
            chosen.append(_Wanted(number, finding))
    return chosen


_ALL = 1 << 62
"""A byte after the end of every file, by definition."""


def _meets(taken: Sequence[tuple[int, int, bytes]], start: int, end: int, data: bytes) -> bool:
    """Tell whether bytes are already changed; different insertions at one place do not conflict."""
    for begin, stop, other in taken:
        if (begin < end and start < stop) or begin < start == end < stop or start < begin < end:
            return True
        if begin == stop == start == end and data == other:
            return True
    return False


class _Round:
    """Fixes of one selection; their spans refer to the bytes before the first of them."""

    def __init__(
        self,
        result: FixResult,
        options: Options,
        banned: set[Key],
        doubted: set[Key],
        number: int,
    ) -> None:
        """Create a round, by its number, with no fix applied."""
        self.number = number
        self.result = result
        self.options = options
        self.banned = banned
        self.start = dict(result.after)
        self.findings = [report.findings for report in result.reports]
        self.doubted = doubted
        self.kept: list[_Wanted] = []
        self.trials = 0
        self.concerned: dict[str, set[int]] = {}
        for number, report in enumerate(result.reports):
            self._index(number, report)

    def _index(self, number: int, report: Report) -> None:
        for path in _collect_paths(report) if report.error is None and not report.skipped else ():
            self.concerned.setdefault(path, set()).add(number)

    def prove(self, chosen: Sequence[_Wanted]) -> None:
        """Apply the fixes that do not make a report worse.

        Fixes without a common description are independent. Fixes that reveal content are tried
        separately, since more findings are no reason to revert them, and so are renames, since
        findings then have other objects. A fix like one that failed in another description, such as
        a variant of the robot, is tried separately too.
        """
        for part in self._partition(chosen):
            self.kept, self.trials = [], 0
            groups: dict[object, list[_Wanted]] = {}
            for one in part:
                key: object = get_likeness(one.finding)
                if key not in self.doubted:
                    traits = FIXES[one.finding.code]
                    key = traits.reveals, traits.renames
                groups.setdefault(key, []).append(one)
            for some in sorted(groups.values(), key=len, reverse=True):
                self._halve(self._list_pending(some))

    def _list_pending(self, some: Sequence[_Wanted]) -> list[_Wanted]:
        """Return the fixes whose findings still exist; the next round handles the others."""
        there = {
            number: set(map(get_key, self.result.reports[number].findings))
            for number in {one.number for one in some}
        }
        return [one for one in some if get_key(one.finding) in there[one.number]]

    def _partition(self, chosen: Sequence[_Wanted]) -> list[list[_Wanted]]:
        """Partition fixes into lists that concern no common description."""
        group = {n: n for n in range(len(self.result.reports))}

        def root(number: int) -> int:
            while group[number] != number:
                number = group[number] = group[group[number]]
            return number

        for one in chosen:
            for path in one.paths:
                for other in self.concerned.get(path, ()):
                    group[root(other)] = root(one.number)
        parts: dict[int, list[_Wanted]] = {}
        for one in chosen:
            parts.setdefault(root(one.number), []).append(one)
        return list(parts.values())

    def _halve(self, chosen: Sequence[_Wanted]) -> None:
        """Apply fixes; if the result is worse, apply subsets.

        Objects with more findings are mostly those of a faulty fix; their fixes are separated from
        the others. Otherwise the fixes are bisected.
        """
        if not chosen:
            return
        if self.trials >= MOST_TRIALS:
            self._leave_out(chosen)
            return
        self.trials += 1
        wrong = self._try_fixes(chosen)
        if wrong is None:
            return
        if len(chosen) == 1:
            finding = chosen[0].finding
            self.banned.add(get_key(finding))
            self.doubted.add(get_likeness(finding))
            self.result.reverted.append((finding, wrong))
            kind = self.result.unmade if wrong.of_a_file else self.result.broken
            kind.setdefault(finding.code, f"{finding.location}: {wrong.text}")
            return
        suspects = [one for one in chosen if get_subject(one.finding) in wrong.subjects]
        others = [one for one in chosen if get_subject(one.finding) not in wrong.subjects]
        if suspects and others:
            self._halve(others)
            self._halve(self._list_pending(suspects))
            return
        if len({get_subject(one.finding) for one in suspects}) == len(chosen):
            for one in suspects:  # every object got worse by itself
                self._halve(self._list_pending([one]))
            return
        middle = _choose_split(chosen)
        self._halve(chosen[:middle])
        self._halve(self._list_pending(chosen[middle:]))

    def _leave_out(self, chosen: Sequence[_Wanted]) -> None:
        """Leave out fixes for which there were too many attempts; the next run tries them."""
        self.result.is_exhausted = True
        why = f"not tried after {MOST_TRIALS} attempts; run --fix again"
        for finding in (one.finding for one in chosen):
            self.banned.add(get_key(finding))
            self.result.unmade.setdefault(finding.code, f"{finding.location}: {why}")

    def _try_fixes(self, some: Sequence[_Wanted]) -> Wrong | None:
        """Apply fixes in addition to the kept ones; return what is worse, None if they are kept."""
        result = self.result
        try:
            before, edited = self._edit_files([*self.kept, *some])
        except _UnmadeError as error:
            return Wrong(str(error), True)
        after = {**result.after, **edited}
        own = dict.fromkeys(one.number for one in some)
        changed = [path for path, data in edited.items() if result.after.get(path) != data]
        others = sorted(set().union(*(self.concerned.get(path, ()) for path in changed)))
        fresh: dict[int, Report] = {}
        trial = self.options.workspace.get_with_overlay(after)
        for number in dict.fromkeys((*own, *others)):
            old = result.reports[number]
            new = check_file(old.path, replace(self.options, workspace=trial))
            chosen = [one.finding for one in some if one.number == number]
            shared = [one.finding for one in some if one.number != number]
            wrong = find_regression(old, new, chosen, shared)
            if wrong:
                return wrong
            fresh[number] = new
        for path, data in before.items():
            result.before.setdefault(path, data)
        result.after = after
        for number, report in fresh.items():
            result.reports[number] = report
            self._index(number, report)
        result.applied.update(one.finding.code for one in some)
        result.made += [AppliedFix(one.finding, self.number) for one in some]
        self.kept += some
        return None

    def _edit_files(
        self, chosen: Sequence[_Wanted]
    ) -> tuple[dict[str, bytes | None], dict[str, bytes]]:
        """Return the bytes of the files that fixes change, before and after.

        Raises:
            _UnmadeError: A file cannot be computed.
        """
        replaced: dict[str, list[tuple[int, int, bytes]]] = {}
        files: dict[str, bytes] = {}
        for number, finding in chosen:
            assert finding.fix is not None
            for replacement in finding.fix.replacements:
                place = replacement.place
                if place.path not in files:
                    files[place.path] = self._get_bytes(number, place.path, place.file.data)
                replaced.setdefault(place.path, []).append(
                    (place.start, place.end, replacement.data)
                )
        edited = {path: _splice(files[path], spans) for path, spans in replaced.items()}
        before: dict[str, bytes | None] = dict(files)
        workspace = self.options.workspace.get_with_overlay(self.start)
        for rewrite in _list_rewrites(one.finding for one in chosen):
            try:
                now, made = (
                    _read_current(workspace, rewrite.path),
                    compute_rewritten_bytes(workspace, rewrite),
                )
            except (UrdftoolError, OSError) as error:
                text = f"{rewrite.origin} cannot be made {rewrite.how}: {error}"
                raise _UnmadeError(text) from error
            if now != made:
                before[rewrite.path], edited[rewrite.path] = now, made
        return before, edited

    def _get_bytes(self, number: int, path: str, data: bytes) -> bytes:
        """Return the bytes to which spans of a file refer; the original of a repaired file."""
        if path in self.start:
            return self.start[path]
        for other in self.findings[number]:
            if other.location.path == path and other.code in ("not-well-formed", _LATE):
                return other.location.file.data
        return data


class _UnmadeError(Exception):
    """Error for a file of a fix that cannot be computed; the text gives the reason."""


def _choose_split(chosen: Sequence[_Wanted]) -> int:
    """Return where to split fixes: near the middle, between two rules, since most fail by rule."""
    half = len(chosen) / 2
    edges = [
        n for n in range(1, len(chosen)) if chosen[n].finding.code != chosen[n - 1].finding.code
    ]
    return min(edges, key=lambda n: abs(n - half), default=len(chosen) // 2)


def _get_groups(result: FixResult) -> list[set[str]]:
    """Return the changed files, grouped by descriptions and fixes that they share."""
    group = {path: {path} for path in result.after}
    linked = [set(report.files) for report in result.reports]
    for paths in (*linked, *(one.paths for one in result.made)):
        met = [group[path] for path in paths if path in group]
        whole = max(met, key=len, default=set[str]())
        for one in met:
            if one is not whole:
                whole |= one
                group.update(dict.fromkeys(one, whole))
    return list({id(one): one for one in group.values()}.values())


def _list_rewrites(chosen: Iterable[Finding]) -> Iterator[FileRewrite]:
    for finding in chosen:
        yield from finding.fix.rewrites if finding.fix is not None else ()


def _read_current(workspace: Workspace, path: str) -> bytes | None:
    """Return the contents of a file; None if it does not exist."""
    return workspace.read_bytes(path) if workspace.exists_or_is_link(path) else None


_LATE = "content-before-declaration"


def _splice(data: bytes, spans: Sequence[tuple[int, int, bytes]]) -> bytes:
    parts, position = [], 0
    for start, end, new in sorted(spans, key=lambda span: span[:2]):
        parts += [data[position:start], new]
        position = end
    return b"".join([*parts, data[position:]])


def is_concerned(report: Report, paths: Iterable[str]) -> bool:
    """Tell whether a description or one of its fixes uses any of the files."""
    return not _collect_paths(report).isdisjoint(paths)


def _collect_paths(report: Report) -> set[str]:
    return set(report.files).union(*(f.fix.paths for f in report.findings if f.fix is not None))


def __getattr__(name: str) -> object:
    """Return a class by its deprecated name."""
    if name == "Mended":
        import warnings

        warnings.warn("Mended is deprecated; use FixedDescription", DeprecationWarning, 2)
        return FixedDescription
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
