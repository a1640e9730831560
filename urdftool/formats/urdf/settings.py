"""Settings of links, collisions and joints as tags in ``<gazebo>``."""

from __future__ import annotations

from collections.abc import Iterable

from lxml import etree

from ...diagnostic import Severity
from ...model.block_elements import is_set_by_block, make_taking_name
from ...model.elements import Joint, Link, Robot
from ...model.kinematics import MOVABLE
from ...model.numbers import format_content
from ...model.settings import OF_JOINTS, OF_LINKS, OF_ROBOT, SURFACE, Setting, Settings
from ..common.naming import get_free_name
from .translation import Translation, add


def add_settings(t: Translation) -> None:
    """Add a block for each link and joint with settings; those of a URDF were copied with it."""
    if t.robot.xml is not None:
        return
    _add_block(t, t.robot, None, t.robot.settings, OF_ROBOT)
    for link in t.robot.links:
        _add_block(t, link, t.names.links[link.name], link.settings, OF_LINKS)
        common = _find_common(t, link)
        if _add_block(t, link, t.names.links[link.name], common, SURFACE):
            _rename_collisions(t, link)
    for joint in t.robot.joints:
        settings = joint.settings
        if joint.spring is not None and joint.type not in MOVABLE:
            text = f"the spring of joint '{joint.name}' is dropped: the joint has type {joint.type}"
            t.written.report_loss("spring", text, joint.place, kind="joint", name=joint.name)
            settings = {name: v for name, v in settings.items() if not name.startswith("spring")}
        _add_block(t, joint, t.names.joints[joint.name], settings, OF_JOINTS)


def _find_common(t: Translation, link: Link) -> Settings:
    """Return what all collisions of a link have; report what only some have."""
    surfaces = [collision.surface for collision in link.collisions]
    common: Settings = {}
    for row in SURFACE:
        values = [one[row.name] for one in surfaces if row.name in one]
        contents = {
            row.default if row.name not in one else one[row.name].content for one in surfaces
        }
        if len(contents) == 1 and values:
            common[row.name] = values[0]
        elif values:
            text = f"{row.name.replace('_', ' ')} of link '{link.name}' differs between its "
            text += "collisions; <gazebo> has one value for all of a link, so it is dropped"
            t.written.report_loss("surface", text, values[0].place, kind="link", name=link.name)
    return common


def _add_block(
    t: Translation,
    part: Link | Joint | Robot,
    name: str | None,
    settings: Settings,
    rows: Iterable[Setting],
) -> bool:
    """Add the block of a part, and tell whether there is one.

    A value that SDF has without being written adds nothing.
    """
    chosen = {r.name: settings[r.name].content for r in rows if r.name in settings}
    chosen = {r.name: chosen[r.name] for r in rows if chosen.get(r.name, r.default) != r.default}
    if not chosen:
        return False
    node = add(t.root, "gazebo", **({} if name is None else {"reference": name}))
    decay = {chosen.get("linear_decay"), chosen.get("angular_decay")}
    for row in rows:
        if row.name not in chosen:
            continue
        content = chosen[row.name]
        if row.opposite:
            add(node, row.opposite, format_content(not content))
        elif row.tags and (not row.name.endswith("_decay") or len(decay) == 1):
            if node.find(row.tags[0]) is None:
                add(node, row.tags[0], format_content(content))
        else:
            prefix = "collision/" if rows is SURFACE else ""
            _get_or_create(node, prefix + row.path).text = format_content(content)
    springs = [key for key in chosen if key.startswith("spring")]
    code, what = (
        ("gazebo-spring", "springs") if springs else ("gazebo-settings", "settings of links")
    )
    if isinstance(part, Joint) and not springs:
        what = "settings of joints"
    t.written.report_loss(
        code,
        f"{what} are in <gazebo>, which only Gazebo reads",
        settings[next(iter(chosen))].place,
        kind=type(part).__name__.lower(),
        name=part.name,
        severity=Severity.INFO,
    )
    return True


def _rename_collisions(t: Translation, link: Link) -> None:
    """Begin the names of the collisions of a link with its own; Gazebo ignores its block else."""
    new = t.names.links[link.name]
    for node in t.root.iterfind("link"):
        shapes = node.findall("collision") if node.get("name") == new else []
        taken = {shape.get("name") for shape in shapes}
        for shape in shapes:
            name = shape.get("name", "")
            if not is_set_by_block(name, new):
                shape.set("name", get_free_name(make_taking_name(name, new), taken))
                taken.add(shape.get("name"))
                text = f"collision '{name}' is named '{shape.get('name')}', so that Gazebo applies "
                text += f"the <gazebo> block of link '{new}' to it"
                t.written.report_loss(
                    "name", text, link.place, kind="link", name=link.name, severity=Severity.INFO
                )


def _get_or_create(node: etree._Element, path: str) -> etree._Element:
    for tag in path.split("/"):
        found = node.find(tag)
        node = etree.SubElement(node, tag) if found is None else found
    return node
