"""Links of SDF: inertia, shapes and sensors, with the defaults of the specification."""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import dropwhile, islice, pairwise
from pathlib import Path

from ...diagnostic import Severity
from ...errors import ModelError, UrdftoolError
from ...model.appearance import find_script, read_sdf_appearance
from ...model.blocks import add_parts
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Inertia,
    Inertial,
    Link,
    Material,
    Mesh,
    Plane,
    Robot,
    Sphere,
    UnknownShape,
    Vector,
    Visual,
)
from ...model.gazebo_colors import COLORS
from ...model.materials import compute_complement
from ...model.pose import IDENTITY, Pose, compute_norm, get_origin_at
from ...model.provenance import Written
from ...model.read_settings import read_sdf_settings
from ...model.sensors import read_sensor
from ...model.settings import OF_LINKS, SURFACE, Value, get_number
from ...model.shapes import collect_content
from ...source.document import Element
from ...workspace import Workspace
from ..reading import Losses
from .read_scope import Scope
from .read_values import number, read_numbers, read_pose, read_vector

_MESH_NAMES = ("uri", "filename")
"""Elements of a mesh with the name of its file, the first one first."""

_FILES = frozenset((*_MESH_NAMES, "diffuse", "normal"))
"""Elements of shapes with names of files; the last two are images of a heightmap."""

_TENSOR = {"ixx": 1.0, "ixy": 0.0, "ixz": 0.0, "iyy": 1.0, "iyz": 0.0, "izz": 1.0}


@dataclass
class Context:
    """State of reading one robot.

    Attributes:
        robot: The robot.
        losses: What it does not hold.
        main: Path of the main file.
        shifts: Pose of the frame of each link, as SDF writes it, in the frame of the ``Link``.
        poses: Pose of the frame of each link in the frame of the top model.
    """

    robot: Robot
    losses: Losses
    main: str
    shifts: dict[str, Pose] = field(default_factory=dict)
    poses: dict[str, Pose] = field(default_factory=dict)

    def record_loss(
        self,
        code: str,
        text: str,
        element: Element,
        severity: Severity = Severity.WARNING,
        unread: Element | None = None,
    ) -> None:
        """Report an element that is not read, or of which another one below it is not."""
        content = str(collect_content(element if unread is None else unread))
        self.losses.add(code, text, element.get("name") or "", element.place, severity, content)


def read_link(context: Context, scope: Scope, prefix: str, element: Element) -> Link:
    """Return a link whose parts are in its shifted frame, and add its sensors to the robot."""
    name = prefix + (element.get("name") or "")
    link = Link(Written(element.place), name, _read_inertial(context, scope, prefix, element))
    for child in element.children:
        if child.tag == "visual":
            link.visuals += _read_visual(context, scope, prefix, element, child)
        elif child.tag == "collision":
            link.collisions += _read_collision(context, scope, prefix, element, child)
        elif child.tag == "sensor":
            _add_sensor(context, scope, prefix, element, child)
        elif child.tag in ("light", "projector", "particle_emitter", "battery", "audio_source"):
            context.record_loss(
                child.tag, f"elements <{child.tag}> are not read", child, Severity.INFO
            )
    rejected = context.robot.rejected_settings
    link.settings = read_sdf_settings(element, OF_LINKS, rejected, ("link", name))
    return link


def compute_part_pose(
    context: Context, scope: Scope, prefix: str, link: Element, part: Element
) -> Pose:
    """Return the pose of a part in the shifted frame of its link."""
    name = link.get("name") or ""
    pose, frame = read_pose(part)
    if frame and frame != name:
        pose = scope.compute_pose(name, part).invert() @ scope.compute_pose(frame, part) @ pose
    return context.shifts[prefix + name] @ pose


def _read_inertial(context: Context, scope: Scope, prefix: str, link: Element) -> Inertial | None:
    """Return the inertia: 1 kg and 1 kg·m² where none is written."""
    element = link.find_child("inertial")
    holder = link if element is None else element
    written = Written(holder.place)
    if element is None:
        origin = get_origin_at(context.shifts[prefix + (link.get("name") or "")], written)
        return Inertial(written, origin, 1.0, Inertia(written, **_TENSOR))
    if (element.get("auto") or "").lower() in ("true", "1"):
        context.record_loss("auto-inertia", "inertia from shapes (auto) is not computed", link)
        return None
    added = element.find_child("fluid_added_mass")
    if added is not None:
        context.record_loss("added-mass", "added mass of a fluid is not read", link, unread=added)
    origin = get_origin_at(compute_part_pose(context, scope, prefix, link, element), written)
    tensor = element.find_child("inertia")
    values = {name: number(tensor, name, value) for name, value in _TENSOR.items()}
    at = written if tensor is None else Written(tensor.place)
    return Inertial(written, origin, number(element, "mass", 1.0), Inertia(at, **values))


def _read_visual(
    context: Context, scope: Scope, prefix: str, link: Element, element: Element
) -> list[Visual]:
    geometry, turn = _read_geometry(context, element)
    if geometry is None:
        return []
    written = Written(element.place)
    origin = get_origin_at(compute_part_pose(context, scope, prefix, link, element) @ turn, written)
    material, script = _read_material(context.robot, element)
    visual = Visual(written, element.get("name"), origin, geometry, material)
    rejected, part = context.robot.rejected_settings, _name_part(prefix, link)
    visual.appearance, visual.script = read_sdf_appearance(element, rejected, part), script
    if material is not None and material.color is not None:  # Gazebo ignores the alpha of diffuse
        red, green, blue, _ = material.color
        alpha = compute_complement(get_number(visual.appearance, "transparency") or 0.0)
        visual.material = replace(material, color=(red, green, blue, alpha))
    if material is not None and material.texture and find_script(element):
        visual.appearance.setdefault("metalness", Value(written, 0.0))  # scripts have no metal
    if script:
        context.record_loss(
            "material-script", "scripts of materials are not read", element, Severity.INFO
        )
    return [visual]


def _name_part(prefix: str, link: Element) -> tuple[str, str]:
    return "link", prefix + (link.get("name") or "")


def _read_collision(
    context: Context, scope: Scope, prefix: str, link: Element, element: Element
) -> list[Collision]:
    geometry, turn = _read_geometry(context, element)
    if geometry is None:
        return []
    written = Written(element.place)
    origin = get_origin_at(compute_part_pose(context, scope, prefix, link, element) @ turn, written)
    rejected = context.robot.rejected_settings
    surface = read_sdf_settings(element, SURFACE, rejected, _name_part(prefix, link))
    return [Collision(written, element.get("name"), origin, geometry, surface)]


def _read_geometry(context: Context, holder: Element) -> tuple[Geometry | None, Pose]:
    """Return the shape of a visual or collision, and its pose in the frame of that."""
    outer = holder.find_child("geometry")
    shapes = [] if outer is None else [child for child in outer.children if ":" not in child.tag]
    if not shapes or shapes[0].tag == "empty":
        return None, IDENTITY
    element, written = shapes[0], Written(shapes[0].place)
    tag = element.tag
    if tag == "plane":
        return _read_plane(element, written)
    if tag == "mesh":
        return _read_mesh(context, element, written), IDENTITY
    if tag == "box":
        return Box(written, read_vector(element, "size", (1.0, 1.0, 1.0))), IDENTITY
    if tag == "ellipsoid":
        return Ellipsoid(written, read_vector(element, "radii", (1.0, 1.0, 1.0))), IDENTITY
    if tag == "sphere":
        return Sphere(written, number(element, "radius", 1.0)), IDENTITY
    if tag == "capsule":
        radius, length = number(element, "radius", 0.5), number(element, "length", 1.0)
        return Capsule(written, radius, length), IDENTITY
    if tag in ("cylinder", "cone"):
        radius, length = number(element, "radius", 1.0), number(element, "length", 1.0)
        made = Cone if tag == "cone" else Cylinder
        return made(written, radius, length), IDENTITY
    context.record_loss(f"shape-{tag}", f"geometry <{tag}> is not read", holder)
    return _make_unknown_shape(context, element, tag), IDENTITY


def _make_unknown_shape(context: Context, element: Element, tag: str) -> UnknownShape:
    """Return a shape that is not read, with all that is written of it."""
    files = [_read_uri(context, e) for e in element.walk() if e.tag in _FILES and e.text.strip()]
    return UnknownShape(Written(element.place), tag, collect_content(element), tuple(files))


def _read_plane(element: Element, written: Written) -> tuple[Plane, Pose]:
    normal = read_vector(element, "normal", (0.0, 0.0, 1.0))
    size = element.find_child("size")
    extent = None if size is None else read_numbers(size, 2)
    plane = Plane(written, None if extent is None else (extent[0], extent[1]))
    return plane, Pose(_compute_rotation(normal, element))


def _compute_rotation(normal: Vector, element: Element) -> tuple[Vector, Vector, Vector]:
    """Return the least rotation that turns z to a direction."""
    length = compute_norm(normal)
    if not length:
        raise ModelError("the normal of the plane is zero", at=element.place)
    x, y, z = (part / length for part in normal)
    if z < -1 + 1e-12:
        return (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)
    k = 1 / (1 + z)
    return (1 - k * x * x, -k * x * y, x), (-k * x * y, 1 - k * y * y, y), (-x, -y, z)


def _read_mesh(context: Context, element: Element, written: Written) -> Geometry:
    named = (element.find_child(tag) for tag in _MESH_NAMES)
    uri = next((one for one in named if one is not None and one.text.strip()), None)
    if element.find_child("submesh") is not None:
        context.record_loss("submesh", "parts of mesh files (submesh) are not read", element)
        return _make_unknown_shape(context, element, "submesh")
    file = "" if uri is None else _read_uri(context, uri)
    return Mesh(written, file, read_vector(element, "scale", (1.0, 1.0, 1.0)))


def _read_uri(context: Context, element: Element) -> str:
    """Return the name of a file; a relative one of an included file as an absolute path."""
    uri = element.text.strip()
    if "://" not in uri and element.file.path != context.main:
        return os.path.join(os.path.dirname(os.path.abspath(element.file.path)), uri)
    return uri


def _add_sensor(
    context: Context, scope: Scope, prefix: str, link: Element, element: Element
) -> None:
    pose = compute_part_pose(context, scope, prefix, link, element)
    owner, written = prefix + (link.get("name") or ""), Written(element.place, element)
    add_parts(context.robot, element, read_sensor(element, pose, link=owner, provenance=written))


def normalize_direction(element: Element, vector: Vector) -> Vector:
    """Return a unit vector.

    Raises:
        ModelError: It is zero.
    """
    length = compute_norm(vector)
    if not length:
        raise ModelError("the axis is zero", at=element.place)
    x, y, z = vector
    return x / length, y / length, z / length


_LARGEST = 1 << 20
"""Size of a script [bytes] above which it is not read; chosen, no source."""

_OF_GAZEBO = "file://media/"
"""Start of the URIs of the scripts that Gazebo Classic installs."""


def _read_material(robot: Robot, holder: Element) -> tuple[Material | None, str]:
    """Return the material of a visual, and the name of its script if that is not known."""
    element = holder.find_child("material")
    if element is None:
        return None, ""
    name, color = find_script(holder), _read_color(element)
    image = _find_albedo(element)
    if name in COLORS:
        known = COLORS[name]
        rgba = color or (*known.diffuse, known.alpha)
        return Material(Written(element.place), name, rgba, image), ""
    if name and image is None:
        image = _find_image(robot, element, name)
    if color is None and image is None:
        return None, name
    return Material(Written(element.place), "", color, image), "" if image else name


def _read_color(element: Element) -> tuple[float, float, float, float] | None:
    diffuse = element.find_child("diffuse") or element.find_child("ambient")
    if diffuse is None:
        return None
    values = [*map(float, diffuse.text.split()), 1.0][:4]
    r, g, b, a = values if len(values) == 4 else read_numbers(diffuse, 4)
    return r, g, b, a


def _find_albedo(element: Element) -> str | None:
    pbr = element.find_child("pbr")
    maps = [] if pbr is None else [e.text.strip() for e in pbr.walk() if e.tag == "albedo_map"]
    return maps[0] if maps else None


def _find_image(robot: Robot, element: Element, name: str) -> str | None:
    """Return the image of a material in the scripts next to the model; None for none.

    Each URI is a script, or a folder of scripts or images.
    """
    script = element.find_child("script")
    uris = [] if script is None else [e.text.strip() for e in script.list_children("uri")]
    folders = [uri for uri in uris if not uri.startswith(_OF_GAZEBO)]
    if robot.source is None:
        return None
    workspace = robot.source.packages.workspace
    for text in _read_scripts(
        workspace, [path for uri in folders if (path := _resolve(robot, uri))]
    ):
        words: Iterable[str] = iter(text.split())
        if ("material", name) in pairwise(words):
            image = next(islice(dropwhile(lambda word: word != "texture", words), 1, 2), "")
            for folder in folders if image else ():
                uri = f"{folder.rstrip('/')}/{posixpath.basename(image)}"
                path = _resolve(robot, uri)
                if path is not None and workspace.is_file(path):
                    return uri
    return None


def _read_scripts(workspace: Workspace, paths: Iterable[Path]) -> Iterable[str]:
    """Yield the texts of scripts, and of those in folders."""
    for path in paths:
        is_folder = workspace.is_folder(path)
        for file in sorted(workspace.list_matches(path, "*.material")) if is_folder else [path]:
            try:
                if file.suffix == ".material":
                    yield workspace.read_bytes(file, _LARGEST).decode("utf-8", "replace")
            except (OSError, UrdftoolError):
                continue  # a file that may not be read is not a script


def _resolve(robot: Robot, uri: str) -> Path | None:
    try:
        return None if robot.source is None else robot.source.resolve(uri)
    except UrdftoolError:
        return None
