"""Mass properties of rigidly attached links, and of the whole robot at a pose.

Links joined by fixed joints are one rigid body, whose mass properties are in the frame of its
topmost link. Those of the whole robot are in the frame of its root link.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..diagnostic import Diagnostic, Severity
from ..lint.validate import validate
from ..mechanics.spatial_inertia import SpatialInertia
from ..model.elements import Link, Robot
from ..model.kinematics import (
    add_mimic_positions,
    check_positions,
    explain_beyond_limits,
    get_limits,
    link_poses,
)
from .inertia_error import InertiaError
from .link_review import LinkReview
from .requirements import combine


@dataclass(frozen=True, eq=False)
class Lump:
    """Links that are one rigid body.

    Attributes:
        link: The topmost link.
        members: All links, in the order of the tree.
        properties: Mass properties in the frame of ``link``; None if no member has a known mass.
    """

    link: str
    members: tuple[str, ...]
    properties: SpatialInertia | None


@dataclass(frozen=True, eq=False)
class Lumped:
    """Rigid bodies of a robot, and the whole robot at a pose.

    Attributes:
        lumps: Rigid bodies, in the order of the tree.
        root: The root link, in whose frame the whole is given.
        whole: Mass properties of the robot; None if no link has a known mass.
        positions: Position of each movable joint [rad or m].
        notes: Remarks on skipped links and positions outside limits.
    """

    lumps: tuple[Lump, ...]
    root: str
    whole: SpatialInertia | None
    positions: dict[str, float]
    notes: tuple[Diagnostic, ...] = field(default=())


def lump(robot: Robot, found: Sequence[LinkReview], pose: Mapping[str, float]) -> Lumped:
    """Compute the mass properties of each rigid body, and of the robot at a pose.

    A link without written inertia counts with the implied one; joints without a position [rad or m]
    are at 0.

    Raises:
        InertiaError: The robot does not have exactly one root link, or the pose contains an unknown
            or immovable joint.
    """
    for finding in validate(robot, "inertia:lump"):
        raise InertiaError(finding.message, at=finding.location)
    root = robot.tree.roots[0].name
    check_positions(robot, pose)
    positions = add_mimic_positions(robot, pose)
    notes = _list_beyond_limits(robot, positions)
    weights: dict[str, SpatialInertia] = {}
    for item in found:
        if item.written is not None and item.written.mass > 0:
            weights.setdefault(item.link.name, item.written)
        elif item.implied is not None:
            weights.setdefault(item.link.name, item.implied)
            message = f"link '{item.link.name}' counts with the mass properties of its geometry"
            notes.append(_make_note("implied-inertia", message, item.link))
        elif item.body is not None or item.link.inertial is not None:
            if item.written is None or item.written.mass < 0:
                message = f"link '{item.link.name}' is left out: its mass is unknown"
                notes.append(_make_note("unknown-mass", message, item.link))
        is_counted = item.written is not None and weights.get(item.link.name) is item.written
        if item.status == "wrong" and is_counted:
            message = f"link '{item.link.name}' counts as written, which is physically inconsistent"
            notes.append(_make_note("inconsistent-inertia", message, item.link))
    poses = link_poses(robot, positions)
    lumps = []
    for top, members in robot.tree.body_links.items():
        if top not in poses:
            continue
        to_top = poses[top].invert()
        bodies = [
            weights[name].transform(to_top @ poses[name]) for name in members if name in weights
        ]
        properties = combine(bodies) if bodies else None
        lumps.append(Lump(top, tuple(members), properties))
    all_bodies = [body.transform(poses[name]) for name, body in weights.items() if name in poses]
    whole = combine(all_bodies) if all_bodies else None
    for link in robot.tree.detached:
        message = f"link '{link.name}' is not connected to the root and is left out"
        notes.append(_make_note("detached-link", message, link))
    return Lumped(tuple(lumps), root, whole, positions, tuple(notes))


def _make_note(code: str, message: str, link: Link) -> Diagnostic:
    return Diagnostic(code, Severity.INFO, message, link.place, data={"link": link.name})


def _list_beyond_limits(robot: Robot, positions: Mapping[str, float]) -> list[Diagnostic]:
    notes = []
    for name, message in explain_beyond_limits(robot, positions).items():
        low, high = get_limits(robot.joint[name])
        data = {"joint": name, "position": positions[name], "lower": low, "upper": high}
        place = robot.joint[name].place
        notes.append(Diagnostic("beyond-limits", Severity.INFO, message, place, data=data))
    return notes
