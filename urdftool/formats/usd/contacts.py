"""Collisions among the links of a robot: whether, and between which pairs not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pxr import UsdPhysics

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mechanism import ContactExclusion
from ...model.settings import is_set
from ..written import Written
from .links import LinkWriter
from .options import Options
from .stage import PHYSICS, PHYSX, apply, set_value

SELF_COLLISION = "newton:selfCollisionEnabled"
"""Attribute of an articulation: whether its links collide with each other."""


def write_self_collision(links: LinkWriter, options: Options, written: Written) -> None:
    """Write the root of the articulation, and whether its links collide with each other."""
    builder, bodies = links.builder, links.bodies
    prim = builder.prim
    if bodies.free and bodies.base:
        prim = builder.stage.GetPrimAtPath(links.get_path(bodies.base))
    collides = is_self_colliding(bodies.robot, options)
    if options.self_collision is None:
        if not collides:
            written.report_loss(
                "self-collision",
                "links of the robot do not collide with each other, since no SRDF names the pairs "
                "that may; --self-collision lets them",
                bodies.robot.place,
                severity=Severity.INFO,
            )
    with builder.edit_layer(PHYSICS):
        UsdPhysics.ArticulationRootAPI.Apply(prim)
        apply(prim, "NewtonArticulationRootAPI")
        set_value(prim, SELF_COLLISION, "bool", collides)
    if options.has_physx:
        with builder.edit_layer(PHYSX):
            apply(prim, "PhysxArticulationAPI")
            set_value(prim, "physxArticulation:enabledSelfCollisions", "bool", collides)


def is_self_colliding(robot: Robot, options: Options) -> bool:
    """Tell whether links of the robot collide with each other in the stage."""
    if options.self_collision is not None:
        return options.self_collision
    levels = (robot.settings, *(link.settings for link in robot.links))
    has_self_collision = any(is_set(settings, "self_collide") for settings in levels)
    return options.srdf is not None or bool(robot.exclusions) or has_self_collision


def list_overlaps(
    robot: Robot, options: Options, positions: Mapping[str, float], written: Written
) -> list[ContactExclusion]:
    """List the pairs of links that overlap at home, which simulators would push apart."""
    if options.overlaps is None or not is_self_colliding(robot, options):
        return []
    finding = options.overlaps(robot, positions)
    if finding is None:
        return []
    written.losses.append(finding)
    return [ContactExclusion(None, one, other) for one, other in finding.data.get("pairs", ())]


def write_pairs(
    links: LinkWriter, pairs: Iterable[ContactExclusion], proofs: Mapping[frozenset[str], str]
) -> None:
    """Write pairs of bodies that never collide, each at the first of its names."""
    found: dict[str, set[str]] = {}
    for pair in pairs:
        found.setdefault(pair.link, set()).add(pair.other)
    texts = _list_proofs(links.bodies.carrier, found, proofs)
    with links.builder.edit_layer(PHYSICS):
        for first, others in found.items():
            prim = links.builder.stage.GetPrimAtPath(links.get_path(first))
            filtered = UsdPhysics.FilteredPairsAPI.Apply(prim)
            paths = [links.get_path(name) for name in sorted(others)]
            filtered.CreateFilteredPairsRel().SetTargets(paths)
            if first in texts:
                prim.SetCustomDataByKey("urdf:filteredPairs", "; ".join(texts[first]))


def _list_proofs(
    carrier: Mapping[str, str],
    pairs: Mapping[str, set[str]],
    proofs: Mapping[frozenset[str], str],
) -> dict[str, list[str]]:
    """Return the proofs of the pairs of each body, by its name."""
    texts: dict[str, list[str]] = {}
    for names, proof in proofs.items():
        one, other = sorted(names)
        first, second = sorted((carrier.get(one, ""), carrier.get(other, "")))
        if second in pairs.get(first, ()):
            texts.setdefault(first, []).append(f"{one}, {other}: {proof}")
    return texts
