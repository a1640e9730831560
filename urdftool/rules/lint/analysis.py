"""What could not be looked at."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ..collision import overlap
from ..mesh.outlines import outline_of
from ..mesh.uses import mesh_uses
from ..rule import INFO, Problem, rule

APPLIES_TO = ("mesh", "collision")

_READ = (".stl", ".obj", ".dae", ".ply", ".gltf", ".glb")


@rule(INFO)
def analysis_incomplete(robot: Robot, description: Description) -> Iterator[Problem]:
    """Something was not looked at in full: a mesh that cannot be read, or too many links.

    A clean run must not mean that nothing was looked at. The size of a mesh tells whether mass,
    inertia, scale and collision of its link are plausible, and whether links overlap; without it
    these rules are silent. Meshes that are not there, or corrupt, have findings of their own. One
    finding names the links. Others say that pairs of links were passed over by
    ``self-collision-at-zero``, and count the joints that ``self-collision-in-range`` passed over,
    in a robot of so many links that it would take minutes.
    """
    found = {}
    for use in mesh_uses(robot, description):
        if not use.exists or use.path is None or use.uri in found:
            continue
        if not (use.collides or use.link.inertial is not None):
            continue
        from ..mesh.files import what_is_wrong

        if what_is_wrong(use):
            continue
        if use.path.suffix.lower() not in _READ or outline_of(use) is None:
            found[use.uri] = use
    if found:
        first, *rest = found.values()
        more = f", nor those of {', '.join(repr(use.link.name) for use in rest)}" if rest else ""
        yield Problem(
            first.link,
            f"mesh '{first.uri}' of link '{first.link.name}' could not be read{more}; mass, "
            "inertia, scale and overlaps were not checked there",
            at=first.mesh.element.attribute_place("filename"),
        )
    if overlap.resting_in_part(robot):
        yield Problem(
            robot,
            "whether links overlap where all joints are at rest was looked at for the first "
            f"{overlap.RESTING} pairs only; more are near each other",
        )
    joints = overlap.passed_over(robot)
    if joints:
        yield Problem(
            joints[0],
            f"whether a joint runs one link into another was not looked at from '{joints[0].name}' "
            f"on, for {len(joints)} of {len(robot.moving_joints)} joints; the robot has too many "
            "links",
        )
