"""A world for the robot: ground, sun, and the systems that its sensors need."""

from __future__ import annotations

from ...model.world_settings import OF_SDF
from .extensions import write_settings
from .plugins import get_system_name
from .sensor_types import RENDERED, SYSTEMS
from .translation import Translation
from .xml import Node, add

ALWAYS = (
    ("physics", "Physics"),
    ("user-commands", "UserCommands"),
    ("scene-broadcaster", "SceneBroadcaster"),
)


def add_world(parent: Node, t: Translation, robot: Node) -> None:
    """Add a world around the robot, with the gravity and other settings of the source's."""
    node = add(parent, "world", name="default")
    write_settings(node, t.robot.world, [row._replace(also="") for row in OF_SDF])
    if t.options.classic:
        for uri in ("model://ground_plane", "model://sun"):
            add(add(node, "include"), "uri", uri)
    else:
        _add_systems(node, t, robot)
        _add_sun(node)
        _add_ground(node)
    node.append(robot)


def get_needed(robot: Node) -> list[tuple[str, str]]:
    """Return the systems that the sensors of a model need, in the order of the table."""
    types = {sensor.get("type") for sensor in robot.iter("sensor")}
    return list(dict.fromkeys(system for kind, system in SYSTEMS.items() if kind in types))


def _add_systems(node: Node, t: Translation, robot: Node) -> None:
    for system in (*ALWAYS, *get_needed(robot)):
        made = add(node, "plugin", **get_system_name(t, *system))
        if system == RENDERED:
            add(made, "render_engine", "ogre2")
    if any(system[0] == "navsat" for system in get_needed(robot)):
        place = add(node, "spherical_coordinates")
        add(place, "surface_model", "EARTH_WGS84")
        add(place, "world_frame_orientation", "ENU")
        for tag in ("latitude_deg", "longitude_deg", "elevation", "heading_deg"):
            add(place, tag, "0")


def _add_sun(node: Node) -> None:
    light = add(node, "light", name="sun", type="directional")
    add(light, "cast_shadows", "true")
    add(light, "pose", "0 0 10 0 0 0")
    add(light, "diffuse", "0.8 0.8 0.8 1")
    add(light, "specular", "0.2 0.2 0.2 1")
    add(light, "direction", "-0.5 0.1 -0.9")


def _add_ground(node: Node) -> None:
    model = add(node, "model", name="ground_plane")
    add(model, "static", "true")
    link = add(model, "link", name="link")
    for kind, size in (("collision", "100 100"), ("visual", "100 100")):
        part = add(link, kind, name=kind)
        plane = add(add(part, "geometry"), "plane")
        add(plane, "normal", "0 0 1")
        add(plane, "size", size)
        if kind == "visual":
            material = add(part, "material")
            add(material, "ambient", "0.8 0.8 0.8 1")
            add(material, "diffuse", "0.8 0.8 0.8 1")
