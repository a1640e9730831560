"""SRDF of an export to URDF: excluded contacts, named joint positions, base."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from ...model.elements import BALL_TYPES
from ...model.numbers import number_text
from ..common.unexpressed import list_link_exclusions
from .translation import Translation, add

_GROUP = "robot"


def make_srdf(t: Translation) -> etree._Element | None:
    """Return an SRDF with what URDF has no place for; None without such content."""
    robot = t.robot
    if not (robot.exclusions or robot.configurations):
        return None
    if not t.options.srdf:
        for code, text, parts in (
            ("exclusion", "excluded contacts", robot.exclusions),
            ("configuration", "named joint positions", robot.configurations),
        ):
            if parts:
                text = f"{text} are dropped, since they require an SRDF file; write with -o OUT"
                t.written.report_loss(
                    code, f"{text}: {len(parts)}", parts[0].place, kind="robot", name=robot.name
                )
        return None
    root = etree.Element("robot", name=robot.name or "robot")
    _add_states(t, root)
    _add_base(t, root)
    for one, other, reason in _list_pairs(t):
        names = {"link1": t.names.links[one], "link2": t.names.links[other], "reason": reason}
        add(root, "disable_collisions", **names)
    return root


def _add_states(t: Translation, root: etree._Element) -> None:
    if not t.robot.configurations:
        return
    movable = {
        joint.name: t.names.joints[joint.name]
        for joint in t.robot.joints
        if joint.type in ("revolute", "continuous", "prismatic", "screw") and joint.mimic is None
    }
    group = add(root, "group", name=_GROUP)
    for name in movable.values():
        add(group, "joint", name=name)
    for configuration in t.robot.configurations:
        state = add(root, "group_state", name=configuration.name, group=_GROUP)
        for joint, value in configuration.positions.items():
            if joint in movable:
                add(state, "joint", name=movable[joint], value=number_text(value))
    if any(joint.type in BALL_TYPES for joint in t.robot.joints):
        t.written.report_loss(
            "configuration",
            "positions of ball joints are dropped from named joint positions",
            t.robot.configurations[0].place,
            kind="robot",
            name=t.robot.name,
        )


def _add_base(t: Translation, root: etree._Element) -> None:
    base = t.robot.base
    roots = t.robot.tree.roots
    name = roots[0].name if len(roots) == 1 else None
    if base is None or name is None:
        return
    kind = "floating" if base.is_free else "fixed"
    add(
        root,
        "virtual_joint",
        name="virtual_joint",
        type=kind,
        parent_frame="world",
        child_link=t.names.links.get(name, name),
    )


def _list_pairs(t: Translation) -> Iterator[tuple[str, str, str]]:
    """Yield pairs of links without contact, and the reason in SRDF.

    MuJoCo computes no contacts between a body and its parent, which readers of SRDF would.
    """
    robot = t.robot
    named = {frozenset((pair.link, pair.other)) for pair in robot.exclusions}
    for pair in list_link_exclusions(robot, t.written):
        yield pair.link, pair.other, "User"
    if robot.format != "mjcf":
        return
    above = {joint.child: joint.parent for joint in robot.joints}
    for child in above:
        parent = above[child]
        while parent in above and robot.link[parent].is_virtual:
            parent = above[parent]
        shapes = robot.link[child].collisions and robot.link[parent].collisions
        if shapes and frozenset((parent, child)) not in named:
            yield parent, child, "Adjacent"
