"""Find visuals in glTF files whose content has Z up, although glTF has Y up."""

from __future__ import annotations

from ...model.bounds import Bounds
from ...model.elements import Link, Robot
from ...model.gltf_axes import is_gltf
from ...source.description import Description
from ..mesh.link_extents import get_extents
from .misalignment import measure_boxes

_NEAR = 0.1
"""Largest distance of two faces of boxes that are alike, as a part of the diagonal. Chosen, no
source.
"""


def find_z_up_visuals(robot: Robot, description: Description) -> list[Link]:
    """Find links whose collision agrees with their glTF visual only if the file has Z up.

    Links whose glTF visuals have an origin are left out. Empty if ``--gltf-up`` says Z.
    """
    if description.gltf_up != "y":
        return []
    return robot.memo.get("z-up visuals", lambda: [x for x in robot.links if _has_z_up(robot, x)])


def _has_z_up(robot: Robot, link: Link) -> bool:
    """Tell whether the visual of a link agrees with its collision only before the rotation."""
    read = [shape for shape in link.visuals if is_gltf(shape)]
    origins = [shape.origin for shape in read if shape.origin is not None]
    if not read or any(any((*o.xyz, *o.rpy)) for o in origins):
        return False
    if any(map(is_gltf, link.collisions)):
        return False
    reach = get_extents(robot)
    visual, collision = measure_boxes(reach, link)
    rotated = reach.get_shapes_box(read)
    if visual is None or collision is None or rotated is None or _are_alike(visual, collision):
        return False
    (ax, ay, az), (bx, by, bz) = rotated
    other = reach.get_shapes_box([shape for shape in link.visuals if shape not in read])
    written = Bounds((ax, az, -by), (bx, bz, -ay))
    return _are_alike(written.join(other) if other is not None else written, collision)


def _are_alike(one: Bounds, other: Bounds) -> bool:
    """Tell whether all faces of two boxes are near to each other."""
    least = _NEAR * sum(size * size for size in other.size) ** 0.5
    faces = zip((*one.low, *one.high), (*other.low, *other.high), strict=True)
    return all(abs(a - b) <= least for a, b in faces)
