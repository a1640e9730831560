"""Sites, cameras and lights in the bodies of their links."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

from lxml import etree

from ...model.elements import Robot
from ...model.mechanism import Camera, Frame, Light
from ...model.numbers import format_numbers_text, number_text
from ...model.pose import Pose, make_pose, rotation_from_quaternion
from ..common.naming import UniqueNames
from .body import Bodies
from .frame import set_pose
from .joint import SITE
from .sensor import find_covered, list_touched

CAMERA_TURN = Pose(rotation_from_quaternion((0.5, 0.5, -0.5, -0.5)))
"""Rotation from Gazebo's camera (x forward, z up) to MuJoCo's (-z forward, y up)."""

COVER = 1.01
"""Size of the site of a touch sensor relative to the covered collision; chosen, no source."""


def put_mounted(robot: Robot, bodies: Bodies) -> None:
    """Insert the lights, sites and cameras of a plan before the child bodies of their links."""
    for light in name_lights(robot.lights):
        _put(bodies[light.link], _build_light(light))
    there = {site.get("name") for body in bodies.values() for site in body.iterchildren("site")}
    touched = dict(list_touched(robot))
    for frame in robot.frames:
        if frame.kind == "body" or frame.name in there or frame.link not in bodies:
            continue
        site = _build_site(frame, {} if robot.format == "mjcf" else SITE)
        is_planned = frame.name in touched and robot.format != "mjcf"  # whose sites are copied
        covered = find_covered(touched[frame.name]) if is_planned else None
        if covered is not None:
            kind, size, _ = covered
            site.set("type", kind)
            site.set("size", format_numbers_text(COVER * length for length in size))
        _put(bodies[frame.link], site)
    for camera in robot.cameras:
        _put(bodies[camera.link], _build_camera(camera))


def name_lights(lights: Iterable[Light]) -> list[Light]:
    """Return lights with the names that they have in an MJCF."""
    names = UniqueNames()
    return [replace(light, name=names.take(light.name or "light")) for light in lights]


def _put(body: etree._Element, element: etree._Element) -> None:
    first = body.find("body")
    body.insert(len(body) if first is None else body.index(first), element)


def _build_site(frame: Frame, looks: Mapping[str, str]) -> etree._Element:
    """Build a site; one of an MJCF has the size and group of its source."""
    element = etree.Element("site", {"name": frame.name, **looks})
    set_pose(element, make_pose(frame.origin))
    return element


def _build_camera(camera: Camera) -> etree._Element:
    fov = math.degrees(camera.vertical_fov or 0.0)
    element = etree.Element("camera", name=camera.name, fovy=number_text(fov))
    if camera.resolution is not None:
        element.set("resolution", "{} {}".format(*camera.resolution))
    set_pose(element, make_pose(camera.origin) @ CAMERA_TURN)
    return element


def _build_light(light: Light) -> etree._Element:
    element = etree.Element("light", name=light.name, type=light.type)
    if any(light.position):
        element.set("pos", format_numbers_text(light.position))
    if light.direction is not None:
        element.set("dir", format_numbers_text(light.direction))
    for name, color in (("diffuse", light.diffuse), ("specular", light.specular)):
        if color is not None:
            element.set(name, format_numbers_text(color))
    if not light.casts_shadow:
        element.set("castshadow", "false")
    if light.cutoff is not None:
        element.set("cutoff", number_text(min(math.degrees(light.cutoff), 180.0)))
    return element
