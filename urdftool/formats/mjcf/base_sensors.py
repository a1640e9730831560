"""Sensors of a free base that every policy reads, where the description has none."""

from __future__ import annotations

from lxml import etree

from ..common.naming import UniqueNames
from ..written import Written
from .body import Bodies
from .joint import SITE
from .sensor import put_before_bodies, site_sensor
from .structure import Structure

KINDS = (
    ("framelinvel", "_linear_velocity"),
    ("gyro", "_gyro"),
    ("accelerometer", "_accelerometer"),
    ("framequat", "_orientation"),
)
"""The sensors, with what follows the link's name in theirs."""


def add_base_sensors(
    structure: Structure, bodies: Bodies, section: etree._Element | None, written: Written
) -> etree._Element | None:
    """Add the sensors that the rigid body of a free base does not have, at its link's frame.

    Args:
        structure: The tree.
        bodies: The body of each link; the base's takes a site.
        section: ``<sensor>``, if there is one.
        written: Takes the advice where the base is not free.

    Returns:
        ``<sensor>``, or None where nothing is measured.
    """
    base = _free_link(structure)
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
            section.append(site_sensor(kind, names.take(base + suffix), site.get("name", "")))
    return section


def _free_link(structure: Structure) -> str | None:
    """The link of a free base: the root, or what floats below a root that is the world."""
    if structure.free:
        return structure.root.name
    floating = [j.child for j in structure.moving if structure.kind(j) == "free"]
    return floating[0] if structure.in_world and len(floating) == 1 else None
