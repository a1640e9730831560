"""Report checks that were not done in full."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.attached import MAX_PAIRS, TooManyAttached
from ...model.elements import Robot
from ...source.description import Description
from ..collision import overlap
from ..mesh.link_extents import get_convex_points
from ..mesh.mesh_uses import get_mesh_uses
from ..rule import INFO, Problem, rule
from ..words import join_some

APPLIES_TO = ("mesh", "collision", "joint")

_READ = (".stl", ".obj", ".dae", ".ply", ".gltf", ".glb")


@rule(INFO, infos=True)
def analysis_incomplete(robot: Robot, description: Description) -> Iterator[Problem]:
    """A check was not done in full: a mesh is unreadable, or the robot has too many links.

    A run without findings must not hide skipped checks. The size of a mesh decides whether mass,
    inertia, scale and collision of its link are plausible, and whether links overlap; without it
    these rules report nothing. Missing and corrupt meshes are reported by other rules. One finding
    names the links. In robots with so many links that the checks would take minutes, other
    findings count the pairs that ``self-collision-at-zero`` and the joints that
    ``self-collision-in-range`` skipped, and name the rules that stopped at a rigid body.
    """
    found = {}
    for use in get_mesh_uses(robot, description):
        if not use.exists or use.path is None or use.uri in found:
            continue
        if not (use.collides or use.link.inertial is not None):
            continue
        from ..mesh.files import describe_defect

        if describe_defect(use):
            continue
        if use.path.suffix.lower() not in _READ or get_convex_points(use) is None:
            found[use.uri] = use
    if found:
        first, *rest = found.values()
        more = f", nor those of {', '.join(repr(use.link.name) for use in rest)}" if rest else ""
        yield Problem(
            first.link,
            f"mesh '{first.uri}' of link '{first.link.name}' could not be read{more}; mass, "
            "inertia, scale and overlaps of the link were not checked",
            at=first.mesh.locate_attribute("filename"),
        )
    if overlap.is_partly_checked(robot):
        yield Problem(
            robot,
            "overlaps with all joints at rest were checked for the first "
            f"{overlap.RESTING} pairs of links only; more are near each other",
        )
    stopped = robot.memo.peek(TooManyAttached)
    if stopped:
        names = join_some([f"'{name}'" for name in stopped], "rules")
        yield Problem(
            robot,
            f"rules {names} did not check all links, because fixed joints connect more than "
            f"{MAX_PAIRS} pairs of links; merge links",
        )
    joints = overlap.get_skipped_joints(robot)
    if joints:
        yield Problem(
            joints[0],
            f"self-collision in motion was not checked from joint '{joints[0].name}' on, for "
            f"{len(joints)} of {len(robot.moving_joints)} joints, because the robot has too many "
            "links",
        )
