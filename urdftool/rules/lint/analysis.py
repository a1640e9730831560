"""What could not be looked at."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ..mesh.files import what_is_wrong
from ..mesh.outlines import outline_of
from ..mesh.uses import mesh_uses
from ..rule import INFO, Problem, rule

_READ = (".stl", ".obj", ".dae", ".ply", ".gltf", ".glb")


@rule(INFO)
def analysis_incomplete(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh is there and could not be read, so its link was not looked at in full.

    A clean run must not mean that nothing was looked at. The size of a mesh tells whether mass,
    inertia, scale and collision of its link are plausible, and whether links overlap; without it
    these rules are silent. Meshes that are not there, or corrupt, have findings of their own. One
    finding names the links.
    """
    found = {}
    for use in mesh_uses(robot, description):
        if not use.exists or use.path is None or use.uri in found:
            continue
        if not (use.collides or use.link.inertial is not None):
            continue
        if what_is_wrong(use.path):
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
