"""Results of checks: the report of a description, and the outcome of a run."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from ..errors import UrdftoolError
from ..finding import Finding

NOT_EXPANDED = "xacro, which --no-expand does not expand; only the source was checked"


@dataclass
class Report:
    """Result of checking one description.

    Attributes:
        path: Path of the description.
        findings: Findings that are not suppressed.
        targets: Targets for which it was checked.
        readers: Readers that the code of its project imports; empty if that is unknown.
        overruled: Why a generation of Gazebo of which it has a plugin is not a target.
        rejected: Rules by whose effects a reader rejects the robot, by reader.
        ignored: Suppressed findings, each with the reason in its comment.
        files: Source files read.
        format: Name of the format of the description.
        unread: What a reader of another format than URDF left out, and so was not checked.
        unknown_arguments: Given xacro arguments without effect, each with the declared ones.
        skipped: Reason why it was not checked; empty if it was.
        error: Error that prevented reading it.
        stopped: Reason why its robot could not be read, so that it was not checked.
        completed_by: How code of its project completes it before it is loaded, if that is why it
            was not checked.
        failed_rules: Exception by rule; each is a bug of urdftool.
        skipped_rules: Missing optional library by rule that requires it.
        skipped_fixes: Missing optional library by rule whose fix requires it.
        not_fixed: Findings whose fix cannot be applied to the source, with the reason.
        outside: Findings whose fix would change a file outside of the package, with both.
        unread_meshes: Why a mesh file may not be read, so that it was not checked, by its URI.
        unread_files: Why a file next to the robot could not be read, so that it was not checked, by
            its path.
        for_other_readers: Number of findings by rule that are left out, because they have effects
            only on readers that the code of the project does not import.
        about_dynamics: Number of these that are about dynamics, which no code of it computes.
        minor: Number of infos and cases of rules that are off by default.
        rows: Rows of the queries on which it depends; None if it is not in a cache.
    """

    path: str
    findings: list[Finding] = field(default_factory=list)
    targets: frozenset[str] = frozenset()
    readers: frozenset[str] = frozenset()
    overruled: str = ""
    rejected: dict[str, tuple[str, ...]] = field(default_factory=dict)
    ignored: list[tuple[Finding, str]] = field(default_factory=list)
    files: tuple[str, ...] = ()
    format: str = "urdf"
    unread: Sequence[Finding] = ()
    unknown_arguments: dict[str, tuple[str, ...]] = field(default_factory=dict)
    skipped: str = ""
    error: UrdftoolError | None = None
    stopped: str = ""
    completed_by: str = ""
    failed_rules: dict[str, str] = field(default_factory=dict)
    skipped_rules: dict[str, str] = field(default_factory=dict)
    skipped_fixes: dict[str, str] = field(default_factory=dict)
    not_fixed: list[tuple[Finding, str]] = field(default_factory=list)
    outside: list[tuple[Finding, str]] = field(default_factory=list)
    unread_meshes: dict[str, str] = field(default_factory=dict)
    unread_files: dict[str, str] = field(default_factory=dict)
    for_other_readers: dict[str, int] = field(default_factory=dict)
    about_dynamics: int = 0
    minor: int = 0
    rows: Sequence[tuple[Any, ...]] | None = field(default=None, compare=False, repr=False)

    @property
    def suppressed(self) -> int:
        """Return the number of suppressed findings."""
        return len(self.ignored)

    @property
    def checked(self) -> bool:
        """Tell whether the robot was checked."""
        return not self.skipped and not self.not_checked

    @property
    def unexpanded(self) -> bool:
        """Tell whether it is xacro of which only the source was checked."""
        return self.skipped == NOT_EXPANDED

    @property
    def not_checked(self) -> str:
        """Return why the robot was not checked, though it should have been; empty if it was."""
        return self.stopped if self.error is None else self.error.message


@dataclass
class Outcome:
    """Result of a run over several descriptions.

    Attributes:
        reports: Report of each description.
        findings: Merged findings of all reports, in the order of the source.
        ignored: Suppressed findings, each with the reason in its comment.
        known: Findings in the baseline, which are not in ``findings``.
    """

    reports: list[Report]
    findings: list[Finding]
    ignored: list[tuple[Finding, str]] = field(default_factory=list)
    known: list[Finding] = field(default_factory=list)

    @property
    def skipped_rules(self) -> dict[str, str]:
        """Return the missing optional library by rule that requires it."""
        return {
            rule: library
            for report in self.reports
            for rule, library in sorted(report.skipped_rules.items())
        }

    @property
    def unread_meshes(self) -> dict[str, list[str]]:
        """Return the URIs of meshes that were not checked by the reason, each once."""
        found: dict[str, list[str]] = {}
        for report in self.reports:
            for uri, reason in report.unread_meshes.items():
                uris = found.setdefault(reason, [])
                if uri not in uris:
                    uris.append(uri)
        return found

    @property
    def unread_files(self) -> dict[str, str]:
        """Return why files next to robots were not checked, by path."""
        return {path: why for one in self.reports for path, why in one.unread_files.items()}

    @property
    def for_other_readers(self) -> dict[str, int]:
        """Return the number of findings that are left out for other readers, by rule."""
        left_out: Counter[str] = Counter()
        for report in self.reports:
            left_out.update(report.for_other_readers)
        return dict(left_out)

    @property
    def not_checked(self) -> list[Report]:
        """Return the descriptions whose robot was not checked."""
        return [report for report in self.reports if report.not_checked]

    @property
    def complete(self) -> bool:
        """Tell whether all robots were checked without an exception in a rule."""
        return not any(report.not_checked or report.failed_rules for report in self.reports)
