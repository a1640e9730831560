"""Comparison of a stage with the robot that it was exported from.

The stage is read by ``read.py``, and by Newton where it is installed. Kinematics and sums are those
of ``mechanics/reference.py``. Only a loss that the export reported excuses a difference.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt
from pxr import Usd, UsdPhysics

from ...compare.check import Check
from ...extras import is_installed
from ...mechanics.reference import Mechanics
from ...model.elements import Joint, Robot
from ...model.kinematics import get_limits
from ...model.world import add_world
from ...source.document import read_file
from ..common.actuator_config import JointSettings, read_actuator_config
from ..common.directory import write_export
from ..common.losses import DeclaredLosses
from ..written import Written
from .options import Options
from .read import read
from .verify_home import compare_home
from .verify_pair import (
    CONFIGURATIONS,
    FLOAT,
    INERTIA_LOSSES,
    MASS_LOSSES,
    TREE_LOSSES,
    Pair,
    compare_poses,
    get_effort,
    get_gains,
    get_inertial,
    get_resistance,
    is_below_changed_joint,
    resolve_mimic,
)
from .verify_shapes import compare_shapes

Array = npt.NDArray[np.float64]


def verify_copy(
    robot: Robot, options: Options, written: Written, *, newton: bool | None = None
) -> list[Check]:
    """Write a copy of an export, read it, and compare it with its source.

    Args:
        robot: The source.
        options: Options of the export.
        written: The export.
        newton: Whether to import the copy with Newton; None if it is installed.
    """
    robot, _ = add_world(robot)
    with TemporaryDirectory(prefix="urdftool-") as folder:
        place = Path(folder) / "copy"
        write_export(place, written, single=False)
        path = place / written.main
        reading = read(path, file=read_file(path), mesh_folder=Path(folder) / "meshes")
        losses = DeclaredLosses.from_findings(written.losses)
        positions = list(_make_configurations(robot))
        settings = _read_settings(robot, options)
        assert written.planned is not None
        home = written.planned.configurations[0].positions
        robot = replace(
            robot,
            joint_actuators=written.planned.joint_actuators,
            exclusions=written.planned.exclusions,
        )
        pair = Pair(robot, reading.robot, losses, positions, _find_bodies(path), settings)
        checks = [*compare(pair, options), compare_home(path, robot, home)]
        if is_installed("newton") if newton is None else newton:
            from .verify_newton import compare_newton

            checks += compare_newton(pair, path)
    return checks


def compare(pair: Pair, options: Options) -> list[Check]:
    """Compare a robot with what our reader has of its stage."""
    return [
        _compare_tree(pair),
        *compare_masses(pair),
        _compare_frames(pair),
        *_compare_joints(pair),
        *compare_shapes(pair),
        _compare_pairs(pair, options),
    ]


def _make_configurations(robot: Robot) -> Iterator[dict[str, float]]:
    """Yield zero, and random positions within the limits, the same in each run."""
    chance = random.Random(27)
    movable = Mechanics(robot).joints
    yield dict.fromkeys((joint.name for joint in movable), 0.0)
    for _ in range(CONFIGURATIONS):
        yield {joint.name: chance.uniform(*_get_range(joint)) for joint in movable}


def _get_range(joint: Joint) -> tuple[float, float]:
    lower, upper = get_limits(joint)
    lower, upper = max(lower, -3.0), min(upper, 3.0)
    return (lower, upper) if lower <= upper else (0.0, 0.0)


def _compare_tree(pair: Pair) -> Check:
    check = Check("tree", "links, joints, their types, parents and children", 0.0)
    made = pair.made
    for link in pair.source.links:
        check.compare(float(link.name not in made.link), f"link '{link.name}'")
    for joint in pair.source.joints:
        other = made.joint.get(joint.name)
        same = other is not None and (joint.parent, joint.child) == (other.parent, other.child)
        if same and other is not None:
            same = _get_kind(joint) == _get_kind(other)
        known = pair.losses.has_for(TREE_LOSSES, joint.name)
        check.compare(float(not same), f"joint '{joint.name}'", known=known)
    for kind, names, others in (
        ("link", made.link, pair.source.link),
        ("joint", made.joint, pair.source.joint),
    ):
        for name in names:
            known = pair.losses.has_for(TREE_LOSSES, name)
            check.compare(float(name not in others), f"{kind} '{name}' is new", known=known)
    return check


def _get_kind(joint: Joint) -> str:
    """Return the type of a joint; a continuous joint is a revolute joint without limits."""
    lower, upper = get_limits(joint)
    if joint.type == "revolute" and not (np.isfinite(lower) or np.isfinite(upper)):
        return "continuous"
    return "ball" if joint.type == "spherical" else joint.type


def compare_masses(pair: Pair) -> list[Check]:
    """Compare mass, center of mass and inertia of each link."""
    mass = Check("mass", "mass of each link, relative", FLOAT)
    center = Check("center of mass", "of each link [m]", FLOAT)
    inertia = Check("inertia", "tensor of each link, relative to its largest entry", FLOAT)
    for link, other in pair.links:
        here, there = get_inertial(link), get_inertial(other)
        known = pair.losses.has_for(MASS_LOSSES, link.name)
        name = f"link '{link.name}'"
        mass.compare(_compute_relative(here[0], there[0]), name, known=known)
        if not here[0] and not known:
            continue
        size = max(1.0, float(np.abs(here[1]).max()))
        center.compare(float(np.abs(here[1] - there[1]).max()) / size, name, known=known)
        known = pair.losses.has_for(INERTIA_LOSSES, link.name)
        scale = float(np.abs(here[2]).max()) or float(np.abs(there[2]).max()) or 1.0
        inertia.compare(float(np.abs(here[2] - there[2]).max()) / scale, name, known=known)
    return [mass, center, inertia]


def _compute_relative(one: float, other: float) -> float:
    size = max(abs(one), abs(other))
    return abs(one - other) / size if size else 0.0


def _compare_frames(pair: Pair) -> Check:
    check = Check(
        "frames", f"poses of links in the first, at {CONFIGURATIONS + 1} configurations", 1e-5
    )
    here, there = Mechanics(pair.source), Mechanics(pair.made)
    for positions in pair.configurations:
        ours, theirs = here.compute_frames(positions), there.compute_frames(positions)
        for name, difference in compare_poses(ours, theirs):
            check.compare(difference, f"link '{name}'", known=is_below_changed_joint(pair, name))
    return check


def _read_settings(robot: Robot, options: Options) -> dict[str, JointSettings]:
    """Read what the actuator file sets of each joint."""
    names = [joint.name for joint in robot.joints if _has_position(joint)]
    if options.actuator_config is None:
        return dict.fromkeys(names, JointSettings())
    return read_actuator_config(options.actuator_config).match_joints(names)


def _compare_joints(pair: Pair) -> list[Check]:
    rows = [
        Check("limits", "lower and upper limit of each joint [rad, m]", FLOAT),
        Check("effort", "effort limit of each joint, relative", FLOAT),
        Check("velocity", "velocity limit of each joint, relative", FLOAT),
        Check("friction, damping", "of each joint, and armature, relative", FLOAT),
        Check("drives", "stiffness and damping of the drive of each joint, relative", FLOAT),
        Check("mimic", "leader, factor and offset", FLOAT),
    ]
    codes = {"velocity": ("lossy-velocity",), "mimic": ("lossy-mimic",)}
    for joint, other in pair.joints:
        if not _has_position(joint) or pair.losses.has_for(("lossy-joint-type",), joint.name):
            continue
        ours = _list_values(pair.source, joint, pair.settings[joint.name])
        theirs = _list_values(pair.made, other, JointSettings())
        for check in rows:
            known = pair.losses.has_for(codes.get(check.name, ()), joint.name)
            for one, two in zip(ours[check.name], theirs[check.name], strict=True):
                check.compare(_compute_distance(one, two), f"joint '{joint.name}'", known=known)
    return rows


def _list_values(
    robot: Robot, joint: Joint, settings: JointSettings
) -> dict[str, tuple[float | str, ...]]:
    """Return the values of a joint by the name of their row."""
    velocity = joint.limit.velocity if joint.limit is not None else None
    return {
        "limits": get_limits(joint),
        "effort": (get_effort(joint, settings),),
        "velocity": (np.inf if velocity is None else abs(velocity),),
        "friction, damping": get_resistance(joint, settings),
        "drives": get_gains(robot, joint, settings),
        "mimic": resolve_mimic(joint, robot),
    }


def _compute_distance(one: float | str, other: float | str) -> float:
    if isinstance(one, str) or isinstance(other, str):
        return float(one != other)
    if one == other:
        return 0.0
    return abs(one - other) / max(1.0, abs(one))


def _has_position(joint: Joint) -> bool:
    return joint.type in ("revolute", "continuous", "prismatic")


def _compare_pairs(pair: Pair, options: Options) -> Check:
    check = Check("contact pairs", "pairs of links without contact", 0.0)
    wanted = {frozenset((p.link, p.other)) for p in pair.source.exclusions}
    if options.srdf is not None:
        from ..common.srdf import read_srdf

        wanted |= {frozenset(p) for p in
                   read_srdf(options.srdf, pair.source, Written(""), None).disabled}  # fmt: skip
    ours = {frozenset(pair.body.get(name, name) for name in names) for names in wanted}
    theirs = {frozenset((p.link, p.other)) for p in pair.made.exclusions}
    for names in ours ^ theirs:
        if len(names) > 1:
            check.compare(1.0, " – ".join(sorted(names)))
    return check


def _find_bodies(path: Path) -> dict[str, str]:
    """Return the link whose body is the prim of each link or above it, by name."""
    found = {}
    stage = Usd.Stage.Open(str(path))
    for prim in stage.Traverse():
        name = prim.GetCustomDataByKey("urdf:link")
        body = prim
        while name and body and not body.HasAPI(UsdPhysics.RigidBodyAPI):
            body = body.GetParent()
        if name:
            found[str(name)] = str(body.GetCustomDataByKey("urdf:link")) if body else ""
    return found
