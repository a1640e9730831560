"""Properties of a robot in one table, and as JSON; the schema is ``docs/schemas/info.json``."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from typing import Any

from ..control_characters import escape_controls
from ..info.counts import Counts, Named
from ..info.size import Measured
from ..model.elements import Robot, UnknownShape
from .counted import format_count
from .findings import Painter
from .json_text import format_json

_MOST = 6  # names in one line; chosen


def format_table(robot: Robot, counts: Counts, measured: Measured, *, colors: bool = False) -> str:
    """Format the properties, one line each."""
    paint = Painter(colors)
    rows = list(_list_rows(robot, counts, measured))
    width = max(len(label) for label, _ in rows)
    lines = []
    before = ""
    for label, text in rows:
        shown = "" if label == before else label
        lines.append(f"{paint(f'{shown:<{width}}', 'cyan')}  {text}".rstrip())
        before = label
    return "".join(f"{line}\n" for line in lines)


def _list_rows(robot: Robot, counts: Counts, measured: Measured) -> Iterator[tuple[str, str]]:
    yield "robot", escape_controls(robot.name) or "no name"
    bodies = counts.links - counts.frames
    frames = f": {bodies} with mass or shape, {format_count(counts.frames, 'mere frame')}"
    yield "links", f"{counts.links}{frames if counts.frames else ''}"
    types = ", ".join(
        f"{n} {escape_controls(kind) or 'without type'}" for kind, n in counts.joints.items()
    )
    mimics = f"; {format_count(counts.mimics, 'mimic')}" if counts.mimics else ""
    yield "joints", f"{sum(counts.joints.values())}" + (f": {types}{mimics}" if types else "")
    yield "degrees of freedom", str(counts.freedom)
    if len(counts.roots) == 1:
        yield (
            "tree",
            f"from {escape_controls(counts.roots[0])}, {format_count(counts.depth, 'joint')} deep",
        )
    else:
        roots = _format_listed(counts.roots)
        yield "tree", f"{format_count(len(counts.roots), 'root')}{': ' * bool(roots)}{roots}"
    if robot.closures:
        yield (
            "closed loops",
            _format_listed([c.name or f"{c.parent} – {c.child}" for c in robot.closures]),
        )
    if robot.joint_actuators:
        yield "actuators", _format_listed([one.name or one.joint for one in robot.joint_actuators])
    without = f"; {format_count(counts.massless, 'link')} without" if counts.massless else ""
    yield "mass", f"{counts.mass:.6g} kg{without}"
    yield "size at zero pose", _format_size(measured)
    unknown = [g for _, shape in robot.shapes if isinstance(g := shape.geometry, UnknownShape)]
    yield "meshes", _format_meshes(measured, sum(shape.tag == "mesh" for shape in unknown))
    for mesh in measured.meshes:
        if mesh.reason:
            yield "meshes", f"not read: {escape_controls(mesh.uri)}: {escape_controls(mesh.reason)}"
    for name, folder in counts.packages.items():
        yield (
            "packages",
            f"{escape_controls(name)}  {'not found' if folder is None else _format_short(folder)}",
        )
    yield from (("plugins", line) for line in _format_named(counts.plugins))
    yield from (("sensors", line) for line in _format_sensors(counts.sensors))
    yield from (("ros2_control", line) for line in _format_named(counts.hardware))
    if counts.transmissions:
        yield "transmissions", _format_listed(counts.transmissions)


def _format_size(measured: Measured) -> str:
    if measured.bounds is None:
        return "no shape that could be read"
    size = " × ".join(f"{round(length, 6):.4g}" for length in measured.bounds.size)
    missing = measured.left_out
    lacks = f", without {format_count(missing, 'shape')} that could not be read" if missing else ""
    lowest = f"; lowest point at z = {round(measured.bounds.low[2], 6) + 0.0:.4g} m"
    return f"{size} m along the root's x, y, z{lowest}{lacks}"


def _format_meshes(measured: Measured, without: int) -> str:
    """Format the mesh files, and the number of shapes whose mesh has no file."""
    rest = f"{format_count(without, 'shape')} with a mesh that has no file" if without else ""
    if not measured.meshes:
        return rest or "none"
    files = format_count(len(measured.meshes), "file")
    shown, touched = measured.count_triangles("visuals"), measured.count_triangles("collisions")
    return f"{files}; {shown:,} triangles in visuals, {touched:,} in collisions" + (
        f"; {rest}" if rest else ""
    )


def _format_named(things: Iterable[Named]) -> Iterator[str]:
    for thing in things:
        on = f" on {escape_controls(thing.on)}" if thing.on is not None else ""
        what = f" ({escape_controls(thing.what)})" if thing.what else ""
        yield f"{escape_controls(thing.name) or 'no name'}{what}{on}"


def _format_sensors(sensors: Sequence[Named]) -> Iterator[str]:
    """Yield a line for each sensor, or for each type with more of them than a line lists."""
    count = Counter(sensor.what for sensor in sensors)
    many = dict.fromkeys(sensor.what for sensor in sensors if count[sensor.what] > _MOST)
    for kind in many:
        names = dict.fromkeys(one.on or one.name for one in sensors if one.what == kind)
        yield f"{count[kind]} {escape_controls(kind)} on {_format_listed(list(names))}"
    yield from _format_named(sensor for sensor in sensors if sensor.what not in many)


def _format_listed(names: list[str]) -> str:
    more = len(names) - _MOST
    shown = [escape_controls(name) for name in names[:_MOST]]
    return ", ".join([*shown, f"{more} more"] if more > 0 else shown)


def _format_short(folder: str) -> str:
    relative = os.path.relpath(folder)
    return escape_controls(folder if relative.startswith("..") else relative)


def to_json(robot: Robot, counts: Counts, measured: Measured) -> str:
    """Format the properties and each mesh as one object; lengths [m], masses [kg]."""
    bounds = measured.bounds
    record: dict[str, Any] = {"version": 1, "name": robot.name}
    record["path"] = robot.source.path if robot.source is not None else None
    record |= asdict(counts)
    for kind in ("plugins", "sensors", "hardware"):
        record[kind] = [
            {"name": named.name, "type": named.what, "on": named.on}
            for named in getattr(counts, kind)
        ]
    record["size"] = None if bounds is None else list(bounds.size)
    record["left_out"] = measured.left_out
    record["bounds"] = None if bounds is None else {"low": bounds.low, "high": bounds.high}
    record["meshes"] = [{**asdict(mesh), "reason": mesh.reason or None} for mesh in measured.meshes]
    record["triangles"] = {
        kind: measured.count_triangles(kind) for kind in ("visuals", "collisions")
    }
    return format_json(record, 1) + "\n"
