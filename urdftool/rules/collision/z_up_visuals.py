"""Find visuals in glTF files whose content has Z up, although glTF has Y up."""

from __future__ import annotations

from functools import reduce

from ...model.bounds import Bounds
from ...model.elements import Link, Robot, Visual
from ...model.gltf_axes import is_gltf
from ...model.pose import IDENTITY_ROTATION, multiply_matrices, rotation_from_rpy, transpose
from ...source.description import Description
from ..mesh.link_extents import get_extents
from .misalignment import measure_boxes

_TO_Y_UP = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))
"""Rotation that takes Z up to Y up."""

_NEAR = 0.1
"""Largest distance of two faces of boxes that are alike, as a part of the diagonal. Chosen, no
source.
"""


def find_z_up_visuals(robot: Robot, description: Description) -> list[Link]:
    """Find links whose collision agrees with their glTF visual only if the file has Z up.

    Empty if ``--gltf-up`` says Z.
    """
    if description.gltf_up != "y":
        return []
    return robot.memo.get("z-up visuals", lambda: [x for x in robot.links if _has_z_up(robot, x)])


def _has_z_up(robot: Robot, link: Link) -> bool:
    """Tell whether the visual of a link agrees with its collision only before the rotation."""
    read = [shape for shape in link.visuals if is_gltf(shape)]
    if not read or any(map(is_gltf, link.collisions)):
        return False
    reach = get_extents(robot)
    visual, collision = measure_boxes(reach, link)
    if visual is None or collision is None or _are_alike(visual, collision):
        return False
    boxes = [_turn_back(shape, reach.get_shapes_box([shape])) for shape in read]
    boxes += [reach.get_shapes_box([shape]) for shape in link.visuals if shape not in read]
    known = [box for box in boxes if box is not None]
    written = reduce(Bounds.join, known)
    return len(known) == len(boxes) and _are_alike(written, collision)


def _turn_back(shape: Visual, box: Bounds | None) -> Bounds | None:
    """Return the box of a shape in the link frame as if its file were read with Z up.

    It is exact for rotations by multiples of 90°, otherwise it is larger.
    """
    if box is None:
        return None
    rotation, at = IDENTITY_ROTATION, (0.0, 0.0, 0.0)
    if shape.origin is not None:
        rotation, at = rotation_from_rpy(shape.origin.rpy), shape.origin.xyz
    back = multiply_matrices(multiply_matrices(rotation, _TO_Y_UP), transpose(rotation))
    low, high = (tuple(a - b for a, b in zip(end, at, strict=True)) for end in box)
    turned = Bounds(low, high).rotate(back)  # type: ignore[arg-type]
    low, high = (tuple(a + b for a, b in zip(end, at, strict=True)) for end in turned)
    return Bounds(low, high)  # type: ignore[arg-type]


def _are_alike(one: Bounds, other: Bounds) -> bool:
    """Tell whether all faces of two boxes are near to each other."""
    least = _NEAR * sum(size * size for size in other.size) ** 0.5
    faces = zip((*one.low, *one.high), (*other.low, *other.high), strict=True)
    return all(abs(a - b) <= least for a, b in faces)
