"""Sensors of a floating base that control policies read, added where the description has none."""

from __future__ import annotations

from lxml import etree

from ..common.naming import UniqueNames
from ..written import Written
from .body import Bodies
from .joint import SITE
from .sensor import create_site_sensor, put_before_bodies
from .structure import Structure

KINDS = (
    ("framelinvel", "_linear_velocity"),
    ("gyro", "_gyro"),
    ("accelerometer", "_accelerometer"),
    ("framequat", "_orientation"),
)
"""Sensor types, with the suffix of their names after the link's name."""


def add_base_sensors(
    structure: Structure, bodies: Bodies, section: etree._Element | None, written: Written
) -> etree._Element | None:
    """Add missing sensors to the rigid body of a floating base, in the frame of its link.

    Args:
        structure: The kinematic tree.
        bodies: Body of each link; the base's gets a site.
        section: ``<sensor>``, if there is one.
        written: Receives advice if the base is fixed.

    Returns:
        ``<sensor>``, or None if it is empty.
    """
    base = _get_free_link(structure)
    if base is None:
        written.advice.append("--base-sensors adds nothing: the base is fixed")
        return section
    section = etree.Element("sensor") if section is None else section
    here = {
        site.get("name")
        for link in structure.members[structure.group[base]]
        for site in bodies[link.name].iterchildren("site")
    }
    there = {
        sensor.tag for sensor in section if (sensor.get("site") or sensor.get("objname")) in here
    }
    wanted = [(kind, suffix) for kind, suffix in KINDS if kind not in there]
    if wanted:
        sites = UniqueNames(
            s.get("name", "") for body in bodies.values() for s in body.iterchildren("site")
        )
        site = etree.Element("site", {"name": sites.take(f"{base}_imu"), **SITE})
        put_before_bodies(bodies[base], site)
        names = UniqueNames(sensor.get("name", "") for sensor in section)
        for kind, suffix in wanted:
            section.append(
                create_site_sensor(kind, names.take(base + suffix), site.get("name", ""))
            )
    return section


def _get_free_link(structure: Structure) -> str | None:
    """Return the link of a floating base: the root, or the one floating link below a world root."""
    if structure.free:
        return structure.root.name
    floating = [j.child for j in structure.moving if structure.get_kind(j) == "free"]
    return floating[0] if structure.in_world and len(floating) == 1 else None
