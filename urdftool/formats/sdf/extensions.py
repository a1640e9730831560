"""Contents of ``<gazebo reference="…">`` blocks, by the link or joint that they refer to."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Joint, Link, Robot
from ...model.read import number, parse_numbers
from ...rules.gazebo.block_values import (
    describe_required_keyword_value,
    get_kind,
    get_value,
    is_value_of_kind,
)
from ...rules.gazebo.keywords import is_true
from ...source.document import Element
from ..common.numbers import format_numbers_text, number_text
from .body_sensors import is_body_sensor
from .keywords import (
    COLLISION_KEYWORDS,
    IGNORED,
    JOINT_KEYWORDS,
    LINK_ELEMENTS,
    LINK_KEYWORDS,
    LUMPING_KEYWORDS,
    Keyword,
)
from .plugins import add_plugin
from .raw_sdf import copy_raw_element, remove_invalid
from .translation import Translation
from .xml import Node, add, append_copy, get_or_create, merge

ELSEWHERE = frozenset(("sensor", "visual", "collision", "material"))
"""Elements of a link's block that other modules handle."""


def block_elements(robot: Robot, part: Link | Joint) -> Iterator[Element]:
    """Yield the elements in the blocks of a link or joint, in file order.

    If a link and a joint share a name, each gets the elements of its kind, and the link those of
    both kinds.
    """
    shared = part.name in robot.link and part.name in robot.joint
    for block in robot.extensions.get(part.name, []):
        for element in block.element.children:
            if not shared or _is_of_joint(element) == isinstance(part, Joint):
                yield element


def _is_of_joint(element: Element) -> bool:
    if element.tag == "sensor":
        return (element.get("type") or "").strip() == "force_torque"
    return element.tag in JOINT_KEYWORDS or element.tag in LUMPING_KEYWORDS


def list_values(t: Translation, part: Link | Joint, table: dict[str, Keyword]) -> dict[str, str]:
    """Return the values of a table's tags for a link or joint; the last of each tag counts."""
    found: dict[str, str] = {}
    for element in block_elements(t.robot, part):
        if element.tag in table:
            text = read_value(get_kind(element.tag), get_value(element))
            if text is not None:
                found[element.tag] = text
    return found


def merge_elements(node: Node, t: Translation, link: Link, tag: str) -> None:
    """Merge the ``<visual>`` or ``<collision>`` elements of a link's blocks into a node."""
    for element in block_elements(t.robot, link):
        if element.tag == tag:
            made = append_copy(node, element)
            remove_invalid(made, t, element, link)
            node.remove(made)
            merge(node, made)


def link_extensions(node: Node, t: Translation, link: Link) -> None:
    """Convert the settings of a link, except shapes, materials and sensors."""
    _report_repeated(t, link, {**COLLISION_KEYWORDS, **LINK_KEYWORDS})
    _report_untouchable(t, link)
    own = t.plan.stays(link.name)
    flags = list_values(t, link, LINK_KEYWORDS)
    if own:
        for tag, text in flags.items():
            _set_flag(node, tag, text)
    for element in block_elements(t.robot, link):
        tag = element.tag
        if tag in LINK_ELEMENTS and own:
            existing = node.find(tag)
            if copy_raw_element(node, t, element, link) is not None and existing is not None:
                node.remove(existing)
        elif tag in LINK_ELEMENTS or tag in LINK_KEYWORDS:
            if not own:
                t.report_loss(
                    "link-flag",
                    f"<{tag}> is set for link '{link.name}', which was merged into "
                    f"'{t.plan.owner[link.name]}'; it would apply to the whole link and is not "
                    "exported",
                    element,
                    link,
                    hint="keep the fixed joint with <preserveFixedJoint>true</preserveFixedJoint>",
                )
        elif tag == "plugin":
            if not is_body_sensor(t, element):
                add_plugin(node, t, element)
        elif tag in JOINT_KEYWORDS or tag in LUMPING_KEYWORDS:
            if link.name not in t.robot.joint:
                text = f"<{tag}> is set for link '{link.name}', but applies to joints only"
                t.report_loss("extension", f"{text}; it is not exported", element, link)
        elif tag not in ELSEWHERE and tag not in COLLISION_KEYWORDS and tag not in IGNORED:
            copy_raw_element(node, t, element, link)


def _set_flag(node: Node, tag: str, text: str) -> None:
    if tag == "turnGravityOff":
        text = "false" if text == "true" else "true"
    if tag == "dampingFactor":
        decay = add(node, "velocity_decay")
        add(decay, "linear", text)
        add(decay, "angular", text)
    else:
        add(node, LINK_KEYWORDS[tag].path, text)


def convert_joint_extensions(node: Node, t: Translation, joint: Joint) -> None:
    """Convert the settings of a joint, except sensors."""
    _report_repeated(t, joint, JOINT_KEYWORDS)
    for tag, text in list_values(t, joint, JOINT_KEYWORDS).items():
        path, also = JOINT_KEYWORDS[tag].path, JOINT_KEYWORDS[tag].also
        if path.startswith("axis/") and node.find("axis") is None:
            text = f"<{tag}> is set for joint '{joint.name}', which has no axis; it is not exported"
            t.report_loss("extension", text, t.robot.extensions[joint.name][0], joint)
            continue
        get_or_create(node, path).text = text
        if also:
            get_or_create(node, also).text = text
    for element in block_elements(t.robot, joint):
        tag = element.tag
        if tag == "plugin":
            if not is_body_sensor(t, element):
                add_plugin(node, t, element)
        elif tag not in JOINT_KEYWORDS and tag not in (*LUMPING_KEYWORDS, *IGNORED, "sensor"):
            if joint.name in t.robot.link:
                continue  # it belongs to the link of the same name
            if tag in COLLISION_KEYWORDS or tag in LINK_KEYWORDS or tag in ELSEWHERE:
                text = (
                    f"<{tag}> is set for joint '{joint.name}', but applies to links only; it "
                    "is not exported"
                )
                t.report_loss("extension", text, element, joint)
            else:
                copy_raw_element(node, t, element, joint)


def report_dissolved_joint(t: Translation, joint: Joint) -> None:
    """Report the settings that are lost with a dissolved joint."""
    lost = [e for e in block_elements(t.robot, joint) if e.tag not in (*LUMPING_KEYWORDS, *IGNORED)]
    if lost and joint.name not in t.robot.link:
        tags = ", ".join(dict.fromkeys(f"<{e.tag}>" for e in lost))
        t.report_loss(
            "joint-extension",
            f"fixed joint '{joint.name}' became a frame, so {tags} set for it is not exported",
            lost[0],
            joint,
            hint="keep the joint with <preserveFixedJoint>true</preserveFixedJoint>",
        )


def _report_repeated(t: Translation, part: Link | Joint, table: dict[str, Keyword]) -> None:
    seen: dict[str, str] = {}
    for element in block_elements(t.robot, part):
        if element.tag not in table:
            continue
        text = read_value(get_kind(element.tag), get_value(element))
        if text is None:
            t.report_loss(
                "extension",
                f"<{element.tag}> of '{part.name}' is '{get_value(element)}', not "
                f"{describe_required_keyword_value(element)}; it is not exported",
                element,
                part,
            )
            continue
        if seen.get(element.tag, text) != text:
            t.report_loss(
                "repeated",
                f"<{element.tag}> of '{part.name}' is set twice; the last, {text}, is used",
                element,
                part,
            )
        seen[element.tag] = text


def _report_untouchable(t: Translation, link: Link) -> None:
    """Report contact values of a link without collisions, which have no effect."""
    given = list_values(t, link, COLLISION_KEYWORDS)
    given.pop("laserRetro", None)
    if given and not link.collisions:
        first = next(e for e in block_elements(t.robot, link) if e.tag in given)
        text = f"link '{link.name}' has no collision, so its {', '.join(given)} have no effect"
        t.report_note("contact", text, first, link)


def read_value(kind: str, text: str) -> str | None:
    """Return the text of a value, or None if it is not of the kind.

    Args:
        kind: The kind: ``number``, ``count``, ``vector`` (3 numbers) or ``flag``.
        text: The text of the source.
    """
    if not is_value_of_kind(kind, text):
        return None
    if kind == "flag":
        return "true" if is_true(text) else "false"
    if kind == "vector":
        return format_numbers_text(parse_numbers(text, 3) or ())
    return number_text(number(text) or 0.0)
