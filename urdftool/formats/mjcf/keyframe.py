"""The home configuration as a keyframe."""

from __future__ import annotations

from lxml import etree

from ...model.pose import Pose, quaternion_from_rotation
from .actuator import Drive
from .digits import format_numbers_text
from .frame import simplify_quaternion
from .home import Home
from .joint import PLANAR_SUFFIXES
from .structure import Structure


def build_keyframe_section(structure: Structure, home: Home, drives: list[Drive]) -> etree._Element:
    """Build ``<keyframe>`` with the key ``home``, whose controls hold the joints in place."""
    section = etree.Element("keyframe")
    key = etree.SubElement(section, "key", name="home")
    qpos = _get_positions(structure, home)
    if qpos:
        key.set("qpos", format_numbers_text(qpos))
    if drives:
        key.set(
            "ctrl",
            format_numbers_text(
                home.positions.get(drive.joint.name, 0.0) if drive.kind == "position" else 0.0
                for drive in drives
            ),
        )
    return section


def _get_positions(structure: Structure, home: Home) -> list[float]:
    """Return ``qpos`` in MuJoCo's order: nested free bodies come after the root's tree."""
    first = _collect_free(home.pose) if structure.free else []
    later: list[float] = []
    torn: set[str] = set()
    for joint in structure.moving:
        kind = structure.get_kind(joint)
        if kind == "free":
            values = _collect_free(home.floating[joint.name])
        elif kind == "ball":
            values = [1.0, 0.0, 0.0, 0.0]
        elif kind == "planar":
            values = [0.0] * len(PLANAR_SUFFIXES)
        else:
            values = [home.positions.get(joint.name, 0.0)]
        nested = joint.parent in torn
        if (kind == "free" and not structure.in_world) or nested:
            torn.update((joint.child, *structure.robot.tree.list_descendants(joint.child)))
            later += values
        else:
            first += values
    return first + later


def _collect_free(pose: Pose) -> list[float]:
    turn = simplify_quaternion(quaternion_from_rotation(pose.rotation)) or (1.0, 0.0, 0.0, 0.0)
    return [*pose.translation, *turn]
