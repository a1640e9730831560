"""The page of the mapping, generated from the tables of the exporter."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ...model.gazebo_plugins import CONTROL_PLUGINS, MIMIC_PLUGINS, SENSOR_PLUGINS, SYSTEM_PLUGINS
from ...rules.gazebo.block_values import get_kind
from .body_sensors import BODY_SENSORS
from .colors import COLORS
from .joints import SDF_TYPES
from .keywords import COLLISION_KEYWORDS, JOINT_KEYWORDS, LINK_KEYWORDS, LUMPING_KEYWORDS, Keyword
from .losses import LOSSES
from .options import DEFAULT_VERSION, RELEASES, VERSIONS
from .sensor_types import SYSTEMS, TO_CLASSIC, TO_GZ, SensorType

ELEMENTS = (
    ("robot name", "model name", ""),
    ("link", "link", "or a frame, if SDF cannot express it alone, or it is lumped"),
    ("root link `world`", "the world", "its joints have the parent `world`"),
    ("inertial origin, mass, inertia", "inertial pose, mass, inertia", "number by number"),
    ("no inertial, on a fixed joint", "frame", "its shapes and sensors are in its neighbor"),
    ("no inertial, moving", "inertial of 1e-12 kg", "lossy-mass"),
    ("visual, collision origin", "pose", "in the frame of the lumped link where there are frames"),
    (
        "visual, collision name",
        "name",
        "made unique in the link; LINK_visual where none is written",
    ),
    ("box, cylinder, sphere, capsule", "the same", "capsule from SDF 1.8 on"),
    ("mesh filename, scale", "mesh uri, scale", "copied with the textures it names"),
    (
        "mesh glTF",
        "the same, rotated by its pose",
        "Gazebo does not convert its axes; not with `--gltf-up z`",
    ),
    ("color rgba", "ambient and diffuse", "and transparency; not brightened"),
    (
        "texture filename",
        "pbr metal albedo_map",
        "an Ogre script for Gazebo Classic, in a folder or with `--uri model`",
    ),
    ("joint origin", "pose relative_to the parent link", "from the model's frame in SDF 1.6"),
    ("axis xyz", "axis xyz", "of unit length"),
    ("limit lower, upper", "limit lower, upper", "0 where only the limit is written, as in URDF"),
    (
        "limit effort, velocity",
        "limit effort, velocity",
        "their absolute values; in SDF negative means no limit",
    ),
    ("dynamics damping, friction", "dynamics damping, friction", ""),
    ("mimic", "axis mimic", "from SDF 1.11 on"),
    ("safety_controller, calibration, transmission", "a comment", "lossy"),
    ("ros2_control", "a comment", "its plugin reads robot_description"),
    ("gazebo without reference", "model", "static, plugins, and SDF elements"),
)
"""URDF elements, their SDF counterparts, and notes."""


def format_mapping() -> str:
    """Format the tables of the page as Markdown."""
    return "\n\n".join(_list_sections())


def _list_sections() -> Iterator[str]:
    yield "### Versions\n\n" + _format_table(
        ("target", "SDF", "what reads it"),
        (
            (target, version + (" (default)" if DEFAULT_VERSION[target] == version else ""),
             RELEASES[version])
            for target, versions in VERSIONS.items()
            for version in versions
        ),
    )  # fmt: skip
    yield "### Elements\n\n" + _format_table(("URDF", "SDF", ""), ELEMENTS)
    yield "### Types of joints\n\n" + _format_table(
        ("URDF", "SDF"),
        (
            *((urdf, sdf) for urdf, sdf in SDF_TYPES.items()),
            ("floating", "no joint: a free link"),
            ("planar", "two prismatic and a revolute"),
        ),
    )
    yield '### `<gazebo reference="LINK">`\n\n' + _format_keywords(
        {**_collect_below("collision", COLLISION_KEYWORDS), **_collect_below("link", LINK_KEYWORDS)}
    )
    yield (
        '### `<gazebo reference="JOINT">`\n\n'
        + _format_keywords(_collect_below("joint", JOINT_KEYWORDS))
        + f"\n\n{' and '.join(f'`{tag}`' for tag in LUMPING_KEYWORDS)} keep a fixed joint when "
        "lumping; so does a force_torque sensor on it."
    )
    yield "### Sensors\n\n" + _format_table(
        ("for", "type", "becomes", ""),
        (*_list_types("gz", TO_GZ), *_list_types("gazebo-classic", TO_CLASSIC)),
    )
    yield "Systems that a world for gz has then (`--world` writes them):\n\n" + _format_table(
        ("sensor", "system"),
        ((kind, f"gz-sim-{word}-system") for kind, (word, _) in SYSTEMS.items()),
    )
    yield "### Plugins of Gazebo Classic in gz\n\n" + _format_table(
        ("library", "becomes"), _list_plugins()
    )
    yield (
        f"### Materials\n\n{len(COLORS)} materials of Gazebo Classic are colors for gz: "
        + ", ".join(name.removeprefix("Gazebo/") for name in COLORS)
        + "."
    )
    yield "### Losses\n\n" + _format_table(
        ("name", "what it means"), ((f"`lossy-{name}`", text) for name, text in LOSSES.items())
    )


def _format_table(head: tuple[str, ...], rows: Iterable[Iterable[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(row)} |".replace("|  |", "| |") for row in lines)


def _collect_below(where: str, keywords: dict[str, Keyword]) -> dict[str, Keyword]:
    return {tag: word._replace(path=f"{where}/{word.path}") for tag, word in keywords.items()}


def _format_keywords(keywords: dict[str, Keyword]) -> str:
    return _format_table(
        ("tag", "holds", "SDF", ""),
        (
            (f"`{tag}`", get_kind(tag), f"`{word.path}`", word.note)
            for tag, word in keywords.items()
        ),
    )


def _list_types(target: str, types: dict[str, SensorType]) -> Iterator[tuple[str, str, str, str]]:
    for kind, other in types.items():
        yield target, kind, other.type or "stays as it is", other.note if other.type else "lossy"


def _list_plugins() -> Iterator[tuple[str, str]]:
    for name, systems in SYSTEM_PLUGINS.items():
        yield f"`lib{name}.so`", ", ".join(f"gz-sim-{system.word}-system" for system in systems)
    for name in sorted(CONTROL_PLUGINS):
        yield f"`lib{name}.so`", "gz_ros2_control-system"
    for name in sorted(MIMIC_PLUGINS):
        yield f"`lib{name}.so`", "`<mimic>` of the axis"
    for name, plugin in SENSOR_PLUGINS.items():
        kind = f" of type {plugin.type}" if plugin.type else ""
        alone = BODY_SENSORS.get(name)
        outside = f"; outside of one, a sensor of type {alone.type}" if alone else ""
        system = f"gz-sim-{plugin.system}-system"
        yield f"`lib{name}.so`", f"the sensor itself{kind}, by {system}{outside}"
