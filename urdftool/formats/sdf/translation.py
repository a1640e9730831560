"""What every part of an export looks at: the robot, the decisions, and where losses go."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...finding import Severity
from ...model.elements import Joint, Link, Part, Robot
from ...source.document import Element
from ..actuator_config import JointSettings
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

    def lose(
        self,
        what: str,
        message: str,
        at: Part | Element,
        about: Link | Joint | None = None,
        *,
        severity: Severity = Severity.WARNING,
        hint: str = "",
    ) -> None:
        """Say what could not be carried, and of which link or joint."""
        kind = "" if about is None else "link" if isinstance(about, Link) else "joint"
        name = "" if about is None else about.name
        self.written.lose(
            what, message, at.place, kind=kind, name=name, severity=severity, hint=hint
        )

    def note(
        self, what: str, message: str, at: Part | Element, about: Link | Joint | None = None
    ) -> None:
        """Say what is different, where the robot behaves the same."""
        self.lose(what, message, at, about, severity=Severity.INFO)
