"""Choice of the bodies of a stage that are the robot."""

from __future__ import annotations

from collections.abc import Iterable

from pxr import Usd, UsdPhysics

from ...diagnostic import Severity
from ..reading import find_chosen
from .read_stage import Context

Ends = tuple[str, str, bool]
"""Paths of the bodies of a joint, empty for the world, and whether it is a fixed joint."""


def choose_bodies(context: Context, joints: Iterable[Ends]) -> None:
    """Keep the bodies of one robot in the context, and report the others.

    The robot is the articulation with most bodies. Without an articulation, it is the most bodies
    that joints connect. All bodies are kept if there is no joint, or if this tool wrote the
    stage.

    Raises:
        ModelError: No articulation, or several, have the name that the user chose.
    """
    joints = list(joints)
    groups = _connect(context, joints)
    if (len(groups) < 2 or context.is_ours) and not context.chosen:
        return
    robots = _find_robots(context, groups)
    if not robots:
        return
    paths = [str(prim.GetPath()) for prim, _ in robots]
    chosen = max((bodies for _, bodies in robots), key=len)
    if context.chosen:
        place = context.get_place(context.top)
        chosen = robots[find_chosen(context.chosen, paths, "articulation", place)][1]
    held = {second for first, second, is_fixed in joints if is_fixed and not first}
    if not held.isdisjoint(chosen):  # converters fix links of a root without mass to the world
        chosen = chosen.union(*(group for group in groups if len(group) == 1 and group <= held))
    others = [(prim, bodies) for prim, bodies in robots if bodies.isdisjoint(chosen)]
    for prim, _ in others:
        text = f"of {len(others) + 1} articulations, one is read; -r NAME chooses another"
        path, place = str(prim.GetPath()), context.get_place(prim)
        context.losses.add("articulation", text, path, place)
    for path, prim in context.bodies.items():
        if path not in chosen and not any(path in bodies for _, bodies in others):
            text = "bodies that no joint connects to the robot are not read"
            context.report_loss("body", text, prim, Severity.INFO)
    context.others = {str(prim.GetPath()): prim for prim, _ in others}
    context.others |= {path: prim for path, prim in context.bodies.items() if path not in chosen}
    context.bodies = {path: prim for path, prim in context.bodies.items() if path in chosen}


def _find_robots(context: Context, groups: list[set[str]]) -> list[tuple[Usd.Prim, set[str]]]:
    """Return the root and bodies of each articulation; without one, of each group with joints."""
    found: list[tuple[Usd.Prim, set[str]]] = []
    for prim in context.iterate_prims():
        if prim.HasAPI(UsdPhysics.ArticulationRootAPI):
            bodies = _find_bodies(context, prim, groups)
            if bodies and bodies not in [known for _, known in found]:
                found.append((prim, bodies))
    if found:
        return found
    return [
        (next(prim for path, prim in context.bodies.items() if path in group), group)
        for group in groups
        if len(group) > 1
    ]


def _connect(context: Context, joints: Iterable[Ends]) -> list[set[str]]:
    """Return the bodies that joints connect, other than through the world."""
    group = {path: {path} for path in context.bodies}
    for first, second, _ in joints:
        if first in group and second in group and group[first] is not group[second]:
            fewer, more = sorted((group[first], group[second]), key=len)
            more |= fewer
            group.update(dict.fromkeys(fewer, more))
    unique = {id(paths): paths for paths in group.values()}
    return list(unique.values())


def _find_bodies(context: Context, root: Usd.Prim, groups: list[set[str]]) -> set[str]:
    """Return the bodies of an articulation; its root is a body, a joint, or a prim above them."""
    path = str(root.GetPath())
    if path in context.bodies:
        return next(group for group in groups if path in group)
    if root.IsA(UsdPhysics.Joint):
        joint = UsdPhysics.Joint(root)
        ends = [*joint.GetBody0Rel().GetTargets(), *joint.GetBody1Rel().GetTargets()]
        named = {context.find_body(context.stage.GetPrimAtPath(end)) for end in ends}
    else:
        start = f"{path.rstrip('/')}/"
        named = {body for body in context.bodies if body.startswith(start)}
    return {body for group in groups if not group.isdisjoint(named) for body in group}
