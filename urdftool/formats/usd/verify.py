"""Comparison of a stage with the robot that it was exported from.

The stage is read by ``read.py`` and compared with the source, which has the choices of the export
(``planned.py``) where the description says nothing, and stepped in MuJoCo; in addition, Newton
imports the stage where it is installed. Only a loss that the export reported excuses a difference.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from ...compare.check import Check
from ...compare.proof import Claims, prove
from ...compare.rows import NATIVE, ROWS, Row
from ...extras import is_installed
from ...model.elements import Joint, Robot
from ...model.load import read_again
from ...model.materials import resolve_materials
from ...model.world import add_world
from ...source.document import read_file
from ..common.additions import announce_additions
from ..common.directory import write_export
from ..common.losses import DeclaredLosses, name_links
from ..step_read_back import check_read_back
from ..written import Written
from .declared_losses import EXCUSES, UNSEEN
from .read import read
from .verify_home import compare_home, read_start

_SINGLE = 1e-6
"""Tolerance of most rows: a stage has 32-bit floats."""

_NOT_READ = ("world", "looks", "sensors", "configurations", "plugins", "simulator data", NATIVE)
"""Rows of what a stage does not have, or its reader does not read."""

_KINDS = {"ball": "connect", "fixed": "weld"}
"""Names that the reader uses for the connections of SDF that are the same joint in USD."""

_PLACES = ("frames", "axes", "collisions", "visuals", "colors", "mass matrix", "gravity")
"""Rows in which the rounding of several floats adds up; they keep their tolerance."""


def verify_copy(
    robot: Robot, written: Written, *, timestep: float | None = None, newton: bool | None = None
) -> list[Check]:
    """Write a copy of an export, read it, and compare it with its source."""
    assert written.planned is not None
    source = add_world(read_again(robot))[0]
    expected = make_expected(source, written.planned)
    with TemporaryDirectory(prefix="urdftool-") as folder:
        place = Path(folder) / "copy"
        write_export(place, written, single=False)
        path = place / written.main
        reading = read(path, file=read_file(path), mesh_folder=Path(folder) / "meshes")
        losses = list(name_links(expected, written.losses))
        claims = Claims(losses, written.renamed, EXCUSES, reading.losses, UNSEEN)
        checks = prove(expected, reading.robot, claims, rows=choose_rows())
        announce_additions(checks, source, written.planned)
        checks.append(compare_home(path, expected, written.planned.configurations[0].positions))
        checks.append(check_read_back(reading.robot, read_start(path), timestep, losses))
        if is_installed("newton") if newton is None else newton:
            from .verify_newton import compare_newton

            checks += compare_newton(expected, DeclaredLosses.from_findings(losses), path)
    return checks


def make_expected(source: Robot, planned: Robot) -> Robot:
    """Return the robot that the stage must hold: the source with the choices of the export."""
    source = resolve_materials(source)
    return replace(
        source,
        format="usd",
        base=planned.base,
        joints=[_set_choices(joint, planned.joint[joint.name]) for joint in source.joints],
        joint_actuators=planned.joint_actuators,
        exclusions=planned.exclusions,
        closures=[replace(c, type=_KINDS.get(c.type, c.type)) for c in source.closures],
        gazebo=[],
        transmissions=[],
        ros2_controls=[],
    )


def _set_choices(joint: Joint, planned: Joint) -> Joint:
    return replace(joint, dynamics=planned.dynamics, limit=planned.limit)


def choose_rows() -> tuple[Row, ...]:
    """Return the compared properties with the tolerances of 32-bit floats."""
    return tuple(
        row if row.name in _PLACES else row._replace(tolerance=min(row.tolerance, _SINGLE))
        for row in ROWS
        if row.name not in _NOT_READ
    )
