"""Apply the fixes of descriptions until none is left, and prove each step before it is kept.

Nothing is written here. The edited bytes are read in place of the files; they must be well-formed,
expand, and have fewer findings than before. A fix that makes things worse is our bug: it is taken
back and said.

Fixes are applied many at once, those of all descriptions together, and what they concern is linted
once for all of them. Only where that is worse are they tried in halves, and halves of those, until
the fix is found that does it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ..errors import UrdftoolError
from ..finding import FileRewrite, Finding
from ..rules.file_rewrites import rewritten_bytes
from ..rules.table import FIXES
from ..workspace import Workspace
from .fix_proof import REVEALING, Key, Wrong, key_of, likeness, subject_of, worse
from .outcome import Options, Report
from .run import lint_file

MAX_ROUNDS = 200


@dataclass
class FixResult:
    """Descriptions with fixes applied.

    Attributes:
        reports: What is wrong with each now, in the order given.
        before: The bytes of each file that changed, as they were; None for one that is new.
        after: The same as they are to be.
        applied: How many fixes of each rule were made.
        broken: Rules whose fix would have made things worse, with how.
        unmade: Rules whose fix wants a file made of one that cannot be read, with which.
        made: Each fix that was made: its rule, and the files that it changed.
        groups: Files that are written together or not at all.
    """

    reports: list[Report]
    before: dict[str, bytes | None] = field(default_factory=dict)
    after: dict[str, bytes] = field(default_factory=dict)
    applied: Counter[str] = field(default_factory=Counter)
    broken: dict[str, str] = field(default_factory=dict)
    unmade: dict[str, str] = field(default_factory=dict)
    made: list[tuple[str, set[str]]] = field(default_factory=list)
    groups: list[set[str]] = field(default_factory=list)

    def drop(self, paths: set[str]) -> None:
        """Take back the changes of files that are not written, and the count of their fixes."""
        for path in paths:
            del self.before[path], self.after[path]
        for rule, where in self.made:
            if not where.isdisjoint(paths):
                self.applied[rule] -= 1
        self.applied = +self.applied


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


def mend(report: Report, options: Options, *, unsafe: bool = False, meshes: bool = False) -> Mended:
    """Apply the fixes of one description.

    Args:
        report: The description, checked with the same options.
        options: What the command line says; ``fixes`` must be on.
        unsafe: Whether unsafe fixes are applied as well.
        meshes: Whether fixes that write mesh files are applied as well.

    Raises:
        ConfigError: The configuration is wrong.
    """
    done = apply_fixes([report], options, unsafe=unsafe, meshes=meshes)
    return Mended(done.reports[0], done.before, done.after, done.applied, done.broken, done.unmade)


def apply_fixes(
    reports: Sequence[Report], options: Options, *, unsafe: bool = False, meshes: bool = False
) -> FixResult:
    """Apply the fixes of many descriptions, of which none becomes worse.

    Args:
        reports: The descriptions, checked with the same options.
        options: What the command line says; ``fixes`` must be on.
        unsafe: Whether unsafe fixes are applied as well.
        meshes: Whether fixes that write mesh files are applied as well.

    Raises:
        ConfigError: The configuration is wrong.
    """
    result = FixResult(list(reports))
    banned, doubted = set[Key](), set[Key]()
    for _ in range(MAX_ROUNDS):
        chosen = _choose(result.reports, banned, unsafe=unsafe, meshes=meshes)
        if not chosen:
            break
        _Round(result, options, banned, doubted).prove(chosen)
    result.groups = _groups(result)
    return result


class _Wanted(NamedTuple):
    """A fix that is tried: the number of its report, and the finding."""

    number: int
    finding: Finding

    @property
    def paths(self) -> set[str]:
        assert self.finding.fix is not None
        return self.finding.fix.paths


def _choose(
    reports: Sequence[Report], banned: set[Key], *, unsafe: bool, meshes: bool
) -> list[_Wanted]:
    """Findings whose fixes do not overlap; what several of them do alike is done once."""
    chosen: list[_Wanted] = []
    taken: dict[str, list[tuple[int, int, bytes]]] = {}
    for number, report in enumerate(reports):
        for finding in report.findings:
            fix = finding.fix
            if fix is None or not (fix.safe or unsafe) or (fix.rewrites and not meshes):
                continue
            if key_of(finding) in banned:
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


def _meets(taken: Sequence[tuple[int, int, bytes]], start: int, end: int, data: bytes) -> bool:
    """Whether bytes are taken; several things may be put in one place, each once."""
    for begin, stop, other in taken:
        if (begin < end and start < stop) or begin < start == end < stop or start < begin < end:
            return True
        if begin == stop == start == end and data == other:
            return True
    return False


class _Round:
    """Fixes of one choice, all of them in bytes as they are before the first is applied."""

    def __init__(
        self, result: FixResult, options: Options, banned: set[Key], doubted: set[Key]
    ) -> None:
        """Start with nothing applied."""
        self.result = result
        self.options = options
        self.banned = banned
        self.start = dict(result.after)
        self.findings = [report.findings for report in result.reports]
        self.doubted = doubted
        self.kept: list[_Wanted] = []
        self.concerned: dict[str, set[int]] = {}
        for number, report in enumerate(result.reports):
            self._index(number, report)

    def _index(self, number: int, report: Report) -> None:
        for path in _paths(report) if report.error is None and not report.skipped else ():
            self.concerned.setdefault(path, set()).add(number)

    def prove(self, chosen: Sequence[_Wanted]) -> None:
        """Apply what can be applied; fixes with no description in common do not meet.

        Those that reveal what is wrong with what was ignored come by themselves: with one of them,
        more findings are no reason to take the others back. So do new names, after which findings
        are of other subjects. What was wrong with a fix in another description, such as a variant
        of the robot, is likely to be wrong with its like.
        """
        for part in self._apart(chosen):
            self.kept = []
            groups: dict[object, list[_Wanted]] = {}
            for one in part:
                key: object = likeness(one.finding)
                if key not in self.doubted:
                    key = one.finding.rule in REVEALING, FIXES[one.finding.rule].renames
                groups.setdefault(key, []).append(one)
            for some in sorted(groups.values(), key=len, reverse=True):
                self._halve(self._current(some))

    def _current(self, some: Sequence[_Wanted]) -> list[_Wanted]:
        """The fixes whose findings are as they were; of others the next round knows more."""
        there = {
            number: set(map(key_of, self.result.reports[number].findings))
            for number in {one.number for one in some}
        }
        return [one for one in some if key_of(one.finding) in there[one.number]]

    def _apart(self, chosen: Sequence[_Wanted]) -> list[list[_Wanted]]:
        """Sort fixes so that those in two lists concern no description in common."""
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
        """Apply fixes; where that is worse, some of them and then the others.

        What has become worse is mostly what a fix was of; where it is not, they are halved.
        """
        if not chosen:
            return
        wrong = self._attempt(chosen)
        if wrong is None:
            return
        if len(chosen) == 1:
            finding = chosen[0].finding
            self.banned.add(key_of(finding))
            self.doubted.add(likeness(finding))
            kind = self.result.unmade if wrong.of_a_file else self.result.broken
            kind.setdefault(finding.rule, f"{finding.place}: {wrong.text}")
            return
        suspects = [one for one in chosen if subject_of(one.finding) in wrong.subjects]
        others = [one for one in chosen if subject_of(one.finding) not in wrong.subjects]
        if suspects and others:
            self._halve(others)
            self._halve(self._current(suspects))
            return
        if len({subject_of(one.finding) for one in suspects}) == len(chosen):
            for one in suspects:  # each has become worse itself
                self._halve(self._current([one]))
            return
        middle = _middle(chosen)
        self._halve(chosen[:middle])
        self._halve(self._current(chosen[middle:]))

    def _attempt(self, some: Sequence[_Wanted]) -> Wrong | None:
        """Apply fixes beside those that are kept; gives what is worse, None where they are kept."""
        result = self.result
        try:
            before, edited = self._edited([*self.kept, *some])
        except _UnmadeError as error:
            return Wrong(str(error), True)
        after = {**result.after, **edited}
        own = dict.fromkeys(one.number for one in some)
        changed = [path for path, data in edited.items() if result.after.get(path) != data]
        others = sorted(set().union(*(self.concerned.get(path, ()) for path in changed)))
        fresh: dict[int, Report] = {}
        trial = self.options.workspace.with_overlay(after)
        for number in dict.fromkeys((*own, *others)):
            old = result.reports[number]
            new = lint_file(old.path, replace(self.options, workspace=trial))
            wrong = worse(old, new, [one.finding for one in some if one.number == number])
            if wrong:
                return wrong
            fresh[number] = new
        for path, data in before.items():
            result.before.setdefault(path, data)
        result.after = after
        for number, report in fresh.items():
            result.reports[number] = report
            self._index(number, report)
        result.applied.update(one.finding.rule for one in some)
        result.made += [(one.finding.rule, one.paths) for one in some]
        self.kept += some
        return None

    def _edited(
        self, chosen: Sequence[_Wanted]
    ) -> tuple[dict[str, bytes | None], dict[str, bytes]]:
        """The bytes of the files that fixes change, before and after.

        Raises:
            _UnmadeError: A file cannot be made.
        """
        replaced: dict[str, list[tuple[int, int, bytes]]] = {}
        files: dict[str, bytes] = {}
        for number, finding in chosen:
            assert finding.fix is not None
            for replacement in finding.fix.replacements:
                place = replacement.place
                if place.path not in files:
                    files[place.path] = self._bytes_of(number, place.path, place.file.data)
                replaced.setdefault(place.path, []).append(
                    (place.start, place.end, replacement.data)
                )
        edited = {path: _spliced(files[path], spans) for path, spans in replaced.items()}
        before: dict[str, bytes | None] = dict(files)
        workspace = self.options.workspace.with_overlay(self.start)
        for rewrite in _rewrites(one.finding for one in chosen):
            try:
                now, made = _now(workspace, rewrite.path), rewritten_bytes(workspace, rewrite)
            except (UrdftoolError, OSError) as error:
                text = f"{rewrite.origin} cannot be made {rewrite.how}: {error}"
                raise _UnmadeError(text) from error
            if now != made:
                before[rewrite.path], edited[rewrite.path] = now, made
        return before, edited

    def _bytes_of(self, number: int, path: str, data: bytes) -> bytes:
        """The bytes that places in a file mean; of one that was repaired to be read, its own."""
        if path in self.start:
            return self.start[path]
        for other in self.findings[number]:
            if other.place.path == path and other.rule in ("not-well-formed", _LATE):
                return other.place.file.data
        return data


class _UnmadeError(Exception):
    """A file that a fix makes cannot be made; the text says why."""


def _middle(chosen: Sequence[_Wanted]) -> int:
    """Where to part fixes: between two rules, if it can be, as most fail by rule."""
    half = len(chosen) / 2
    edges = [
        n for n in range(1, len(chosen)) if chosen[n].finding.rule != chosen[n - 1].finding.rule
    ]
    return min(edges, key=lambda n: abs(n - half), default=len(chosen) // 2)


def _groups(result: FixResult) -> list[set[str]]:
    """The files that changed, by what is written together: the sources of a description."""
    group = {path: {path} for path in result.after}
    linked = [set(report.files) for report in result.reports]
    for paths in (*linked, *(where for _, where in result.made)):
        met = [group[path] for path in paths if path in group]
        whole = max(met, key=len, default=set[str]())
        for one in met:
            if one is not whole:
                whole |= one
                group.update(dict.fromkeys(one, whole))
    return list({id(one): one for one in group.values()}.values())


def _rewrites(chosen: Iterable[Finding]) -> Iterator[FileRewrite]:
    for finding in chosen:
        yield from finding.fix.rewrites if finding.fix is not None else ()


def _now(workspace: Workspace, path: str) -> bytes | None:
    """What is in a file; None where it is not there."""
    return workspace.read_bytes(path) if workspace.exists_or_is_link(path) else None


_LATE = "content-before-declaration"


def _spliced(data: bytes, spans: Sequence[tuple[int, int, bytes]]) -> bytes:
    parts, position = [], 0
    for start, end, new in sorted(spans, key=lambda span: span[:2]):
        parts += [data[position:start], new]
        position = end
    return b"".join([*parts, data[position:]])


def concerns(report: Report, paths: Iterable[str]) -> bool:
    """Whether a description, or a fix of it, is of any of these files."""
    return not _paths(report).isdisjoint(paths)


def _paths(report: Report) -> set[str]:
    return set(report.files).union(*(f.fix.paths for f in report.findings if f.fix is not None))
