"""Reader of an SDF file as a mechanism, limited to what is compared."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from itertools import dropwhile, islice, pairwise
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlparse

import numpy as np

from .mechanism import (
    Array,
    Body,
    Hinge,
    Mechanism,
    Shape,
    invert_pose,
    make_pose,
    rotate_by_angles,
    rotate_by_quaternion,
)
from .source import get_digest

Find = Callable[[str], Path]


class Frames:
    """Poses of the frames of a model, by name, in the model's frame."""

    def __init__(self, model: ET.Element, old: bool) -> None:
        """Initialize for a model; ``old`` is SDF before 1.7, with its pose semantics."""
        self.old = old
        self.model = model
        self.elements = {e.get("name", ""): e for e in model if e.tag in ("link", "joint", "frame")}
        self.known: dict[str, Array] = {"__model__": np.eye(4), "": np.eye(4), "world": np.eye(4)}

    def get_pose(self, name: str, depth: int = 0) -> Array:
        """Return the pose of a link, joint or frame in the model's frame."""
        if name not in self.known:
            if depth > 1000:
                raise ValueError(f"the pose of '{name}' goes round in a circle")
            element = self.elements[name]
            base = _format_relative_to(element) or self._get_default(element)
            self.known[name] = self.get_pose(base, depth + 1) @ read_pose(element)
        return self.known[name]

    def _get_default(self, element: ET.Element) -> str:
        """Return the default frame of an element's pose."""
        if element.tag == "frame":
            return element.get("attached_to", "")
        return _format_text(element, "child") if element.tag == "joint" else ""

    def get_body(self, name: str, depth: int = 0) -> str:
        """Return the link that a frame is attached to; ``world`` for the model's own."""
        if name in ("", "__model__", "world"):
            return "world"
        element = self.elements[name]
        if element.tag == "link" or depth > 1000:
            return name
        if element.tag == "joint":
            return self.get_body(_format_text(element, "child"), depth + 1)
        return self.get_body(element.get("attached_to", ""), depth + 1)

    def get_local(self, link: str, element: ET.Element) -> Array:
        """Return the pose of an element of a link in the link's frame."""
        base = _format_relative_to(element)
        pose = read_pose(element)
        return invert_pose(self.get_pose(link)) @ self.get_pose(base) @ pose if base else pose


def open_model(path: Path) -> Frames:
    """Read the first model of a file other than the ground, with its frames."""
    root = ET.parse(path).getroot()
    models = [*root.findall("model"), *root.findall("world/model")]
    model = next(m for m in models if m.get("name") != "ground_plane")
    return Frames(model, tuple(map(int, root.get("version", "1.0").split("."))) < (1, 7))


def read_sdf(path: Path, find: Find) -> Mechanism:
    """Read the first model of a file as a mechanism.

    Args:
        path: Path of the file.
        find: Resolves ``package://`` URIs.
    """
    return read_model(open_model(path), path, find)


def read_model(frames: Frames, path: Path, find: Find) -> Mechanism:
    """Convert a model to a mechanism; see :func:`read_sdf`."""
    model = frames.model
    made = Mechanism()
    for link in model.findall("link"):
        name = link.get("name", "")
        made.bodies[name] = _make_body(link)
        made.frames[f"//{name}"] = ("world", frames.get_pose(name))
        for kind in ("visual", "collision"):
            for part in link.findall(kind):
                getattr(made, f"{kind}s").append(_make_shape(frames, name, part, path, find))
    for name, element in frames.elements.items():
        if element.tag != "joint":
            body = frames.get_body(name)
            inside = invert_pose(frames.get_pose(body)) @ frames.get_pose(name)
            made.frames[name] = (body, inside)
    made.frames["world"] = ("world", np.eye(4))
    made.joints = [_make_hinge(frames, joint) for joint in model.findall("joint")]
    return made


def read_pose(element: ET.Element) -> Array:
    """Read the ``<pose>`` of an element; the identity by default."""
    pose = element.find("pose")
    numbers = [float(word) for word in (pose.text or "").split()] if pose is not None else []
    if pose is None or not numbers:
        return np.eye(4)
    if pose.get("rotation_format") == "quat_xyzw":
        return make_pose(rotate_by_quaternion(*numbers[3:]), numbers[:3])
    return make_pose(rotate_by_angles(numbers[3:]), numbers[:3])


def _format_relative_to(element: ET.Element) -> str:
    pose = element.find("pose")
    return "" if pose is None else pose.get("relative_to", "")


def _format_text(element: ET.Element, path: str) -> str:
    return (element.findtext(path) or "").strip()


def _number(element: ET.Element | None, path: str, default: float) -> float:
    text = "" if element is None else _format_text(element, path)
    return float(text) if text else default


def _make_body(link: ET.Element) -> Body:
    inertial = link.find("inertial")
    if inertial is None:
        return Body(link.get("name", ""), 1.0, np.zeros(3), np.eye(3))  # SDF's default inertial
    frame = read_pose(inertial)
    t = {
        k: _number(inertial, f"inertia/{k}", 0.0)
        for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    }
    tensor = np.array(
        [
            [t["ixx"], t["ixy"], t["ixz"]],
            [t["ixy"], t["iyy"], t["iyz"]],
            [t["ixz"], t["iyz"], t["izz"]],
        ]
    )
    turn = frame[:3, :3]
    return Body(
        link.get("name", ""), _number(inertial, "mass", 1.0), frame[:3, 3], turn @ tensor @ turn.T
    )


def _make_hinge(frames: Frames, joint: ET.Element) -> Hinge:
    name = joint.get("name", "")
    parent, child = (frames.get_body(_format_text(joint, end)) for end in ("parent", "child"))
    placed = frames.get_pose(name)
    axis = joint.find("axis")
    direction = np.zeros(3)
    if axis is not None:
        direction = np.array(
            [float(word) for word in (_format_text(axis, "xyz") or "0 0 1").split()]
        )
        expressed = axis.find("xyz")
        frame = "" if expressed is None else expressed.get("expressed_in", "")
        if frame:
            direction = placed[:3, :3].T @ frames.get_pose(frame)[:3, :3] @ direction
    length = np.linalg.norm(direction)
    return Hinge(
        name,
        joint.get("type", ""),
        parent,
        child,
        invert_pose(frames.get_pose(parent)) @ placed,
        invert_pose(frames.get_pose(child)) @ placed,
        direction / length if length else direction,
        _collect_limits(axis),
        _collect_mimic(axis),
    )


def _collect_limits(axis: ET.Element | None) -> dict[str, float]:
    limits = {
        "lower": _number(axis, "limit/lower", -np.inf),
        "upper": _number(axis, "limit/upper", np.inf),
        "damping": _number(axis, "dynamics/damping", 0.0),
        "friction": _number(axis, "dynamics/friction", 0.0),
    }
    for name in ("effort", "velocity"):
        value = _number(axis, f"limit/{name}", -1.0)
        limits[name] = np.inf if value < 0 else value
    return limits


def _collect_mimic(axis: ET.Element | None) -> tuple[str, float, float] | None:
    mimic = None if axis is None else axis.find("mimic")
    if mimic is None:
        return None
    multiplier = _number(mimic, "multiplier", 1.0)
    offset = _number(mimic, "offset", 0.0) - multiplier * _number(mimic, "reference", 0.0)
    return mimic.get("joint", ""), multiplier, offset


def _make_shape(frames: Frames, link: str, part: ET.Element, path: Path, find: Find) -> Shape:
    rgba = _format_text(part, "material/diffuse")
    return Shape(
        link,
        link,
        frames.get_local(link, part),
        _collect_what(part, path, find),
        tuple(map(float, rgba.split())) if rgba else None,
        _get_picture(part, path, find),
        part,
    )


def _get_picture(part: ET.Element, path: Path, find: Find) -> str | None:
    """Return the digest of a visual's texture, from its albedo map or an Ogre script."""
    uri = _format_text(part, "material/pbr/metal/albedo_map")
    if uri:
        return get_digest(_make_file(uri, path, find))
    name = _format_text(part, "material/script/name")
    uris = [(uri.text or "").strip() for uri in part.findall("material/script/uri")]
    folders = [_make_file(uri, path, find) for uri in uris if not uri.startswith("file://media/")]
    for script in (file for folder in folders for file in sorted(folder.glob("*.material"))):
        words = iter(script.read_text("utf-8", "replace").split())
        if ("material", name) in pairwise(words):
            words = dropwhile(lambda word: word != "texture", words)
            picture = next(islice(words, 1, None), "")
            return get_digest(
                next((f / picture for f in folders if (f / picture).is_file()), script)
            )
    return None


def _collect_what(part: ET.Element, path: Path, find: Find) -> tuple[Any, ...]:
    holder = part.find("geometry")
    shape = holder[0] if holder is not None and len(holder) else None
    if shape is None:
        return ("unknown",)
    if shape.tag == "box":
        return ("box", *map(float, _format_text(shape, "size").split()))
    if shape.tag == "mesh":
        scale = (_format_text(shape, "scale") or "1 1 1").split()
        return (
            "mesh",
            get_digest(_make_file(_format_text(shape, "uri"), path, find)),
            *map(float, scale),
        )
    sizes = [
        _number(shape, name, 0.0) for name in ("radius", "length") if shape.find(name) is not None
    ]
    return (shape.tag, *sizes)


def _make_file(uri: str, path: Path, find: Find) -> Path:
    parts = urlparse(uri)
    if parts.scheme == "file":
        return Path(unquote(parts.path))
    if parts.scheme == "model":
        return path.parent.parent / parts.netloc / parts.path.lstrip("/")
    return find(uri) if parts.scheme else path.parent / uri
