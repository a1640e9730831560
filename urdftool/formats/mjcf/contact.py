"""Contact exclusions.

MuJoCo does not collide geoms of one rigid body, nor those of a body and its parent body, unless the
parent is static. URDF engines ignore a link and its parent in that case too, so these pairs are
excluded, in addition to the pairs that a loop-closing joint connects or an SRDF disables.
"""

from __future__ import annotations

from lxml import etree

from ..common.srdf import Srdf
from .body import Bodies
from .loops import list_loops
from .options import Exclude
from .structure import Structure


def build_contact_section(
    structure: Structure, bodies: Bodies, srdf: Srdf | None, exclude: Exclude
) -> etree._Element | None:
    """Build ``<contact>``, or return None if no pair is excluded."""
    pairs = _pair_beside_the_world(structure, bodies) if exclude != "none" else []
    filtered = set(map(frozenset, pairs))
    joined = (
        [(loop.parent, loop.child) for loop in list_loops(structure)] if exclude != "none" else []
    )
    for one, other in (*joined, *(srdf.disabled if srdf is not None else ())):
        pair = frozenset((one, other))
        if pair in filtered or not _can_collide(structure, bodies, one, other):
            continue
        filtered.add(pair)
        pairs.append((one, other))
    if not pairs:
        return None
    section = etree.Element("contact")
    for one, other in pairs:
        etree.SubElement(section, "exclude", body1=_name(bodies, one), body2=_name(bodies, other))
    return section


def _get_touching(structure: Structure, bodies: Bodies, top: str) -> list[str]:
    """Return the links of a rigid body that have a collision geom."""
    return [
        link.name
        for link in structure.members[top]
        if any(geom.get("class") == "collision" for geom in bodies[link.name].iterchildren("geom"))
    ]


def _pair_beside_the_world(structure: Structure, bodies: Bodies) -> list[tuple[str, str]]:
    """Pair the static links with the links of the moving bodies attached to them."""
    if structure.free:
        return []
    pairs = []
    root = structure.root.name
    for joint in structure.moving:
        if structure.group[joint.parent] != root or structure.get_kind(joint) == "free":
            continue
        for held in _get_touching(structure, bodies, root):
            for moving in _get_touching(structure, bodies, joint.child):
                pairs.append((held, moving))
    return pairs


def _can_collide(structure: Structure, bodies: Bodies, one: str, other: str) -> bool:
    """Tell whether two links would collide in MuJoCo without an exclusion."""
    if one not in bodies or other not in bodies:
        return False
    tops = structure.group[one], structure.group[other]
    if tops[0] == tops[1]:
        return False
    for top, neighbour in (tops, tops[::-1]):
        joint = structure.robot.tree.get_parent_joint(top)
        if joint is None or structure.get_kind(joint) == "free":
            continue
        if structure.group[joint.parent] == neighbour and not structure.is_static(joint.parent):
            return False
    return all(
        name in _get_touching(structure, bodies, structure.group[name]) for name in (one, other)
    )


def _name(bodies: Bodies, link: str) -> str:
    return bodies[link].get("name") or "world"
