"""Frames of the model of an SDF file, for the poses of sensors and of other elements."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ....mechanics.reference import get_origin_matrix
from ....model.elements import Robot
from ....model.pose import rotation_from_quaternion, rotation_from_rpy

Array = npt.NDArray[np.float64]


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
            base = _read_relative_to(element) or self._get_default(element)
            self.known[name] = self.get_pose(base, depth + 1) @ read_pose(element)
        return self.known[name]

    def _get_default(self, element: ET.Element) -> str:
        """Return the default frame of an element's pose."""
        if element.tag == "frame":
            return element.get("attached_to", "")
        return _read_text(element, "child") if element.tag == "joint" else ""

    def get_body(self, name: str, depth: int = 0) -> str:
        """Return the link that a frame is attached to; ``world`` for the model's own."""
        if name in ("", "__model__", "world"):
            return "world"
        element = self.elements[name]
        if element.tag == "link" or depth > 1000:
            return name
        if element.tag == "joint":
            return self.get_body(_read_text(element, "child"), depth + 1)
        return self.get_body(element.get("attached_to", ""), depth + 1)

    def get_local(self, link: str, element: ET.Element) -> Array:
        """Return the pose of an element of a link in the link's frame."""
        base = _read_relative_to(element)
        pose = read_pose(element)
        return invert_pose(self.get_pose(link)) @ self.get_pose(base) @ pose if base else pose

    def place(
        self, robot: Robot, name: str, rename: Callable[[str], str]
    ) -> tuple[str, Array] | None:
        """Return the link that holds a link of a robot, and its pose there, 4 × 4.

        In a file without frames, this is the nearest link above over fixed joints.

        Args:
            robot: The source.
            name: Name of its link.
            rename: Returns the name of a link in the file.
        """
        inside = np.eye(4)
        while name in robot.link:
            new = rename(name)
            element = self.elements.get(new)
            if name == "world" and element is None:
                return "world", inside
            if element is not None and element.tag != "joint":
                body = self.get_body(new)
                return body, invert_pose(self.get_pose(body)) @ self.get_pose(new) @ inside
            joint = robot.tree.get_parent_joint(name)
            if joint is None or not joint.is_fixed:
                return None
            inside, name = get_origin_matrix(joint.origin) @ inside, joint.parent
        return None


def open_model(path: Path) -> Frames:
    """Read the first model of a file other than the ground, with its frames."""
    root = ET.parse(path).getroot()
    models = [*root.findall("model"), *root.findall("world/model")]
    model = next(m for m in models if m.get("name") != "ground_plane")
    return Frames(model, tuple(map(int, root.get("version", "1.0").split("."))) < (1, 7))


def read_pose(element: ET.Element) -> Array:
    """Read the ``<pose>`` of an element; the identity by default."""
    pose = element.find("pose")
    numbers = [float(word) for word in (pose.text or "").split()] if pose is not None else []
    if pose is None or not numbers:
        return np.eye(4)
    if pose.get("rotation_format") == "quat_xyzw":
        x, y, z, w = numbers[3:]
        return make_pose(rotation_from_quaternion((w, x, y, z)), numbers[:3])
    return make_pose_of_six(numbers)


def _read_relative_to(element: ET.Element) -> str:
    pose = element.find("pose")
    return "" if pose is None else pose.get("relative_to", "")


def _read_text(element: ET.Element, path: str) -> str:
    return (element.findtext(path) or "").strip()


def make_pose(rotation: Any, translation: Any) -> Array:
    """Return the 4 × 4 matrix of a rotation and a translation."""
    pose = np.eye(4)
    pose[:3, :3] = rotation
    pose[:3, 3] = translation
    return pose


def make_pose_of_six(values: Any) -> Array:
    """Return the 4 × 4 matrix of a translation [m] and fixed-axis angles [rad]."""
    return make_pose(rotation_from_rpy(tuple(values[3:])), values[:3])


def invert_pose(pose: Array) -> Array:
    """Return the inverse of a pose."""
    back = np.eye(4)
    back[:3, :3] = pose[:3, :3].T
    back[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return back
