"""Properties of a robot in one table, and as JSON; the schema is ``docs/schemas/info.json``."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from typing import Any

from ..info.counts import Counts, Named
from ..info.size import Measured
from ..model.elements import Robot
from .counted import counted
from .findings import Painter, clean
from .json_text import json_text

_MOST = 6


def table(robot: Robot, counts: Counts, measured: Measured, *, colors: bool = False) -> str:
    """Format the properties, one line each."""
    paint = Painter(colors)
    rows = list(_rows(robot, counts, measured))
    width = max(len(label) for label, _ in rows)
    lines = []
    before = ""
    for label, text in rows:
        shown = "" if label == before else label
        lines.append(f"{paint(f'{shown:<{width}}', 'cyan')}  {text}".rstrip())
        before = label
    return "".join(f"{line}\n" for line in lines)


def _rows(robot: Robot, counts: Counts, measured: Measured) -> Iterator[tuple[str, str]]:
    yield "robot", clean(robot.name) or "no name"
    bodies = counts.links - counts.frames
    frames = f": {bodies} with mass or shape, {counted(counts.frames, 'mere frame')}"
    yield "links", f"{counts.links}{frames if counts.frames else ''}"
    types = ", ".join(f"{n} {clean(kind) or 'without type'}" for kind, n in counts.joints.items())
    mimics = f"; {counted(counts.mimics, 'mimic')}" if counts.mimics else ""
    yield "joints", f"{sum(counts.joints.values())}" + (f": {types}{mimics}" if types else "")
    yield "degrees of freedom", str(counts.freedom)
    if len(counts.roots) == 1:
        yield "tree", f"from {clean(counts.roots[0])}, {counted(counts.depth, 'joint')} deep"
    else:
        roots = _listed(counts.roots)
        yield "tree", f"{counted(len(counts.roots), 'root')}{': ' * bool(roots)}{roots}"
    if robot.closures:
        yield "closed loops", _listed([closure.name or "no name" for closure in robot.closures])
    if robot.joint_actuators:
        yield "actuators", _listed([one.name or one.joint for one in robot.joint_actuators])
    without = f"; {counted(counts.massless, 'link')} without" if counts.massless else ""
    yield "mass", f"{counts.mass:.6g} kg{without}"
    yield "size at zero pose", _size(counts, measured)
    yield "meshes", _meshes(measured)
    for mesh in measured.meshes:
        if mesh.reason:
            yield "meshes", f"not read: {clean(mesh.uri)}: {clean(mesh.reason)}"
    for name, folder in counts.packages.items():
        yield "packages", f"{clean(name)}  {'not found' if folder is None else _short(folder)}"
    yield from (("plugins", line) for line in _named(counts.plugins))
    yield from (("sensors", line) for line in _named(counts.sensors))
    yield from (("ros2_control", line) for line in _named(counts.hardware))
    if counts.transmissions:
        yield "transmissions", _listed(counts.transmissions)


def _size(counts: Counts, measured: Measured) -> str:
    if measured.bounds is None:
        return "no shape that could be read"
    size = " × ".join(f"{round(length, 6):.4g}" for length in measured.bounds.size)
    missing = sum(bool(mesh.reason) for mesh in measured.meshes)
    lacks = f", without {counted(missing, 'mesh', 'meshes')}" if missing else ""
    lowest = f"; lowest point at z = {round(measured.bounds.low[2], 6) + 0.0:.4g} m"
    return f"{size} m along the root's x, y, z{lowest}{lacks}"


def _meshes(measured: Measured) -> str:
    if not measured.meshes:
        return "none"
    files = counted(len(measured.meshes), "file")
    shown, touched = measured.triangles("visuals"), measured.triangles("collisions")
    return f"{files}; {shown:,} triangles in visuals, {touched:,} in collisions"


def _named(things: Iterable[Named]) -> Iterator[str]:
    for thing in things:
        on = f" on {clean(thing.on)}" if thing.on is not None else ""
        what = f" ({clean(thing.what)})" if thing.what else ""
        yield f"{clean(thing.name) or 'no name'}{what}{on}"


def _listed(names: list[str]) -> str:
    more = len(names) - _MOST
    shown = [clean(name) for name in names[:_MOST]]
    return ", ".join([*shown, f"{more} more"] if more > 0 else shown)


def _short(folder: str) -> str:
    relative = os.path.relpath(folder)
    return clean(folder if relative.startswith("..") else relative)


def to_json(robot: Robot, counts: Counts, measured: Measured) -> str:
    """Format the properties and each mesh as one object; lengths [m], masses [kg]."""
    bounds = measured.bounds
    said: dict[str, Any] = {"version": 1, "name": robot.name}
    said["path"] = robot.source.path if robot.source is not None else None
    said |= asdict(counts)
    for kind in ("plugins", "sensors", "hardware"):
        said[kind] = [
            {"name": named.name, "type": named.what, "on": named.on}
            for named in getattr(counts, kind)
        ]
    said["size"] = None if bounds is None else list(bounds.size)
    said["bounds"] = None if bounds is None else {"low": bounds.low, "high": bounds.high}
    said["meshes"] = [{**asdict(mesh), "reason": mesh.reason or None} for mesh in measured.meshes]
    said["triangles"] = {kind: measured.triangles(kind) for kind in ("visuals", "collisions")}
    return json_text(said, 1) + "\n"
