"""Merging of rigidly attached links into their parents: fewer bodies, every link frame as a site.

MuJoCo welds a body without a joint to its parent, but it still costs time in every step. The merged
body has the exact mass properties of its links and keeps the poses of their geometry, sensors and
frames. A body is not merged if something refers to it, if a force or touch sensor measures at it,
if a camera or light follows it, or if gravity acts differently on it and on its parent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from lxml import etree

from ...diagnostic import Severity
from ...mechanics.spatial_inertia import combine
from ...model.elements import Robot
from ...model.numbers import format_numbers_text
from ...model.pose import Pose, rotate
from ..common.naming import UniqueNames
from ..written import Written
from .body import Bodies
from .copied import list_native
from .frame import read_pose, read_position, set_pose
from .joint import SITE
from .link_inertia import LinkInertia, build_inertial_element
from .source_frames import list_anchors
from .structure import Structure

REFERENCES = ("body", "body1", "body2", "objname", "refname", "target")
"""Attributes that refer to a body."""

AT_BODY = ("force", "torque", "touch")
"""Sensors that measure between the body of their site and its parent, or on the whole body."""


def fuse_links(
    structure: Structure,
    bodies: Bodies,
    sections: Mapping[str, etree._Element],
    masses: Mapping[str, LinkInertia],
    written: Written,
) -> None:
    """Merge each link without a joint of its own into its parent, and keep its frame as a site."""
    kept = _get_kept(sections) | _list_followed(structure.robot, bodies)
    exclusions = _get_exclusions(sections.get("contact"))
    sites = UniqueNames(tuple(site.get("name", "") for site in sections["worldbody"].iter("site")))
    owner: dict[str, str] = {}
    contacts: dict[str, set[str]] = {}
    anchors = list_anchors(structure.robot)
    poses = {link: Pose(translation=anchor) for link, anchor in anchors.items()}
    for joint in structure.joints:
        link, body = joint.child, bodies[joint.child]
        parent = body.getparent()
        if structure.get_kind(joint) != "weld" or parent is None or parent.tag != "body":
            continue
        if body.get("name") in kept or body.get("gravcomp") != parent.get("gravcomp"):
            continue
        top = owner.get(joint.parent, joint.parent)
        if body.getparent() is not bodies[top]:
            continue
        if _collides(body):
            own = exclusions.get(body.get("name", ""), set())
            of_top = exclusions.get(bodies[top].get("name", ""), set())
            first = contacts.setdefault(top, of_top if _collides(bodies[top]) else own)
            if first != own:
                continue  # a merged body would exclude contacts that one of the links has
        owner[link] = top
        poses[link] = read_pose(body)  # those above it are merged already
        _merge(body, bodies[top], sites)
    groups: dict[str, list[str]] = {}
    for link, top in owner.items():
        groups.setdefault(top, [top]).append(link)
    for top, links in groups.items():
        _write_inertia(bodies[top], links, poses, masses)
    _rename_exclusions(sections.get("contact"), owner, bodies)
    if owner:
        written.report_loss(
            "fused",
            f"{len(owner)} links that are fixed to another are merged into it; their frames are "
            "sites of their names",
            structure.robot.place,
            severity=Severity.INFO,
        )
    for link, top in owner.items():
        bodies[link] = bodies[top]


def _get_kept(sections: Mapping[str, etree._Element]) -> set[str]:
    """Return the names of the bodies that something refers to or measures at."""
    names = {
        str(element.get(attribute))
        for name in ("equality", "sensor", "actuator")
        for element in (sections[name].iter(etree.Element) if name in sections else ())
        for attribute in REFERENCES
        if element.get(attribute)
    }
    sensors = sections.get("sensor")
    measured = {
        sensor.get("site") for sensor in (sensors if sensors is not None else ())
        if sensor.tag in AT_BODY
    }  # fmt: skip
    for site in sections["worldbody"].iter("site"):
        body = site.getparent()
        if site.get("name") in measured and body is not None:
            names.add(body.get("name", ""))
    return names


def _list_followed(robot: Robot, bodies: Bodies) -> set[str]:
    """Return the names of the bodies whose frame or mass a camera or light of an MJCF follows."""
    following = {(one.tag, one.name) for one in list_native(robot)
                 if one.attributes.get("mode", "fixed") != "fixed"}  # fmt: skip
    return {
        body.get("name", "")
        for body in bodies.values()
        for part in body.iterchildren("camera", "light")
        if (part.tag, part.get("name")) in following
    }


def _get_exclusions(contact: etree._Element | None) -> dict[str, set[str]]:
    """Return for each body in an exclusion the names of its partners."""
    found: dict[str, set[str]] = {}
    for exclude in contact if contact is not None else ():
        one, other = exclude.get("body1", ""), exclude.get("body2", "")
        found.setdefault(one, set()).add(other)
        found.setdefault(other, set()).add(one)
    return found


def _collides(body: etree._Element) -> bool:
    return any(geom.get("class") != "visual" for geom in body.iterchildren("geom"))


def _merge(body: etree._Element, into: etree._Element, sites: UniqueNames) -> None:
    """Move the content of a body into another body, keeping its pose."""
    at = read_pose(body)
    where = into.index(body)
    into.remove(body)
    name = body.get("name", "")
    frame = etree.Element("site", {"name": sites.take(name, f"{name}_frame"), **SITE})
    set_pose(frame, at)
    moved = [frame]
    for child in list(body):
        if child.tag == "inertial":
            continue
        if isinstance(child, etree._Comment):
            moved.append(child)
            continue
        if child.tag == "light" and child.get("dir"):
            way = rotate(at.rotation, read_position(child.get("dir")))
            child.set("dir", format_numbers_text(way))
        pose = at @ read_pose(child)
        for attribute in ("pos", "quat"):
            if attribute in child.attrib:
                del child.attrib[attribute]
        set_pose(child, pose)
        moved.append(child)
    parts = [element for element in moved if element.tag != "body"]
    below = [element for element in moved if element.tag == "body"]
    first = next((i for i, child in enumerate(into) if child.tag == "body"), len(into))
    for offset, element in enumerate(parts):
        into.insert(first + offset, element)
    for offset, element in enumerate(below):
        into.insert(max(where, first) + len(parts) + offset, element)


def _write_inertia(
    body: etree._Element,
    links: list[str],
    poses: Mapping[str, Pose],
    masses: Mapping[str, LinkInertia],
) -> None:
    """Write the combined mass properties of several links."""
    parts = [(masses[name], poses.get(name, Pose())) for name in links if name in masses]
    if not parts or (len(parts) == 1 and links[0] in masses):
        return
    whole = compute_composed(parts)
    for old in body.findall("inertial"):
        body.remove(old)
    comments = sum(1 for _ in _list_leading_comments(body))
    body.insert(comments, build_inertial_element(whole))


def compute_composed(parts: list[tuple[LinkInertia, Pose]]) -> LinkInertia:
    """Compute the mass properties of several links that form one rigid body.

    Args:
        parts: Mass properties of each link, with the link's pose in the frame of the whole.
    """
    whole = combine(read.body.transform(pose) for read, pose in parts)
    return LinkInertia(whole, parts[0][0].place)


def _list_leading_comments(body: etree._Element) -> Iterator[etree._Element]:
    for child in body:
        if not isinstance(child, etree._Comment):
            return
        yield child


def _rename_exclusions(
    contact: etree._Element | None, owner: Mapping[str, str], bodies: Bodies
) -> None:
    """Rename bodies in exclusions to those into which they were merged; remove duplicates."""
    if contact is None:
        return
    into = {bodies[link].get("name"): bodies[top].get("name") for link, top in owner.items()}
    seen = set()
    for exclude in list(contact):
        names = [into.get(exclude.get(key), exclude.get(key)) for key in ("body1", "body2")]
        pair = frozenset(names)
        if len(pair) < 2 or pair in seen:
            contact.remove(exclude)
            continue
        seen.add(pair)
        for key, name in zip(("body1", "body2"), names, strict=True):
            exclude.set(key, str(name))
