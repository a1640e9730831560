"""Shared state of an export: the robot, the decisions, and the record of losses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from ...diagnostic import Severity
from ...model.elements import Joint, Link, Part, Robot
from ...model.mechanism import NativeElement
from ...source.document import Element
from ...source.location import Place
from ..common.actuator_config import JointSettings
from ..written import Written
from .mesh_files import MeshFiles
from .names import Names
from .options import Options
from .plan import Plan


@dataclass(frozen=True)
class Translation:
    """One export of one robot."""

    robot: Robot
    options: Options
    plan: Plan
    names: Names
    meshes: MeshFiles
    written: Written
    settings: Mapping[str, JointSettings] = field(default_factory=dict)

    @cached_property
    def rest(self) -> dict[tuple[str, Place], list[NativeElement]]:
        """Return what shapes and joints of an SDF have in addition, by section and place."""
        found: dict[tuple[str, Place], list[NativeElement]] = {}
        for element in self.robot.native if self.robot.format == "sdf" else ():
            found.setdefault((element.section, element.place), []).append(element)
        return found

    def report_loss(
        self,
        what: str,
        message: str,
        at: Part | Element,
        about: Link | Joint | None = None,
        *,
        severity: Severity = Severity.WARNING,
        hint: str = "",
        data: Mapping[str, object] | None = None,
    ) -> None:
        """Report robot data that SDF does not carry, with its link or joint."""
        kind = "" if about is None else "link" if isinstance(about, Link) else "joint"
        name = "" if about is None else about.name
        self.written.report_loss(
            what, message, at.place, kind=kind, name=name, severity=severity, hint=hint, data=data
        )

    def report_note(
        self, what: str, message: str, at: Part | Element, about: Link | Joint | None = None
    ) -> None:
        """Report a change that does not affect the robot's behavior."""
        self.report_loss(what, message, at, about, severity=Severity.INFO)
