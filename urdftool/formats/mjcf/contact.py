"""Contact exclusions.

MuJoCo does not collide geoms of one rigid body, nor those of a body and its parent body, unless the
parent is static. URDF engines ignore a link and its parent in that case too, so these pairs are
excluded, in addition to the pairs that a loop-closing joint connects or an SRDF disables.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from lxml import etree

from ...model.mechanism import ContactExclusion
from .loops import list_loops
from .options import Exclude
from .structure import Structure


def plan_exclusions(
    structure: Structure, disabled: Iterable[tuple[str, str]], exclude: Exclude
) -> list[ContactExclusion]:
    """List the pairs of links that must be excluded from contact."""
    given = [(pair.link, pair.other) for pair in structure.robot.exclusions]
    joined = []
    if exclude != "none" and structure.robot.format != "mjcf":  # which has its own pairs
        given += _pair_beside_the_world(structure)
        joined = [(loop.parent, loop.child) for loop in list_loops(structure)]
    filtered = set(map(frozenset, given))
    for pair in (*joined, *disabled):
        if frozenset(pair) not in filtered and _can_collide(structure, *pair):
            filtered.add(frozenset(pair))
            given.append(pair)
    return [ContactExclusion(None, one, other) for one, other in given]


def build_contact_section(
    structure: Structure, proofs: Mapping[frozenset[str], str]
) -> etree._Element | None:
    """Build ``<contact>`` with the exclusions of a robot; None if it has none."""
    if not structure.robot.exclusions:
        return None
    section = etree.Element("contact")
    for pair in structure.robot.exclusions:
        body1, body2 = (
            structure.get_body_name(name) if name in structure.robot.link else name
            for name in (pair.link, pair.other)
        )
        if proof := proofs.get(frozenset((pair.link, pair.other))):
            section.append(etree.Comment(f" {proof} "))
        etree.SubElement(section, "exclude", body1=body1, body2=body2)
    return section


def _list_touching(structure: Structure, top: str) -> list[str]:
    """Return the links of a rigid body that have collision geometry."""
    return [link.name for link in structure.members[top] if link.collisions]


def _pair_beside_the_world(structure: Structure) -> list[tuple[str, str]]:
    """Pair the static links with the links of the moving bodies attached to them."""
    if structure.free:
        return []
    pairs = []
    root = structure.root.name
    for joint in structure.moving:
        if structure.group[joint.parent] != root or structure.get_kind(joint) == "free":
            continue
        for held in _list_touching(structure, root):
            for moving in _list_touching(structure, joint.child):
                pairs.append((held, moving))
    return pairs


def _can_collide(structure: Structure, one: str, other: str) -> bool:
    """Tell whether two links would collide in MuJoCo without an exclusion."""
    if one not in structure.group or other not in structure.group:
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
    return all(structure.robot.link[name].collisions for name in (one, other))
