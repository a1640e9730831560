"""Conversion of links to ``<link>``, with the content of the links that they own."""

from __future__ import annotations

from ...model.elements import Link
from .collisions import collision
from .extensions import link_extensions
from .frames import place
from .inertials import inertial
from .sensors import sensors
from .shape_names import shape_names
from .translation import Translation
from .visuals import visual
from .xml import Node, add


def link(model: Node, t: Translation, part: Link) -> None:
    """Add a link that stays a body."""
    node = add(model, "link", name=t.names.link(part.name))
    place(node, t, t.robot.tree.parent_joint(part.name))
    inertial(node, t, part)
    members = [t.robot.link[name] for name in t.plan.members[part.name]]
    names = shape_names(members)
    for member in members:
        for one in member.visuals:
            visual(node, t, member, one, names[id(one)])
    for member in members:
        for two in member.collisions:
            collision(node, t, member, two, names[id(two)])
    for member in members:
        sensors(node, t, member)
    for member in members:
        link_extensions(node, t, member)
