"""What goes into a check of one description, and what comes out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import UrdftoolError
from ..finding import Finding
from ..source.description import GltfUp
from ..workspace import Workspace
from .settings import Settings

if TYPE_CHECKING:
    from ..rules.fix import ComputeInertia
    from .cache import Cache


@dataclass
class Options:
    """What the command line says for every file.

    Attributes:
        settings: Rules, targets, severities.
        arguments: xacro arguments.
        packages: Folders by package name.
        package_paths: Folders with packages below.
        config: A configuration file that was named.
        cache: Where reports are kept for the next time; None keeps none.
        fixes: Whether findings are to say what would mend them, in bytes.
        weigh: What links weigh and how their mass lies, for fixes that fill in inertia: gives
            (mass, centre, six numbers) by link, in the link frame, for a robot and link names.
        gltf_up: The axis that is up in glTF meshes; None for what the configuration says.
        workspace: Reads the files of the run.
    """

    settings: Settings = field(default_factory=Settings)
    arguments: Mapping[str, str] = field(default_factory=dict)
    packages: Mapping[str, str | Path] = field(default_factory=dict)
    package_paths: Iterable[str | Path] = ()
    config: str | None = None
    cache: Cache | None = None
    fixes: bool = False
    weigh: ComputeInertia | None = None
    gltf_up: GltfUp | None = None
    workspace: Workspace = field(default_factory=Workspace)


@dataclass
class Report:
    """What there is to say of one description.

    Attributes:
        path: The description.
        findings: What is wrong with it.
        targets: The targets it was checked for.
        ignored: Findings that comments cover, each with the reason its comment gives.
        files: The files of its source that were read.
        skipped: Why it was not checked; empty if it was.
        error: What kept it from being read.
        stopped: What kept the robot in it from being read, so that nothing of it was checked.
        failed_rules: Rules that broke, which is a bug of ours, with what they raised.
        skipped_rules: Rules that require an optional library that is not installed, with its name.
        skipped_fixes: Rules whose fix requires an optional library that is not installed.
        unmended: Findings whose fix cannot be made in the source, with the reason.
    """

    path: str
    findings: list[Finding] = field(default_factory=list)
    targets: frozenset[str] = frozenset()
    ignored: list[tuple[Finding, str]] = field(default_factory=list)
    files: tuple[str, ...] = ()
    skipped: str = ""
    error: UrdftoolError | None = None
    stopped: str = ""
    failed_rules: dict[str, str] = field(default_factory=dict)
    skipped_rules: dict[str, str] = field(default_factory=dict)
    skipped_fixes: dict[str, str] = field(default_factory=dict)
    unmended: list[tuple[Finding, str]] = field(default_factory=list)

    @property
    def suppressed(self) -> int:
        """How many findings comments cover."""
        return len(self.ignored)

    @property
    def checked(self) -> bool:
        """Whether the robot in it was checked."""
        return not self.skipped and not self.not_checked

    @property
    def not_checked(self) -> str:
        """Why the robot in it was not checked, though it should have been; empty if it was."""
        return self.stopped if self.error is None else self.error.message


@dataclass
class Outcome:
    """What there is to say of all descriptions of a run.

    Attributes:
        reports: A report for each description.
        findings: Their findings, merged, in the order of the source.
        ignored: Findings that comments cover, each with the reason its comment gives.
        known: Findings that the baseline has, which are not among the others.
    """

    reports: list[Report]
    findings: list[Finding]
    ignored: list[tuple[Finding, str]] = field(default_factory=list)
    known: list[Finding] = field(default_factory=list)

    @property
    def skipped_rules(self) -> dict[str, str]:
        """Rules that require an optional library that is not installed, with its name."""
        return {
            rule: library
            for report in self.reports
            for rule, library in sorted(report.skipped_rules.items())
        }

    @property
    def not_checked(self) -> list[Report]:
        """The descriptions whose robot was not checked."""
        return [report for report in self.reports if report.not_checked]

    @property
    def complete(self) -> bool:
        """Whether all robots were checked and no rule broke."""
        return not any(report.not_checked or report.failed_rules for report in self.reports)
