"""Conversion of links to ``<link>``, with the content of the links that they own."""

from __future__ import annotations

from ...model.elements import Link
from .collisions import add_collision
from .extensions import link_extensions
from .frames import place
from .inertials import add_inertial
from .sensors import add_sensors
from .shape_names import choose_shape_names
from .translation import Translation
from .visuals import add_visual
from .xml import Node, add


def link(model: Node, t: Translation, part: Link) -> None:
    """Add a link that stays a body."""
    node = add(model, "link", name=t.names.link(part.name))
    place(node, t, t.robot.tree.get_parent_joint(part.name))
    add_inertial(node, t, part)
    members = [t.robot.link[name] for name in t.plan.members[part.name]]
    names = choose_shape_names(members)
    for member in members:
        for one in member.visuals:
            add_visual(node, t, member, one, names[id(one)])
    for member in members:
        for two in member.collisions:
            add_collision(node, t, member, two, names[id(two)])
    for member in members:
        add_sensors(node, t, member)
    for member in members:
        link_extensions(node, t, member)
