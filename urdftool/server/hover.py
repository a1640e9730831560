"""Hover: values of expressions in each expansion, links, joints, and elements of URDF."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

from ..listing import list_first
from ..model.elements import Joint, Link, Robot
from ..model.urdf_schema import VOCABULARY
from ..source.document import Element
from ..source.location import Call
from .actions import find_innermost
from .knowledge import Knowledge, make_path
from .terms import ATTRIBUTES, ELEMENTS

MOST_VALUES = 12
"""Values that one hover lists; chosen: its window shows about twenty lines."""


def describe_position(knowledge: Knowledge, params: dict[str, Any]) -> dict[str, Any] | None:
    """Return what is known of a position, as Markdown with its range; None for nothing."""
    path, offset = make_path(params["path"]), knowledge.get_offset(params)
    document = knowledge.parse(path)
    element = None if document is None else find_innermost(document.root, offset)
    if element is None or offset >= element.file.find_tag_end(element.start):
        return None
    name, (start, end) = find_attribute(element, offset)
    parts = list(_describe(knowledge, path, element, name))
    if not parts:
        return None
    span = knowledge.make_table(element.file).get_range(start, end)
    return {"contents": {"kind": "markdown", "value": "\n\n".join(parts)}, "range": span}


def find_attribute(element: Element, offset: int) -> tuple[str, tuple[int, int]]:
    """Return the attribute at a byte of a start tag, and its span; the tag's for none."""
    for name, (start, end) in element.file.locate_attributes(element.start).items():
        if start <= offset < end:
            return name, (start, end)
    return "", (element.start, element.file.find_tag_end(element.start))


def _describe(knowledge: Knowledge, path: str, element: Element, name: str) -> Iterator[str]:
    written = element.get(name) or "" if name else ""
    instances = _list_instances(knowledge, path, element)
    if name and ("${" in written or "$(" in written):
        title = f"`{name}` in {len(instances)} expansion{'s' * (len(instances) != 1)}"
        if element.tag.startswith("xacro:"):
            title = f"`{name}`"
            calls = [arguments for _, arguments in _list_calls(knowledge, path, element)]
            values = [(dict(arguments)[name], "") for arguments in calls if name in dict(arguments)]
        else:
            values = [(made.get(name) or "", _format_calls(made.calls)) for made, _ in instances]
            if not values:
                yield f"`{name}`: no robot that was read expands this element"
        if values:
            yield _describe_values(title, values)
    if not name and element.tag.startswith("xacro:"):
        yield from _describe_call(knowledge, path, element)
    yield from _describe_objects(instances, element, name)
    yield from _describe_vocabulary(element, name)


def _list_instances(
    knowledge: Knowledge, path: str, element: Element
) -> list[tuple[Element, Robot]]:
    """Return the elements of robots that an element of the source became."""
    found = []
    for description, robot in knowledge.list_descriptions(path):
        for made in description.document.root.walk():
            if made.start == element.start and make_path(made.file.path) == path:
                found.append((made, robot))
    return found


def _describe_values(title: str, found: list[tuple[str, str]]) -> str:
    """Return the values of an attribute below a title, each with the calls that give it."""
    values: dict[str, list[str]] = {}
    for value, calls in found:
        values.setdefault(value, []).append(calls)
    lines = []
    for value, all_calls in list(values.items())[:MOST_VALUES]:
        shown = [call for call in dict.fromkeys(all_calls) if call]
        lines.append(f"- `{value}`" + (f": {list_first(shown, 2)}" if shown else ""))
    if len(values) > MOST_VALUES:
        lines.append(f"- … {len(values) - MOST_VALUES} more values")
    return f"{title}:\n\n" + "\n".join(lines)


def _format_calls(calls: tuple[Call, ...]) -> str:
    macros = [call for call in calls if call.macro]
    return " in ".join(f"{call.what} ({_format_place(call)})" for call in macros[:2])


def _format_place(call: Call) -> str:
    return f"{os.path.basename(call.file.path)}:{call.line}"


def _list_calls(
    knowledge: Knowledge, path: str, element: Element
) -> list[tuple[str, tuple[tuple[str, str], ...]]]:
    """Return macro and arguments of each expansion of a call in the source."""
    found: dict[Call, None] = {}
    for description, _ in knowledge.list_descriptions(path):
        for made in description.document.root.walk():
            for call in made.calls:
                if call.start == element.start and make_path(call.file.path) == path and call.macro:
                    found[call] = None
    return [(call.macro, call.arguments) for call in found]


def _describe_call(knowledge: Knowledge, path: str, element: Element) -> Iterator[str]:
    """Yield the arguments that a call of a macro passes, in each of its expansions."""
    calls = dict.fromkeys(_list_calls(knowledge, path, element))
    for macro, arguments in list(calls)[:MOST_VALUES]:
        values = "\n".join(f"- {key} = `{value}`" for key, value in arguments)
        yield f"macro **{macro}**\n\n{values}" if values else f"macro **{macro}**"


def _describe_objects(
    instances: list[tuple[Element, Robot]], element: Element, name: str
) -> Iterator[str]:
    """Yield what links and joints are, of an element itself or of the name that it refers to."""
    told: dict[str, None] = {}
    for made, robot in instances[:MOST_VALUES]:
        if made.tag in ("link", "joint") and name in ("", "name"):
            told.update(dict.fromkeys(_describe_named(robot, made.tag, made.get("name") or "")))
        elif name == "link" or (made.tag == "mimic" and name == "joint"):
            told.update(dict.fromkeys(_describe_named(robot, name, made.get(name) or "")))
    yield from told


def _describe_named(robot: Robot, kind: str, name: str) -> Iterator[str]:
    if kind == "link" and name in robot.link:
        yield _describe_link(robot, robot.link[name])
    elif kind == "joint" and name in robot.joint:
        yield _describe_joint(robot.joint[name])


def _describe_link(robot: Robot, link: Link) -> str:
    joint = robot.tree.get_parent_joint(link.name)
    above = f"child of `{joint.parent}` by joint `{joint.name}`" if joint else "root"
    children = robot.tree.get_child_joints(link.name)
    mass = link.inertial.mass if link.inertial is not None else None
    lines = [
        f"link **{link.name}**: {above}",
        f"- mass: {'not written' if mass is None else f'{mass:g} kg'}",
        f"- visual geometry: {len(link.visuals)}, collision geometry: {len(link.collisions)}",
    ]
    if children:
        names = ", ".join(f"`{child.child}`" for child in children[:MOST_VALUES])
        lines.append(f"- children: {names}" + (" …" if len(children) > MOST_VALUES else ""))
    return lines[0] + "\n\n" + "\n".join(lines[1:])


def _describe_joint(joint: Joint) -> str:
    unit = "m" if joint.type == "prismatic" else "rad"
    lines = [f"joint **{joint.name}** ({joint.type}): `{joint.parent}` → `{joint.child}`\n"]
    if joint.axis is not None and joint.has_axis:
        lines.append(f"- axis: {' '.join(f'{number:g}' for number in joint.axis.xyz)}")
    limit = joint.limit
    if limit is not None:
        units = {"lower": unit, "upper": unit, "velocity": f"{unit}/s"}
        units["effort"] = "N" if unit == "m" else "N·m"
        for key, unit_of in units.items():
            value = getattr(limit, key)
            if value is not None:
                lines.append(f"- {key}: {value:g} {unit_of}")
    if joint.mimic is not None:
        mimic = joint.mimic
        lines.append(f"- mimics `{mimic.joint}` × {mimic.multiplier:g} + {mimic.offset:g}")
    return "\n".join(lines)


def _describe_vocabulary(element: Element, name: str) -> Iterator[str]:
    """Yield what an element or attribute of URDF is."""
    known = VOCABULARY.get(element.tag)
    if known is None:
        return
    if name:
        meaning = ATTRIBUTES.get((element.tag, name))
        if meaning:
            yield f"`{name}` of `<{element.tag}>`: {meaning}"
        return
    attributes = [*known.numbers, *known.words]
    lines = [f"`<{element.tag}>`: {ELEMENTS.get(element.tag, 'element of URDF')}"]
    if attributes:
        lines.append("- attributes: " + ", ".join(f"`{one}`" for one in attributes))
    if known.children:
        lines.append("- elements: " + ", ".join(f"`{one}`" for one in known.children))
    yield lines[0] + "\n\n" + "\n".join(lines[1:]) if len(lines) > 1 else lines[0]
