"""The elements of URDF with their children and attributes, and what readers add to them."""

from __future__ import annotations

from typing import NamedTuple

from ..model.link import COMPONENTS
from .settings import LIMIT_NAMES, RESISTANCE_OF_URDF

BLOCKS = ("gazebo", "transmission", "ros2_control")
"""Elements of ``<robot>`` that simulators and controllers read, which name links and joints."""


class ElementType(NamedTuple):
    """An element of URDF.

    Attributes:
        children: Tags of the elements that it may contain.
        numbers: Count of numbers in each numeric attribute.
        words: The other attributes.
        many: Children that may be repeated; of others readers take the first.
        unread: Attributes that a robot does not hold, since few readers take them.
    """

    children: tuple[str, ...] = ()
    numbers: dict[str, int] = {}  # noqa: RUF012 -- a tuple's default, never changed
    words: tuple[str, ...] = ()
    many: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()

    @property
    def attributes(self) -> tuple[str, ...]:
        """Return the names of its attributes."""
        return (*self.words, *self.numbers)

    @property
    def held(self) -> frozenset[str]:
        """Return the names of the attributes that a robot holds."""
        return frozenset(self.attributes) - {*self.unread}


def _count_one(*names: str) -> dict[str, int]:
    return dict.fromkeys(names, 1)


_OF_MOTION = ("acceleration", "deceleration", "jerk")

VOCABULARY: dict[str, ElementType] = {
    "robot": ElementType(("link", "joint", "material"), words=("name", "version")),
    "link": ElementType(
        ("inertial", "visual", "collision"),
        words=("name", "type"),
        many=("visual", "collision"),
        unread=("type",),
    ),
    "inertial": ElementType(("origin", "mass", "inertia")),
    "mass": ElementType(numbers=_count_one("value")),
    "inertia": ElementType(numbers=_count_one(*COMPONENTS)),
    "visual": ElementType(("origin", "geometry", "material"), words=("name",)),
    "collision": ElementType(("origin", "geometry"), words=("name",)),
    "origin": ElementType(numbers={"xyz": 3, "rpy": 3, "quat_xyzw": 4}),
    "geometry": ElementType(
        ("box", "cylinder", "sphere", "mesh", "capsule"), words=("name",), unread=("name",)
    ),
    "box": ElementType(numbers={"size": 3}),
    "cylinder": ElementType(numbers=_count_one("radius", "length")),
    "sphere": ElementType(numbers=_count_one("radius")),
    "capsule": ElementType(numbers=_count_one("radius", "length")),
    "mesh": ElementType(numbers={"scale": 3}, words=("filename",)),
    "material": ElementType(("color", "texture"), words=("name",)),
    "color": ElementType(numbers={"rgba": 4}),
    "texture": ElementType(words=("filename",)),
    "joint": ElementType(
        (
            "origin",
            "parent",
            "child",
            "axis",
            "limit",
            "dynamics",
            "mimic",
            "safety_controller",
            "calibration",
        ),
        words=("name", "type"),
    ),
    "parent": ElementType(words=("link",)),
    "child": ElementType(words=("link",)),
    "axis": ElementType(numbers={"xyz": 3}),
    "limit": ElementType(numbers=_count_one(*LIMIT_NAMES, *_OF_MOTION), unread=_OF_MOTION),
    "dynamics": ElementType(numbers=_count_one(*RESISTANCE_OF_URDF)),
    "mimic": ElementType(numbers=_count_one("multiplier", "offset"), words=("joint",)),
    "safety_controller": ElementType(
        numbers=_count_one("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity")
    ),
    "calibration": ElementType(numbers=_count_one("rising", "falling", "reference_position")),
}

DIALECTS: dict[str, frozenset[str]] = {
    "robot": frozenset(
        (
            # ROS and Gazebo
            *BLOCKS,
            "sensor",
            "gripper",
            # simulators
            "mujoco",
            "loop_joint",
            "frame",
            "ball_constraint",
            "linear_bushing_rpy",
            "linear_spring_damper",
            "collision_filter_group",
            "self_collision_checking",
            "fixed_frame",
            "isaac_sim_config",
            "deformable",
            "reduced_deformable",
        )
    ),
    "link": frozenset(
        (
            *("contact", "audio_source", "self_collision_checking", "inertia_scaling"),
            "collision_checking",  # of pinocchio: names shapes that are capsules, or convex
        )
    ),
    "visual": frozenset(("meta",)),
    "collision": frozenset(("verbose", "contact_coefficients", "sdf")),
    "material": frozenset(("specular",)),
    "geometry": frozenset(("plane", "cdf", "ellipsoid", "cone", "torus", "convex")),
    "joint": frozenset(("hardwareInterface",)),
}
"""Elements that are not in URDF but in a reader's dialect; their contents are not checked."""

DIALECT_ATTRIBUTES: dict[str, frozenset[str]] = {
    "robot": frozenset(("xmlns",)),
    "link": frozenset(("concave", "drake_ignore")),
    "collision": frozenset(("concave", "group", "mask")),
    "joint": frozenset(("dont_collapse", "drake_ignore")),
    "limit": frozenset(("twist",)),
}
"""Attributes that are not in URDF but in a reader's dialect, by element.

Those of Drake 1.51.1 were run: it leaves out links and joints, but no shapes.
"""
