"""Contents of ``<gazebo reference="…">`` blocks, by the link or joint that they refer to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ...model.block_elements import list_part_elements
from ...model.elements import Joint, Link
from ...model.numbers import format_content
from ...model.settings import (
    JOINT_TAGS,
    LINK_TAGS,
    LUMPING_TAGS,
    OF_JOINTS,
    OF_LINKS,
    Setting,
    Value,
)
from .body_sensors import is_body_sensor
from .copied_elements import copy_raw_element, remove_invalid
from .plugins import add_plugin
from .translation import Translation
from .xml import Node, append_copy, get_or_create, merge

ELSEWHERE = frozenset(("sensor", "visual", "collision", "material"))
"""Elements of a link's block that other modules handle."""

IGNORED = frozenset(("canonicalBody",))
"""Tags that Gazebo ignores, too."""


def write_settings(node: Node, settings: Mapping[str, Value], rows: Iterable[Setting]) -> None:
    """Write settings at their paths below a node."""
    for row in rows:
        if row.name in settings:
            text = format_content(settings[row.name].content)
            for path in filter(None, (row.path, row.also)):
                get_or_create(node, path).text = text


def merge_elements(node: Node, t: Translation, link: Link, tag: str) -> None:
    """Merge the ``<visual>`` or ``<collision>`` elements of a link's blocks into a node."""
    for element in list_part_elements(t.robot, link):
        if element.tag == tag:
            made = append_copy(node, element)
            remove_invalid(made, t, element, link)
            node.remove(made)
            merge(node, made)


def link_extensions(node: Node, t: Translation, link: Link) -> None:
    """Convert the settings of a link, except shapes, materials and sensors."""
    _report_untouchable(t, link)
    if t.plan.stays(link.name):
        write_settings(node, link.settings, OF_LINKS)
    else:
        _report_merged_flags(t, link)
    for element in list_part_elements(t.robot, link):
        tag = element.tag
        if tag == "plugin":
            if not is_body_sensor(t, element):
                add_plugin(node, t, element)
        elif tag in JOINT_TAGS | LUMPING_TAGS:
            if link.name not in t.robot.joint:
                text = f"<{tag}> is set for link '{link.name}', but applies to joints only"
                t.report_loss("extension", f"{text}; it is not exported", element, link)
        elif tag not in ELSEWHERE | LINK_TAGS | IGNORED:
            copy_raw_element(node, t, element, link)


def _report_merged_flags(t: Translation, link: Link) -> None:
    """Report the settings of a link that was merged into another."""
    for value in {id(value.provenance): value for value in link.settings.values()}.values():
        t.report_loss(
            "link-flag",
            f"<{value.tag}> is set for link '{link.name}', which was merged into "
            f"'{t.plan.owner[link.name]}'; it would apply to the whole link and is not exported",
            value,
            link,
            hint="keep the fixed joint with <preserveFixedJoint>true</preserveFixedJoint>",
        )


def convert_joint_extensions(node: Node, t: Translation, joint: Joint) -> None:
    """Convert the settings of a joint, except sensors."""
    for element in list_part_elements(t.robot, joint):
        tag = element.tag
        if tag == "plugin":
            if not is_body_sensor(t, element):
                add_plugin(node, t, element)
        elif tag not in JOINT_TAGS | LUMPING_TAGS | IGNORED | {"sensor"}:
            if joint.name in t.robot.link:
                continue  # it belongs to the link of the same name
            if tag in LINK_TAGS or tag in ELSEWHERE:
                text = (
                    f"<{tag}> is set for joint '{joint.name}', but applies to links only; it "
                    "is not exported"
                )
                t.report_loss("extension", text, element, joint)
            else:
                copy_raw_element(node, t, element, joint)
    rows = [row for row in OF_JOINTS if row.name in joint.settings]
    turning = node.find("axis") is not None
    write_settings(node, joint.settings, [r for r in rows if turning or not _is_of_axis(r)])
    for row in [row for row in rows if not turning and _is_of_axis(row)]:
        value = joint.settings[row.name]
        what = f"<{value.tag}>" if value.xml is not None else row.name.replace("_", " ")
        text = f"{what} is set for joint '{joint.name}', which has no axis"
        t.report_loss("extension", f"{text}; it is not exported", value, joint)


def _is_of_axis(row: Setting) -> bool:
    return row.path.startswith("axis/")


def report_dissolved_joint(t: Translation, joint: Joint) -> None:
    """Report the settings that are lost with a dissolved joint."""
    lost = [e for e in list_part_elements(t.robot, joint) if e.tag not in LUMPING_TAGS | IGNORED]
    if lost and joint.name not in t.robot.link:
        tags = ", ".join(dict.fromkeys(f"<{e.tag}>" for e in lost))
        t.report_loss(
            "joint-extension",
            f"fixed joint '{joint.name}' became a frame, so {tags} set for it is not exported",
            lost[0],
            joint,
            hint="keep the joint with <preserveFixedJoint>true</preserveFixedJoint>",
        )


def _report_untouchable(t: Translation, link: Link) -> None:
    """Report contact values of a link without collisions, which have no effect."""
    if link.collisions:
        return
    for name, value in link.surface.items():
        if name != "laser_retro":
            text = f"link '{link.name}' has no collision, so its <{value.tag}> has no effect"
            t.report_note("contact", text, value, link)
            return
