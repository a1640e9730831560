"""Ways to use a description within a new xacro file, with a prefix and at a parent link."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path

from ..model.elements import Robot
from ..model.world import WORLD
from ..source.description import Description
from ..source.document import Element, parse
from ..source.edit import Edit, read_literal
from ..source.location import SourceFile
from ..source.xacro_names import TAGS
from .draft import TextDraft

_PARENTS = ("parent", "parent_link", "parent_frame", "connected_to", "attach_to")
"""Names of macro parameters and xacro arguments for the link to which a part is fixed.

Those of the packages of ros2_control_demos, UR, Robotiq (``parent``) and Franka (``connected_to``).
"""


@dataclass(frozen=True)
class Wish:
    """What a description must become.

    Attributes:
        prefix: Prefix of all its names; empty for none.
        parent: Link to which it is fixed in place of its own empty world; empty for its own root.
        origin: Attributes of ``<origin>`` of that joint.
    """

    prefix: str = ""
    parent: str = ""
    origin: str = ""


@dataclass
class Inclusion:
    """Lines that use a description.

    Attributes:
        what: How, for messages.
        given: Values of xacro arguments that are written before all lines.
        arguments: Values as written of all arguments that its files declare.
        lines: The lines.
        namespaces: Attributes of the root that the lines may need.
        is_call: Whether the lines are those of the file, with its macro calls.
    """

    what: str
    given: dict[str, str]
    arguments: dict[str, str]
    lines: list[str]
    namespaces: dict[str, str] = field(default_factory=dict)
    is_call: bool = False


Refer = Callable[[Path], str]
"""Function that returns what ``<xacro:include>`` writes for a file."""


def list_inclusions(robot: Robot, wish: Wish, refer: Refer) -> Iterator[Inclusion]:
    """Yield the ways to use a description: it is included, or its macros are called."""
    description = robot.source
    assert description is not None
    yield from _include(robot, description, wish, refer)
    if description.expansion is not None and (wish.prefix or wish.parent):
        yield from _call_macros(robot, description, wish, refer)


def _include(
    robot: Robot, description: Description, wish: Wish, refer: Refer
) -> Iterator[Inclusion]:
    """Yield inclusions with every argument that may be the prefix and the parent."""
    arguments = _list_arguments(description)
    line = f'<xacro:include filename="{quote(refer(Path(description.path)))}"/>'
    parents = [{n: wish.parent} for n in arguments if n in _PARENTS] if wish.parent else [{}]
    for prefix, parent in product(_list_prefixes(robot, wish.prefix, arguments), parents):
        chosen = {**prefix, **parent}
        given = {**description.arguments, **chosen}
        names = " and ".join(f"argument {n}:={value}" for n, value in chosen.items())
        what = f"included with {names}" if names else "included"
        namespaces = _list_namespaces(description.document.root)
        yield Inclusion(what, given, {**arguments, **given}, [line], namespaces)


def _list_prefixes(robot: Robot, prefix: str, known: Mapping[str, str]) -> list[dict[str, str]]:
    """Return the values of arguments or macro parameters that may give the names a prefix.

    A prefix of the source, with which all names begin, stays behind the new one; the underscore of
    the new one may be that of a macro.
    """
    if not prefix:
        return [{}]
    links = [name for name in robot.link if name != WORLD]
    named = [n for n in known if "prefix" in n.lower() and not known[n]]
    begin = [n for n, v in known.items() if v and all(link.startswith(v) for link in links)]
    texts = [text for text in dict.fromkeys((prefix, prefix.rstrip("_"))) if text]
    some = [named, *([name] for name in named if len(named) > 1)] if named else []
    empty = [dict.fromkeys(names, text) for names in some for text in texts]
    return [*empty, *({n: prefix + known[n]} for n in begin)]


def _list_arguments(description: Description) -> dict[str, str]:
    expansion = description.expansion
    known = {} if expansion is None else expansion.arguments
    return {n: description.arguments.get(n, a.default) for n, a in known.items()}


def _list_namespaces(root: Element) -> dict[str, str]:
    attributes = root.attributes.items()
    return {n: v for n, v in attributes if n.startswith("xmlns:") and n != "xmlns:xacro"}


def _call_macros(
    robot: Robot, description: Description, wish: Wish, refer: Refer
) -> Iterator[Inclusion]:
    """Yield the lines of the file with other values of macro parameters, if it only has calls."""
    top = parse(description.files[0]).root
    calls = [child for child in top.children if _is_call(child)]
    if not calls or any(not _is_kept(child) for child in top.children):
        return
    arguments = _list_arguments(description)
    known = {n: _insert(arguments, v) for call in calls for n, v in call.attributes.items()}
    parents = [{n: wish.parent} for n in known if n in _PARENTS] if wish.parent else [{}]
    macros = ", ".join(dict.fromkeys(call.tag.partition(":")[2] for call in calls))
    for prefix, parent in product(_list_prefixes(robot, wish.prefix, known), parents):
        chosen = {**prefix, **parent}
        lines = _write_calls(description, wish, chosen, refer)
        values = " and ".join(f'{n}="{v}"' for n, v in chosen.items())
        what = f"replaced by a call of {macros} with {values}"
        namespaces = _list_namespaces(description.document.root)
        yield Inclusion(what, {}, dict(arguments), lines, namespaces, is_call=True)


def _insert(arguments: Mapping[str, str], text: str) -> str:
    """Return a text with the values of arguments."""
    return re.sub(r"\$\(arg (\w+)\)", lambda m: arguments.get(m[1], m[0]), text)


def _is_call(element: Element) -> bool:
    head, _, name = element.tag.partition(":")
    return head == "xacro" and name not in TAGS


def _is_kept(element: Element) -> bool:
    """Tell whether an element of a file can be in another one, or is the world that goes."""
    head, _, name = element.tag.partition(":")
    if head == "xacro":
        return name != "macro"
    return element.tag == "link" and not element.children


def _write_calls(
    description: Description, wish: Wish, chosen: Mapping[str, str], refer: Refer
) -> list[str]:
    file = description.files[0]
    draft = TextDraft(SourceFile(file.path, file.data))
    for child in draft.source.document.root.children:
        if child.tag == "xacro:include":
            _move_include(draft, child, description, refer)
        elif child.tag == "xacro:arg" and (child.get("name") or "") in description.arguments:
            draft.set(child, "default", description.arguments[child.get("name") or ""])
        elif child.tag == "link" and wish.parent:
            draft.remove(child)
        elif _is_call(child):
            _set_parameters(draft, child, wish, chosen)
    made = SourceFile(file.path, draft.make_bytes())
    text = [
        made.data[child.start : child.end].decode(made.encoding)
        for child in parse(made).root.children
    ]
    return [line for block in text for line in block.splitlines()]


def _move_include(
    draft: TextDraft, element: Element, description: Description, refer: Refer
) -> None:
    name = read_literal(element, "filename") or ""
    if name and not name.startswith(("$", "/")):
        draft.set(element, "filename", refer(Path(description.path).parent / name))


def _set_parameters(draft: TextDraft, call: Element, wish: Wish, chosen: Mapping[str, str]) -> None:
    for name in call.attributes.keys() & chosen.keys():
        draft.set(call, name, chosen[name])
    if wish.parent and call.attributes.keys() & chosen.keys() & set(_PARENTS):
        for origin in call.list_children("origin"):
            text = f"<origin {wish.origin}/>".encode("ascii")
            draft.edits.append(Edit(origin.start, origin.end, text))


def insert_values(inclusion: Inclusion, other: Mapping[str, str]) -> None:
    """Write the values of arguments that another description declares with other values.

    The lines of a macro call do not need the argument then; an inclusion does.
    """
    if not inclusion.is_call:
        return
    text = "\n".join(inclusion.lines)
    for name in list_clashes(inclusion.arguments, other):
        value = quote(inclusion.arguments.pop(name))
        pattern = rf"<xacro:arg\b[^>]*\bname=[\"']{re.escape(name)}[\"'][^>]*/>"
        text = re.sub(pattern, "", text).replace(f"$(arg {name})", value)
    inclusion.lines = [line for line in text.split("\n") if line.strip()]


def list_clashes(one: Mapping[str, str], two: Mapping[str, str]) -> list[str]:
    """Return the names of arguments that have different values."""
    return sorted(name for name in one.keys() & two.keys() if one[name] != two[name])


def quote(text: str) -> str:
    """Return a text as the value of an attribute."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
