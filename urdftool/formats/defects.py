"""Refusal of robots that cannot be exported: one finding for each defect, with its place.

The rules of ``lint`` find the defects of a robot (``lint.validate``). A writer adds those that only
it can know: limits of its format, mesh files that it cannot convert, and bodies that are physically
inconsistent after links are lumped. Those in ``FATAL`` leave no robot to write; with ``--force`` an
export passes the others, and reports what it wrote instead.
"""

from __future__ import annotations

from ..finding import Finding
from ..lint.validate import validate
from ..model.elements import Robot
from ..model.world import add_world
from ..refusal import FATAL as FATAL
from ..refusal import Refused as Refused
from ..refusal import make_defect as make_defect
from ..refusal import refuse as refuse
from ..source.location import Place

MAX_LINKS = 4000
"""Number of links up to which the libraries of MuJoCo and OpenUSD take a model within 20 s and
1 GB. Chosen from measurements: OpenUSD takes 4 ms for a link, MuJoCo the memory of a matrix."""


def report_defects(robot: Robot) -> list[Finding]:
    """Find the defects of a robot's links, joints and numbers that every export refuses."""
    return validate(robot, "export")


def report_size(robot: Robot, name: str) -> list[Finding]:
    """Report a robot with more links than the library of a format takes."""
    count = len(robot.links)
    if count <= MAX_LINKS:
        return []
    text = f"the robot has {count} links, more than the limit of {MAX_LINKS} of {name}"
    return [make_defect("too-many-links", text, robot.place, "robot", robot.name or "")]


def report_taken_world(robot: Robot) -> tuple[Robot, list[Finding]]:
    """Return a robot with the world link that it names but does not declare; report the defects."""
    whole, joint = add_world(robot)
    if joint is None:
        return robot, []
    remain = set(map(get_identity, validate(whole, "join")))
    return whole, [f for f in validate(robot, "join") if get_identity(f) not in remain]


def get_identity(finding: Finding) -> tuple[str, Place, str]:
    """Get what two findings about one defect of a robot have in common."""
    return finding.code, finding.location, finding.name
