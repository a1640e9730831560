"""The elements of SRDF that srdfdom reads, with their attributes (``src/model.cpp``)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple


class SrdfElement(NamedTuple):
    """An element of SRDF.

    Attributes:
        required: Attributes without which srdfdom ignores the element.
        optional: The other attributes.
        children: The elements that it may contain, by tag.
    """

    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    children: Mapping[str, SrdfElement] = {}


_NAMED = SrdfElement(("name",))
_PAIR = SrdfElement(("link1", "link2"), ("reason",))

ROOT = SrdfElement(
    optional=("name", "version"),
    children={
        "virtual_joint": SrdfElement(("name", "child_link", "parent_frame", "type")),
        "group": SrdfElement(
            ("name",),
            children={
                "link": _NAMED,
                "joint": _NAMED,
                "chain": SrdfElement(("base_link", "tip_link")),
                "group": _NAMED,
            },
        ),
        "group_state": SrdfElement(
            ("name", "group"), children={"joint": SrdfElement(("name", "value"))}
        ),
        "end_effector": SrdfElement(("name", "group", "parent_link"), ("parent_group",)),
        "link_sphere_approximation": SrdfElement(
            ("link",), children={"sphere": SrdfElement(("center", "radius"))}
        ),
        "disable_default_collisions": SrdfElement(("link",)),
        "enable_collisions": _PAIR,
        "disable_collisions": _PAIR,
        "passive_joint": _NAMED,
        "joint_property": SrdfElement(("joint_name", "property_name", "value")),
    },
)
"""The element ``<robot>``; its name is that of the URDF."""

VIRTUAL_TYPES = ("fixed", "planar", "floating")
"""Types of a virtual joint."""
