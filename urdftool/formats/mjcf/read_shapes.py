"""Geoms of MJCF as visuals and collisions."""

from __future__ import annotations

from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Ellipsoid,
    Geometry,
    Material,
    Mesh,
    Plane,
    Robot,
    Sphere,
    UnknownShape,
    Visual,
)
from ...model.pose import IDENTITY, Pose, get_origin_at, rotate, rotation_from_quaternion
from ...model.provenance import Written
from ...model.settings import SURFACE_OF_MUJOCO, Settings, Value
from .read_compile import Row
from .read_context import Context, read_pose, read_settings

_PLAIN = [0.5, 0.5, 0.5, 1.0]
"""Color of a geom that has none; in 32-bit floats these are exact."""

_HIDDEN_FROM = 3
"""MuJoCo's viewer does not show geoms of this group and above."""

_FRICTION = "geom friction"
"""Attribute with the sliding, spinning and rolling friction of a geom."""


def add_shapes(context: Context, robot: Robot) -> None:
    """Add visuals and collisions to the links of a robot."""
    for row in context.list_rows("geom"):
        written = context.get_place(row)
        if not context.has_link(row):
            text, code = "geoms of the world are scenery", "scenery"
            if row["paired"]:
                text, code = "geoms of the world that <pair> names are not read", "paired-scenery"
            context.losses.add(code, text, row["name"], written.place, Severity.INFO)
            continue
        link = robot.link[context.links[row["bodyid"]]]
        geometry, frame = _read_geometry(context, row, written)
        origin = get_origin_at(context.shifts[row["bodyid"]] @ frame, written)
        name = row["name"] or None
        collides = bool(row["contype"] or row["conaffinity"] or row["paired"])
        material, alpha = _read_material(context, row, written)
        visible = row["group"] < _HIDDEN_FROM and (alpha > 0 or not collides)
        if visible:
            link.visuals.append(Visual(written, name, origin, geometry, material))
            _report_discarded(context, collides, written, row["name"])
        if collides:
            surface = _read_surface(row, written)
            link.collisions.append(Collision(written, name, origin, replace(geometry), surface))
            _report_pair(context, row, written)
        if not visible and not collides:
            text = "geoms that are neither seen nor touched count in the mass only"
            context.losses.add("hidden-geom", text, row["name"], written.place, Severity.INFO)


def _report_discarded(context: Context, collides: bool, written: Written, name: str) -> None:
    if context.compiled.discards_visuals and not collides:
        text = "visuals that MuJoCo removes (discardvisual of <compiler>) are read"
        context.losses.add(
            "discarded-visual", text, name, written.place, Severity.INFO, content=name
        )


def _report_pair(context: Context, row: Row, written: Written) -> None:
    if row["paired"]:
        text = "pairs of geoms that touch are not read"
        context.losses.add("contact-pair", text, row["name"], written.place)


def _read_surface(row: Row, written: Written) -> Settings:
    """Return the friction and contact of a geom where they are not MuJoCo's defaults."""
    sliding, spinning, rolling = row["friction"]
    rows = [one for one in SURFACE_OF_MUJOCO if one.mjcf != _FRICTION]
    settings = read_settings(row, rows, written)
    numbers = {"spinning_friction": spinning, "rolling_friction": rolling}
    for setting in SURFACE_OF_MUJOCO:
        if setting.mjcf == _FRICTION and numbers[setting.name] != setting.default:
            settings[setting.name] = Value(written, numbers[setting.name])
    if sliding != 1.0:
        settings["friction"] = settings["second_friction"] = Value(written, sliding)
    return settings


def _read_geometry(context: Context, row: Row, written: Written) -> tuple[Geometry, Pose]:
    """Return the geometry of a geom and its pose in the frame of the body."""
    kind, (a, b, c), at = row["type"], row["size"], read_pose(row)
    if kind == "mesh":
        return _read_mesh(context, row, written)
    if kind == "sphere":
        return Sphere(written, a), at
    if kind == "capsule":
        return Capsule(written, a, 2 * b), at
    if kind == "cylinder":
        return Cylinder(written, a, 2 * b), at
    if kind == "box":
        return Box(written, (2 * a, 2 * b, 2 * c)), at
    if kind == "ellipsoid":
        return Ellipsoid(written, (a, b, c)), at
    if kind == "plane":
        return Plane(written, (2 * a, 2 * b) if a and b else None), at
    context.losses.add(kind, f"geoms of type {kind} are not read", row["name"], written.place)
    return UnknownShape(written, kind, row.get("content")), at


def _read_mesh(context: Context, row: Row, written: Written) -> tuple[Geometry, Pose]:
    """Return a mesh and the pose of its file in the frame of the body.

    MuJoCo moves the points of a mesh to its center of mass and principal axes, after it has
    subtracted ``refpos``, turned by the inverse of ``refquat``, and scaled.
    """
    mesh = context.list_rows("mesh")[row["dataid"]]
    at = read_pose(row) @ read_pose(mesh).invert()
    if not mesh["file"]:
        text = "meshes without a file are compared by a digest, and not exported"
        context.losses.add("mesh", text, mesh["name"], context.get_place(mesh).place)
        return UnknownShape(written, "mesh", mesh["content"]), at
    x, y, z = mesh["scale"]
    w, *ijk = mesh["refquat"]
    turned = IDENTITY
    if any(ijk):
        turned = Pose(rotation_from_quaternion((w, ijk[0], ijk[1], ijk[2]))).invert()
        if not x == y == z:
            text = "meshes with refquat and unequal scales are not read"
            context.losses.add("mesh-scale", text, mesh["name"], context.get_place(mesh).place)
            return UnknownShape(written, "mesh", mesh["content"]), at
    p, q, r = rotate(turned.rotation, tuple(mesh["refpos"]))
    moved = Pose(turned.rotation, (-x * p, -y * q, -z * r))
    return Mesh(context.get_place(mesh), mesh["file"], (x, y, z)), at @ moved


def _read_material(context: Context, row: Row, written: Written) -> tuple[Material, float]:
    """Return the material of a geom, and how opaque it is."""
    rgba = row["rgba"]
    if row["matid"] < 0:
        return Material(written, "", tuple(rgba)), rgba[3]
    material = context.list_rows("material")[row["matid"]]
    color = material["rgba"] if rgba == _PLAIN else rgba
    texture = material["texture"] or ("" if material["is_textured"] else None)
    if texture == "":
        text = "textures that MuJoCo makes are not read"
        place = context.get_place(material).place
        context.losses.add("made-texture", text, material["name"], place, Severity.INFO)
    name = material["name"] if color == material["rgba"] else ""
    named = Material(context.get_place(material), name, tuple(color), texture)
    return named, color[3]
