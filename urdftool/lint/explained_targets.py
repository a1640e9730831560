"""Why a description is checked for its targets: evidence, packages, arguments, controllers."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ..configuration import find_configuration
from ..errors import PackageNotFound
from ..finding import Finding
from ..model.elements import Robot
from ..model.shapes import Mesh
from ..rules.control.controller_files import Package
from ..source.description import Description
from ..source.packages import shorten_path
from .evidence import GENERATIONS, Evidence, Signs
from .options import Options
from .outcome import Report
from .repository import RobotFile
from .run import check_file
from .settings import read_settings
from .targets import Inference, infer_targets

_PACKAGE = re.compile(r"^(?:package|model)://([^/]+)/")
_QUICK = "not-well-formed"
"""Rule that is run where a description is read only for its targets."""


class ControllerUse(NamedTuple):
    """A file with controllers for a robot."""

    path: str
    why: str
    controllers: dict[str, str]


@dataclass
class ExplainedTargets:
    """Targets of a description, with all that was found of them.

    Attributes:
        path: Path of the description.
        targets: The targets for which it is checked.
        set_by: What sets the targets; empty if they are inferred.
        evidence: The first place of each statement, and why it does not count; empty if it does.
        packages: Folder of each package that it uses; None if it is not found.
        arguments: Sets of xacro arguments that launch files pass, each with its place; None if no
            folder was searched.
        computed: Place of each argument whose value a launch file computes.
        controllers: Files with controllers for it.
        not_checked: Why it could not be read; empty if it was.
    """

    path: str
    targets: frozenset[str] = frozenset()
    set_by: str = ""
    evidence: dict[Evidence, str] = field(default_factory=dict)
    packages: dict[str, str | None] = field(default_factory=dict)
    arguments: list[tuple[dict[str, str], str]] | None = None
    computed: dict[str, str] = field(default_factory=dict)
    controllers: list[ControllerUse] = field(default_factory=list)
    not_checked: str = ""


class _Reader:
    """Observer that keeps the robot of each variant of a description."""

    def __init__(self) -> None:
        self.read: list[tuple[Robot, Description]] = []

    def receive_description(
        self, description: Description, robot: Robot | None, errors: list[Finding]
    ) -> None:
        """Keep a robot and its description."""
        if robot is not None:
            self.read.append((robot, description))

    def check_progress(self) -> None:
        """Let the check go on."""


def explain_targets(path: str, options: Options, robot: RobotFile | None) -> ExplainedTargets:
    """Read a description as ``lint`` does, and return its targets with their evidence.

    Raises:
        ConfigError: The configuration is invalid.
    """
    reader = _Reader()
    settings = replace(options.settings, select=(_QUICK,))
    quick = replace(options, settings=settings, cache=None, fixes=False, observer=reader)
    report = check_file(path, quick)
    found = ExplainedTargets(path, report.targets, _name_setter(path, options))
    found.not_checked = report.not_checked or report.skipped
    if robot is not None:
        found.arguments = list(zip(robot.variants, robot.places, strict=True))
        found.computed = robot.computed
    for one, description in reader.read:
        _add_evidence(found, one, description, report)
        _add_packages(found, one, description)
        _add_controllers(found, one, description)
    return found


def _name_setter(path: str, options: Options) -> str:
    """Return what sets the targets of a description; empty if nothing does."""
    if options.settings.targets is not None:
        return "--target"
    configuration = find_configuration(path, options.config, options.workspace)
    settings = read_settings(path, configuration, options.settings)
    return "" if settings.targets is None else shorten_path(configuration.path or "")


def _add_evidence(
    found: ExplainedTargets, robot: Robot, description: Description, report: Report
) -> None:
    inference = infer_targets(robot, description)
    signs = Signs(robot, description)
    shown = {(one.target, one.source, one.text) for one in found.evidence}
    for evidence in (*signs.list_all(), *inference.guesses):
        statement = evidence.target, evidence.source, evidence.text
        if evidence in found.evidence or statement not in shown:
            why = _explain_ignored(evidence, found, inference, signs)
            found.evidence[evidence] = why and found.evidence.get(evidence, why)
            shown.add(statement)


def _explain_ignored(
    evidence: Evidence, found: ExplainedTargets, inference: Inference, signs: Signs
) -> str:
    """Return why a piece of evidence does not count; empty if it does."""
    if found.set_by:
        return "" if evidence.target in found.targets else f"{found.set_by} sets the targets"
    if evidence.target in inference.targets:
        return ""
    if inference.imported:
        return f"the project uses {', '.join(sorted(inference.imported))}"
    if evidence.target not in GENERATIONS:
        return "the description is for ROS 2"
    if not signs.plugins and signs.first_block is None:
        return "the robot has no <gazebo> element"
    return inference.overruled or "the package or its launch files decide"


def _add_packages(found: ExplainedTargets, robot: Robot, description: Description) -> None:
    packages = description.packages
    own = None if description.path == "-" else packages.own
    if own is not None:
        found.packages[own[0]] = shorten_path(own[1])
    for name in _list_mesh_packages(robot):
        try:
            found.packages[name] = shorten_path(packages.find(name))
        except PackageNotFound:
            found.packages.setdefault(name, None)
    found.packages |= {name: shorten_path(folder) for name, folder in packages.used.items()}


def _list_mesh_packages(robot: Robot) -> Iterator[str]:
    for _, shape in robot.shapes:
        if isinstance(shape.geometry, Mesh):
            match = _PACKAGE.match(shape.geometry.filename)
            if match is not None:
                yield match[1]


def _add_controllers(found: ExplainedTargets, robot: Robot, description: Description) -> None:
    if robot.format != "urdf":
        return
    known = {use.path for use in found.controllers}
    for use in Package(robot, description).controller_files:
        why = "a plugin of the robot names it" if use.by_plugin else ""
        why = why or ("a launch file names it and the robot" if use.by_launch else "in the package")
        types = {one.name: one.type.text or "" for one in use.controllers}
        if use.file.path not in known:
            found.controllers.append(ControllerUse(use.file.path, why, types))
