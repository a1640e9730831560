"""Pairs of bodies that never collide: filtered pairs and collision groups."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from pxr import Usd, UsdPhysics

from ...model.elements import Robot
from ...model.mechanism import ContactExclusion
from .read_stage import Context, get_targets


def add_pairs(context: Context, robot: Robot) -> None:
    """Add the pairs of bodies that never collide, each once."""
    known: set[frozenset[str]] = set()
    for first, second, prim in (*_read_filtered_pairs(context), *_read_groups(context)):
        names = frozenset((context.names[first], context.names[second]))
        if len(names) == 2 and names not in known:
            known.add(names)
            pair = ContactExclusion(
                context.get_written(prim), context.names[first], context.names[second]
            )
            robot.exclusions.append(pair)


def _read_filtered_pairs(context: Context) -> Iterator[tuple[str, str, Usd.Prim]]:
    """Yield pairs of bodies, and the prim that has the pair; a prim below a body counts for it."""
    for prim in context.iterate_prims():
        for other in get_targets(prim, "physics:filteredPairs"):
            first = context.find_body(prim)
            end = context.stage.GetPrimAtPath(other)
            ends = _list_bodies(context, end) if end else []
            for start, second in product([first] if first else _list_bodies(context, prim), ends):
                yield start, second, prim


def _list_bodies(context: Context, prim: Usd.Prim) -> list[str]:
    """Return the body that has a prim, or else those below it."""
    body = context.find_body(prim)
    below = f"{str(prim.GetPath()).rstrip('/')}/"
    return [body] if body else [path for path in context.bodies if path.startswith(below)]


def _read_groups(context: Context) -> Iterator[tuple[str, str, Usd.Prim]]:
    """Yield the pairs of bodies of which every two colliders are in groups that filter them."""
    prims = [p for p in context.stage.Traverse() if p.IsA(UsdPhysics.CollisionGroup)]
    if not prims:
        return
    groups = _find_groups(context, prims)
    filtered = {
        frozenset((str(prim.GetPath()), target))
        for prim in prims
        for target in get_targets(prim, "physics:filteredGroups")
    }
    if any(UsdPhysics.CollisionGroup(prim).GetInvertFilteredGroupsAttr().Get() for prim in prims):
        context.report_loss("collision-group", "inverted collision groups are not read", prims[0])
        return
    paths = list(groups)
    for index, first in enumerate(paths):
        for second in paths[index + 1 :]:
            pairs = [
                {frozenset((a, b)) for a in one for b in other}
                for one, other in product(groups[first], groups[second])
            ]
            count = sum(not pair.isdisjoint(filtered) for pair in pairs)
            if pairs and count == len(pairs):
                yield first, second, prims[0]
            elif count:
                text = "collision groups of some of the shapes of two bodies are not read"
                context.report_loss("collision-group", text, prims[0])


def _find_groups(context: Context, prims: list[Usd.Prim]) -> dict[str, list[set[str]]]:
    """Return the groups of each collider of each body that has colliders, by path."""
    members = {
        str(prim.GetPath()): UsdPhysics.CollisionGroup(prim)
        .GetCollidersCollectionAPI()
        .ComputeMembershipQuery()
        for prim in prims
    }
    found: dict[str, list[set[str]]] = {}
    for prim in context.iterate_prims():
        if prim.HasAPI(UsdPhysics.CollisionAPI) and (body := context.find_body(prim)):
            at = prim.GetPath()
            named = {path for path, query in members.items() if query.IsPathIncluded(at)}
            found.setdefault(body, []).append(named)
    return found
