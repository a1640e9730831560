"""Read the first of several objects of an OBJ file, as MuJoCo does."""

from __future__ import annotations

from pathlib import Path

from ...model.elements import Vector
from ...model.pose import compute_cross, compute_dot
from ...workspace import Workspace, memoize_by_workspace

_FLAT = 1e-9
"""Volume of an object, relative to the cube of its size, below which it counts as flat. Chosen, no
source.
"""


@memoize_by_workspace
def is_first_object_flat(workspace: Workspace, path: Path) -> bool:
    """Tell whether an OBJ file has several objects and the faces of the first lie in a plane.

    A statement ``o`` or ``g`` begins an object. An unreadable file has no objects.
    """
    try:
        text = workspace.read_bytes(path).decode("utf-8", "replace")
        corners = _read_first_object(text)
        return bool(corners) and _is_flat(corners)
    except (OSError, ValueError, IndexError):
        return False


def _read_first_object(text: str) -> list[Vector]:
    """List the corners of the faces of the first object; empty without a second object."""
    points: list[Vector] = []
    first: list[Vector] = []
    ended = False
    for line in text.splitlines():
        keyword, _, rest = line.strip().partition(" ")
        if keyword == "v":
            x, y, z = map(float, rest.split()[:3])
            points.append((x, y, z))
        elif keyword in ("o", "g"):
            ended = bool(first)
        elif keyword == "f":
            if ended:
                return first
            numbers = (int(word.partition("/")[0]) for word in rest.split())
            first += [points[number - 1 if number > 0 else number] for number in numbers]
    return []


def _is_flat(corners: list[Vector]) -> bool:
    """Tell whether points lie in a plane."""
    origin = corners[0]
    arms = [_subtract(corner, origin) for corner in corners]
    size = max(compute_dot(arm, arm) for arm in arms) ** 0.5
    longest = max(arms, key=lambda arm: compute_dot(arm, arm))
    normal = max(
        (compute_cross(longest, arm) for arm in arms), key=lambda found: compute_dot(found, found)
    )
    return all(abs(compute_dot(normal, arm)) <= _FLAT * size**3 for arm in arms)


def _subtract(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]
