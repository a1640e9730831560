"""Mesh and image files of a robot: their paths, and the files that they refer to."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ...errors import UrdftoolError
from ...geometry.reference_patterns import INIT_FROM, MAP, MTLLIB, URI
from ...model.elements import Robot
from ...source.packages import find_own_package
from .asset_filter import is_companion

_NAMED = {
    ".dae": INIT_FROM,
    ".obj": MTLLIB,
    ".mtl": MAP,
    ".gltf": URI,
}
"""How each format names other files."""


def find_file(robot: Robot, uri: str) -> Path | None:
    """Return the file of a URI or path in a description; None if it does not exist."""
    if not uri or robot.source is None:
        return None
    try:
        path = robot.source.resolve(uri)
        return path if os.path.isfile(path) else None
    except (UrdftoolError, OSError, ValueError):
        return None


def find_companions(robot: Robot, path: Path) -> Iterator[tuple[Path, str]]:
    """Yield the images, material and buffer files that a mesh refers to, with their relative names.

    Absolute references, missing files, those that the description may not read, and files of other
    kinds are skipped.
    """
    pattern = _NAMED.get(path.suffix.lower())
    if pattern is None or robot.source is None:
        return
    workspace = robot.source.workspace
    try:
        data = workspace.read_bytes(path)
    except OSError:
        return
    for raw in dict.fromkeys(pattern.findall(data)):
        name = raw.decode("utf-8", "replace").strip().removeprefix("file://").replace("\\", "/")
        if not name or name.startswith(("/", "data:")) or "://" in name:
            continue
        other = path.parent / name
        if workspace.get_size(other) is not None and is_companion(other):
            yield other, name


def get_package_path(path: Path) -> tuple[str, str]:
    """Return the package of a file and its path there; without one, the name of its folder."""
    full = Path(os.path.abspath(path))
    own = find_own_package(full)
    if own is None:
        return full.parent.name, full.name
    return own[0], full.relative_to(own[1]).as_posix()
