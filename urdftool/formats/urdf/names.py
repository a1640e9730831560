"""Names of links and joints in an export to URDF."""

from __future__ import annotations

from ...diagnostic import Severity
from ...model.elements import Robot
from ..common.naming import UniqueNames
from ..written import Written


class Names:
    """Names in the export by the names in the source."""

    def __init__(self, robot: Robot, written: Written) -> None:
        """Choose names: ``::`` of nested models becomes ``_``; each is unique."""
        self.taken_links, self.taken_joints = UniqueNames(), UniqueNames()
        self.links = {
            link.name: self.taken_links.take(_replace_separators(link.name)) for link in robot.links
        }
        self.joints = {
            joint.name: self.taken_joints.take(_replace_separators(joint.name))
            for joint in robot.joints
        }
        for kind, names, parts in (
            ("link", self.links, robot.link),
            ("joint", self.joints, robot.joint),
        ):
            for old, new in names.items():
                if old != new:
                    written.renamed[kind, old] = new
                    text = f"{kind} '{old}' is '{new}' in URDF"
                    place = parts[old].place
                    written.report_loss(
                        "name", text, place, kind=kind, name=old, severity=Severity.INFO
                    )


def _replace_separators(name: str) -> str:
    return name.replace("::", "_").replace("~", "_")
