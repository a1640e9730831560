"""Changes of one property of a robot, which are planted in its files."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from lxml import etree

from urdftool.errors import UrdftoolError
from urdftool.geometry.load import load_mesh

DEGREE = 0.017453292519943295
SMALLEST = 2e-5
"""Change of a size [m] below which nothing is planted."""

MASSLESS = 1e-9
"""Mass of a placeholder [kg], which is not changed."""

Node = etree._Element
Edit = Callable[[Node], None]


@dataclass
class Change:
    """A change of one property.

    Attributes:
        kind: Name of the kind.
        node: The element in the unchanged tree.
        edit: Function that changes the element of a copy of the tree.
        names: Links and joints at which the difference may be reported.
    """

    kind: str
    node: Node
    edit: Edit
    names: set[str]

    def apply(self) -> etree._ElementTree:
        """Return a changed copy of the tree."""
        tree = self.node.getroottree()
        copy = etree.ElementTree(etree.fromstring(etree.tostring(tree)))
        (node,) = copy.xpath(tree.getpath(self.node))
        self.edit(node)
        return copy


def set_to(key: str, value: str) -> Edit:
    """Return an edit that sets an attribute; the text for an empty name."""

    def edit(node: Node) -> None:
        if key:
            node.set(key, value)
        else:
            node.text = value

    return edit


def remove(node: Node) -> None:
    """Remove an element."""
    node.getparent().remove(node)


def numbers(text: str | None, default: str = "") -> list[float]:
    """Read numbers."""
    return [float(word) for word in (default if text is None else text).split()]


def join(values: object) -> str:
    """Write numbers."""
    return " ".join(repr(float(value)) for value in np.ravel(values))


def shift(text: str | None, index: int, amount: float, default: str = "0 0 0") -> str:
    """Add an amount to one of several numbers."""
    values = numbers(text, default)
    values[index] += amount
    return join(values)


def scale(text: str | None, factor: float, default: str = "") -> str:
    """Multiply the first of several numbers."""
    values = numbers(text, default)
    values[0] *= factor
    return join(values)


def negate(text: str) -> str:
    """Negate every number."""
    return join(-np.array(numbers(text)))


def make_rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    """Return a rotation matrix, 3 × 3."""
    x, y, z = axis / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def tilt(text: str, degrees: float = 1.0) -> str:
    """Turn an axis about a perpendicular direction."""
    axis = np.array(numbers(text))
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    return join(make_rotation(np.cross(axis, other), degrees * DEGREE) @ axis)


SIX = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def make_tensor(six: list[float]) -> np.ndarray:
    """Return a tensor of xx xy xz yy yz zz, 3 × 3."""
    xx, xy, xz, yy, yz, zz = six
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def get_six(tensor: np.ndarray) -> list[float]:
    """Return xx xy xz yy yz zz."""
    return [float(value) for value in tensor[np.triu_indices(3)]]


def change_tensor(tensor: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield changed tensors that differ by 0.2 % of the trace or more, with the kind."""
    turned = make_rotation(np.array([1.0, 2.0, 3.0]), 10 * DEGREE)
    grown = tensor.copy()
    index = int(np.argmax(np.diag(tensor)))
    grown[index, index] *= 0.98
    mirrored = tensor * np.array([[1, -1, 1], [-1, 1, 1], [1, 1, 1]])
    for kind, new in (
        ("tensor turned by 10°", turned @ tensor @ turned.T),
        ("moment by 2 %", grown),
        ("sign of a product of inertia", mirrored),
    ):
        values = np.linalg.eigvalsh(new)
        valid = values[0] > 0 and values[0] + values[1] >= values[2]
        if valid and np.abs(new - tensor).max() > 2e-3 * np.trace(tensor):
            yield kind, new


def list_other_meshes(node: Node, own: str, files: dict[str, str]) -> list[str]:
    """Return the names of files with another surface than the file of a name.

    Args:
        node: Any element of the description.
        own: Name of a file.
        files: Paths by name, relative to the folder of the description.
    """
    folder = Path(node.getroottree().docinfo.URL).parent
    surface = _read_points(folder / files[own])
    if surface is None:
        return []
    found = []
    for name in sorted(set(files) - {own}):
        points = _read_points(folder / files[name])
        if points is not None and points != surface:
            found.append(name)
    return found


@cache
def _read_points(path: Path) -> frozenset[tuple[float, ...]] | None:
    """Return the vertices of a mesh in micrometers; None if it cannot be read."""
    try:
        mesh = load_mesh(path, (1.0, 1.0, 1.0), gltf_up="y")
    except (UrdftoolError, OSError):
        return None
    return frozenset(map(tuple, np.round(np.asarray(mesh.vertices) * 1e6).tolist()))
