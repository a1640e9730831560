"""The page of the mapping, generated from the tables of the exporter."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from urdftool.formats.sdf.joints import SDF_TYPES
from urdftool.formats.sdf.options import DEFAULT_VERSION, RELEASES, VERSIONS
from urdftool.formats.sdf.sensor_types import SYSTEMS, TO_CLASSIC, TO_GZ, SensorType
from urdftool.model.gazebo_colors import COLORS
from urdftool.model.gazebo_plugins import (
    BODY_SENSORS,
    CONTROL_PLUGINS,
    MIMIC_PLUGINS,
    SENSOR_PLUGINS,
    SYSTEM_PLUGINS,
)
from urdftool.model.settings import (
    LUMPING_TAGS,
    OF_JOINTS,
    OF_LINKS,
    RESISTANCE_OF_URDF,
    SURFACE,
    Setting,
)

_DYNAMICS = f"dynamics {', '.join(RESISTANCE_OF_URDF)}"

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
    ("box, cylinder, sphere, capsule, ellipsoid", "the same", "the last two from SDF 1.8 on"),
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
    (_DYNAMICS, _DYNAMICS, ""),
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
        (*_list_tags("collision", SURFACE), *_list_tags("link", OF_LINKS))
    )
    yield (
        '### `<gazebo reference="JOINT">`\n\n'
        + _format_keywords(_list_tags("joint", OF_JOINTS))
        + f"\n\n{' and '.join(f'`{tag}`' for tag in sorted(LUMPING_TAGS)[::-1])} keep a fixed "
        "joint when lumping; so does a force_torque sensor on it."
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
        + ", ".join(f"`{name}`" for name in COLORS)
        + "."
    )
    yield "### Losses\n\n" + _format_table(
        ("name", "what it means"), ((f"`lossy-{name}`", text) for name, text in LOSSES.items())
    )


def _format_table(head: tuple[str, ...], rows: Iterable[Iterable[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(row)} |".replace("|  |", "| |") for row in lines)


def _list_tags(where: str, rows: Iterable[Setting]) -> Iterator[tuple[str, str, str, str]]:
    """Yield tag, kind, SDF element and note of each tag of a table."""
    for row in rows:
        for tag in filter(None, (*row.tags, row.opposite)):
            note = "negated" if tag == row.opposite else row.note
            yield f"`{tag}`", row.kind, f"`{where}/{row.path}`", note


def _format_keywords(rows: Iterable[tuple[str, str, str, str]]) -> str:
    return _format_table(("tag", "holds", "SDF", ""), rows)


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


LOSSES = {
    "axis": "an axis of length zero has no direction; the joint is exported as fixed (`--force`)",
    "calibration": "`<calibration>` is kept as a comment",
    "capsule": "SDF before 1.8 has no capsule; exported as other shapes",
    "contact": "contact values of a link without collision have no effect",
    "contact-sensor": "a contact sensor names a collision that does not exist",
    "element": "an element in a `<gazebo>` block is not SDF; it is kept as a comment",
    "extension": (
        "a tag of a `<gazebo>` block applies to another kind of element; it is not exported"
    ),
    "floating": "a floating joint becomes a free link without a joint",
    "frame": "SDF 1.6 has no frames; the name of a lumped link is lost",
    "frame-id": "SDF before 1.12 cannot express the frame of a sensor's messages",
    "gltf-axes": (
        "a glTF with Y up is rotated by its pose, since Gazebo does not convert the axes "
        "of the file"
    ),
    "inertia": "physically inconsistent inertia; `--fix-inertia` decides what is written",
    "joint-extension": "settings of a fixed joint that became a frame are not exported",
    "joint-type": "an unknown joint type; the joint is exported as fixed (`--force`)",
    "limit": "a limit is negative, zero, swapped or missing",
    "link": "a link that SDF cannot express alone became a frame of its neighbor",
    "link-flag": "gravity, damping or self-collision of a lumped link is not spread to the whole",
    "mass": "a moving link without mass gets 1e-12 kg",
    "material": "a material script of Gazebo Classic that gz cannot run",
    "mesh": "a mesh is missing, and its shape left out (`--force`)",
    "mesh-format": "a mesh is in a format that the target does not read; its URI is still written",
    "mimic": (
        "SDF before 1.11, or a joint without an axis, cannot express mimic; the joint moves freely"
    ),
    "name": "SDF does not allow a name, or it is taken; the part is renamed",
    "planar": "a planar joint becomes two prismatic joints and a revolute one",
    "plugin": "a plugin of Gazebo Classic was translated, or has no successor",
    "reference": "a `<gazebo>` block refers to an unknown name",
    "ros2-control": "`<ros2_control>` is read from robot_description, not from SDF",
    "safety": "`<safety_controller>` is kept as a comment",
    "sensor": "a sensor's type was translated, or the target does not have it",
    "welded-base": "the root is fixed to the world by a joint (`--base`)",
    "free-base": "the root is free because of what carries the robot (`--base auto`)",
    "shape": "a shape that cannot be exported is dropped (`--force`)",
    "texture": "a texture is missing, or there is no folder for the script that Classic requires",
    "transmission": "a transmission is kept as a comment",
    "world": (
        "inertial, visuals and collisions of the root link `world` are not exported; it is "
        "the world itself"
    ),
}
"""By the code after ``lossy-``. Defects skipped with ``--force`` keep their own code."""
