"""Find out which links without mass are frames of tools and sensors."""

from __future__ import annotations

import re

from ...model.attached import find_attached_links
from ...model.elements import Link, Mesh, Robot
from ..mesh.link_extents import get_extents
from .solids import compute_volume


def is_slight_frame(robot: Robot, link: Link) -> bool:
    """Tell whether 1 kg in addition to a link's body matters little, or its shape is a frame's."""
    return _is_frame_of_device(robot, link) or _is_far_heavier(robot, link)


def _is_frame_of_device(robot: Robot, link: Link) -> bool:
    """Tell whether the shape of a link marks a place, or is that of a small tool or sensor."""
    box = get_extents(robot).get_link_box(link)
    if box is None:
        return False
    largest = _SMALL_DEVICE if _DEVICE.search(link.name) else _MARKED
    return max(box.size) <= largest


_DEVICE = re.compile(
    r"(?<![a-z])(tool0?|tcp|ee|end_?effector|imu|gps|gnss|camera|cam|lidar|laser|scan|mid360|"
    r"sensor|optical|realsense|zed|tag|aruco|frame|mount)(?![a-z])",
    re.IGNORECASE,
)
_MARKED, _SMALL_DEVICE = 0.01, 0.06
"""Largest size [m] of a marker, and of a tool or sensor that needs no mass. Chosen, no source."""


def _is_far_heavier(robot: Robot, link: Link) -> bool:
    """Tell whether the robot has fifty times the 1 kg that PyBullet substitutes, and the body 1 kg.

    Otherwise the link may be the main part of its body.
    """
    body = sum(other.mass for other, _ in find_attached_links(robot, link))
    return body >= 1.0 and sum(one.mass for one in robot.links) >= _FAR_HEAVIER


_FAR_HEAVIER = 50.0
"""Mass of a robot [kg] to which 1 kg matters little. Chosen, no source."""


def is_light_marker(link: Link) -> bool:
    """Tell whether a link is so small that at the density of water its mass is below 1 g."""
    shapes = link.collisions or link.visuals
    if any(shape.geometry is None or isinstance(shape.geometry, Mesh) for shape in shapes):
        return False
    return 1000 * sum(compute_volume(shape.geometry) for shape in shapes) < _LIGHT


_LIGHT = 1e-3
"""Mass of a marker [kg]. Chosen, no source."""


def is_massless_scene(robot: Robot) -> bool:
    """Tell whether no joint of a robot moves and no link has an inertial, as in a scene."""
    return not robot.moving_joints and all(link.inertial is None for link in robot.links)
