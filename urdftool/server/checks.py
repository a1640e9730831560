"""Checks of the robots that documents belong to, in two steps: reading, then the rules."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from ..errors import SourceError
from ..finding import Finding
from ..lint.options import Options
from ..lint.outcome import Report
from ..lint.run import check_file
from ..lint.settings import Settings
from ..model.elements import Robot
from ..source.description import Description
from ..source.document import parse
from .diagnostics import convert_findings, make_error, make_remark
from .knowledge import MOST_BYTES, Knowledge, RobotState

_NOT_CHECKED = "only its XML is checked while you edit; run 'urdftool lint' for the rest"


class _Reads:
    """Observer that keeps what was read, and passes on why something could not be."""

    def __init__(
        self,
        knowledge: Knowledge,
        on_errors: Callable[[list[Finding]], None],
        poll: Callable[[], None],
    ) -> None:
        self.descriptions: list[tuple[Description, Robot]] = []
        self.files: set[str] = set()
        self.errors: list[Finding] = []
        self._knowledge, self._on_errors, self.check_progress = knowledge, on_errors, poll

    def receive_description(
        self, description: Description, robot: Robot | None, errors: list[Finding]
    ) -> None:
        """Keep a description and its robot."""
        self.files |= {self._knowledge.get_path(file.path) for file in description.files}
        if robot is not None and not errors:
            self.descriptions.append((description, robot))
        if errors:
            self.errors += errors
            self._on_errors(self.errors)


class Checks:
    """Checks that one message asks for."""

    def __init__(
        self, knowledge: Knowledge, emit: Callable[[Any], None], poll: Callable[[], None]
    ) -> None:
        """Create checks."""
        self.knowledge, self._emit, self._poll = knowledge, emit, poll

    def check(self, paths: Iterable[str]) -> dict[str, list[str]]:
        """Check the robots that files belong to, and return these by path of the file."""
        robots = {path: self._list_robots(path) for path in paths}
        for robot in dict.fromkeys(one for some in robots.values() for one in some):
            self._check_robot(robot)
        return robots

    def read(self, path: str) -> None:
        """Read the robots that a file belongs to, without a rule, unless they were read."""
        nothing = Settings(select=())
        for robot in self._list_robots(path):
            state = self.knowledge.states.get(robot)
            if state is not None and state.version == self.knowledge.version:
                continue
            if self.knowledge.is_large(robot):
                continue
            self._run(
                robot, lambda errors: None, replace(self._make_options(robot), settings=nothing)
            )

    def _list_robots(self, path: str) -> list[str]:
        robots = self.knowledge.list_robots(path)
        alone = self.knowledge.is_description(path)
        return robots or ([os.path.realpath(path)] if alone else [])

    def _make_options(self, robot: str) -> Options:
        options = self.knowledge.make_options(robot)
        known = self.knowledge.get_repository(robot).robots
        parts_only = robot.endswith(".xacro") and robot not in known
        return replace(options, expand=not parts_only)

    def _check_large(self, robot: str) -> None:
        """Check only whether a large file is well-formed; a remark reports that."""
        try:
            parse(self.knowledge.read(robot))
            shown = make_remark(robot, f"larger than {MOST_BYTES >> 20} MiB: {_NOT_CHECKED}")
        except SourceError as error:
            shown = make_error(self.knowledge, error, robot)
        reported = {shown.pop("path"): [shown]}
        self.knowledge.states.setdefault(robot, RobotState()).reported = {*reported}
        self._emit({"robot": robot, "errors": {}, "findings": reported, "files": [robot]})

    def _check_robot(self, robot: str) -> None:
        if self.knowledge.is_large(robot):
            self._check_large(robot)
            return

        def emit_errors(errors: list[Finding]) -> None:
            self._emit_result(robot, errors, None, reads)

        reads = _Reads(self.knowledge, emit_errors, self._poll)
        report = self._run(robot, emit_errors, self._make_options(robot), reads)
        failed = [] if report.error is None else [make_error(self.knowledge, report.error, robot)]
        findings = [] if reads.errors else report.findings
        if report.error is not None or reads.errors:
            self._emit_result(robot, reads.errors, report.findings, reads, failed)
        else:
            self._emit_result(robot, [], findings, reads)

    def _run(
        self,
        robot: str,
        on_errors: Callable[[list[Finding]], None],
        options: Options,
        reads: _Reads | None = None,
    ) -> Report:
        reads = reads or _Reads(self.knowledge, on_errors, self._poll)
        report = check_file(robot, replace(options, observer=reads))
        state = self.knowledge.states.setdefault(robot, RobotState())
        state.files = {robot, *reads.files, *(state.files if reads.errors else ())}
        state.version = self.knowledge.version
        if reads.descriptions and not reads.errors:
            state.descriptions = reads.descriptions
        return report

    def _emit_result(
        self,
        robot: str,
        errors: list[Finding],
        findings: list[Finding] | None,
        reads: _Reads,
        failed: Iterable[dict[str, Any]] = (),
    ) -> None:
        """Send findings; ``errors`` say why they are not those of the whole robot."""
        converted = convert_findings(self.knowledge, errors)
        for one in failed:
            converted.setdefault(one.pop("path"), []).append(one)
        shown = None if findings is None else convert_findings(self.knowledge, findings)
        state = self.knowledge.states.setdefault(robot, RobotState())
        state.reported = {*converted, *(state.reported if shown is None else shown)}
        self._emit(
            {
                "robot": robot,
                "errors": converted,
                "findings": shown,
                "files": sorted({robot, *reads.files}),
            }
        )
