"""Comparison of a stage with the robot that it was exported from.

The stage is read by ``read.py`` and compared with the source, which has the choices of the export
(``planned.py``) where the description says nothing, and stepped in MuJoCo; in addition, Newton
imports the stage where it is installed. Only a loss that the export reported excuses a difference.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from pxr import Usd, UsdPhysics

from ...compare.check import Check
from ...compare.proof import Claims, prove
from ...compare.rows import NATIVE, ROWS, Row
from ...extras import is_installed
from ...model.elements import Joint, Robot
from ...model.kinematics import get_limits
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
        rows, described = choose_rows(), None if source.format == "usd" else source
        checks = prove(expected, reading.robot, claims, rows=rows, described=described)
        announce_additions(checks, source, written.planned)
        checks.append(compare_home(path, expected, written.planned.configurations[0].positions))
        collides = read_self_collision(path)
        start = read_start(path)
        checks.append(
            check_read_back(reading.robot, start, timestep, losses, self_collides=collides)
        )
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


TOLERANCE = 1e-6
"""Tolerance of a position [rad or m], relative above 1: a 32-bit float."""


def compare_home(path: Path, robot: Robot, home: Mapping[str, float]) -> Check:
    """Compare positions and targets of joints with the home, and both with the limits."""
    check = Check("home", "positions and targets of servos at home, within limits [rad, m]", 1e-6)
    for name, prim in _list_joints(path):
        joint = robot.joint.get(name)
        if joint is None:
            continue
        expected = home.get(joint.name, 0.0)
        for text, value in _list_positions(prim).items():
            error = abs(value - expected) / max(1.0, abs(expected))
            check.compare(error, f"joint '{joint.name}': {text}")
        lower, upper = get_limits(joint)
        if lower <= upper and joint.mimic is None:
            check.compare(
                max(lower - expected, expected - upper, 0.0), f"joint '{joint.name}': limits"
            )
    return check


def read_start(path: Path) -> dict[str, float]:
    """Return the positions at which the joints of a stage start [rad or m], by name."""
    return {name: _list_positions(prim)["position"] for name, prim in _list_joints(path)}


def read_self_collision(path: Path) -> bool:
    """Tell whether the links of a stage's robot collide with each other."""
    stage = Usd.Stage.Open(str(path))
    name = "newton:selfCollisionEnabled"
    return any(prim.GetAttribute(name).Get() for prim in stage.Traverse())


def _list_joints(path: Path) -> Iterator[tuple[str, Usd.Prim]]:
    """Yield the joints with one degree of freedom, with their names in the source."""
    stage = Usd.Stage.Open(str(path))
    for prim in stage.Traverse():
        name = prim.GetCustomDataByKey("urdf:joint")
        is_single = prim.IsA(UsdPhysics.RevoluteJoint) or prim.IsA(UsdPhysics.PrismaticJoint)
        if name and is_single:
            yield str(name), prim


def _list_positions(prim: Usd.Prim) -> dict[str, float]:
    """Return the position of a joint and the target of its servo, if it has one [rad or m]."""
    kind, unit = "linear", 1.0
    if prim.IsA(UsdPhysics.RevoluteJoint):
        kind, unit = "angular", math.radians(1.0)
    names = {"position": f"state:{kind}:physics:position"}
    if prim.GetAttribute(f"drive:{kind}:physics:stiffness").Get():
        names["target"] = f"drive:{kind}:physics:targetPosition"
    return {text: unit * (prim.GetAttribute(n).Get() or 0.0) for text, n in names.items()}
