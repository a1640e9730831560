"""Elements and attributes of MJCF that an export to MJCF copies, and those that are not read.

Each attribute that ``read_native_table.py`` does not list as read is either copied or reported.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mechanism import NativeElement
from ...model.numbers import format_numbers_text
from ...model.part import Part
from ...model.provenance import Written
from ...model.world_settings import OF_MUJOCO
from ...source.document import Element, parse
from ...source.location import SourceFile
from .read_compile import Row
from .read_context import Context
from .read_native_table import CLASSES, COPIED, HELD_VALUES, KINDS, MERGED, PARTS, READ, READ_IN
from .read_tree import VELOCITY

_CREATING = frozenset(("attach", "replicate", "composite", "flexcomp"))
"""Elements that create elements of other sections, with names of their own."""

_POSES = "positions of free and ball joints"
"""Name of the values of a keyframe that the robot does not hold."""

_OF_EXPORT = "robot_name"
"""Name of the text in ``<custom>`` that an export writes."""


@dataclass
class _Text:
    """The text for MuJoCo, parsed."""

    roots: list[Element]
    lines: dict[int, Element]


def add_native(context: Context, robot: Robot) -> None:
    """Add the elements that an export copies, and report what is not read."""
    text = _parse_text(context)
    robot.native = [*_list_sections(context, text), *_list_parts(context, text)]
    _mark_held(robot)
    copied = _find_copied(context, text)
    for root in text.roots:
        for section in root.children:
            if section.tag in COPIED:
                setting = (
                    "setting" if root is text.roots[0] and section.tag in copied else "created"
                )
                _report_section(context, section, setting)


def _find_copied(context: Context, text: _Text) -> set[str]:
    """Return the tags of the sections of which an export copies the elements as they are written.

    Elements that a model makes of others, such as those of a model that it attaches, are not
    written with their names: a section is copied if the compiled model has just what it writes.
    """
    if not any(element.tag in _CREATING for element in text.lines.values()):
        return set(COPIED)
    main, *attached = text.roots
    others = {section.tag for root in attached for section in root.children if section.children}
    copied = {tag for tag in COPIED if tag in MERGED or tag not in others}
    keys = [(0, name) for name, _ in context.compiled.keys]  # whose lines MuJoCo does not keep
    for tag, written in [*context.compiled.written.items(), ("keyframe", keys)]:
        elements = [
            element
            for section in main.children
            if section.tag == tag
            for element in section.children
            if tag != "contact" or element.tag == "pair"
        ]
        lines = [0 if tag == "keyframe" else _get_line(one) for one in elements]
        if written != [
            (line, e.get("name") or "") for line, e in zip(lines, elements, strict=True)
        ]:
            copied.discard(tag)
    return copied


def _mark_held(robot: Robot) -> None:
    """Set which attributes of the elements other parts of the robot have as values."""
    parts: tuple[Sequence[Part], ...] = (
        *(robot.joint_actuators, robot.mounted_sensors, robot.closures, robot.exclusions),
        robot.configurations,
        [joint.mimic for joint in robot.joints if joint.mimic is not None],
    )
    held = {part.place for of_kind in parts for part in of_kind}
    for element in robot.native:
        if element.section == "option":
            element.held = _OPTIONS | {"flag"}
        elif element.place in held:
            element.held = READ_IN.get(element.section)
            element.values = _drop_held(element)


def _drop_held(element: NativeElement) -> dict[str, tuple[float, ...]]:
    """Return the values of an element that no other part of the robot holds."""
    counts = HELD_VALUES.get(element.section, {})
    kept = {
        name: value[counts[name] :] if name in counts else value
        for name, value in element.values.items()
        if counts.get(name) != 0
    }
    return {name: value for name, value in kept.items() if value}


def _parse_text(context: Context) -> _Text:
    expanded = context.expanded
    texts = [expanded.text.encode(), *expanded.models.values()]
    text = _Text([], {})
    for data in texts:
        blank = len(data) - len(data.lstrip(b"\n"))
        root = parse(SourceFile("", data.lstrip(b"\n"))).root
        text.roots.append(root)
        for element in _list_all(root):
            text.lines[_get_line(element) + blank] = element
    return text


def _list_all(root: Element) -> Iterator[Element]:
    todo = [root]
    while todo:
        element = todo.pop()
        yield element
        todo += element.children


def _get_place(context: Context, element: Element) -> Written:
    """Return the place in the source of an element of the text of the main model."""
    return Written(context.expanded.get_element_at(_get_line(element)).place)


def _get_line(element: Element) -> int:
    return element.file.position(element.start)[0]


def _list_sections(context: Context, text: _Text) -> Iterator[NativeElement]:
    """Yield the elements of the sections that are copied, and their default classes."""
    copied = _find_copied(context, text)
    for tag in (tag for tag in COPIED if tag in copied):
        made = [
            _make_native(context, tag, element)
            for section in text.roots[0].children
            if section.tag == tag
            for element in (section.children if tag not in MERGED else [section])
            if tag != "contact" or element.tag == "pair"
        ]
        if tag in MERGED:
            made = _merge(made)
        values = context.compiled.values.get(tag, [])
        if tag in KINDS and len(made) == len(values):
            for element, value in zip(made, values, strict=True):
                element.values = value
        if tag == "keyframe" and len(made) == len(context.compiled.poses):
            for element, pose in zip(made, context.compiled.poses, strict=True):
                element.values = {_POSES: pose} if "qpos" in element.attributes and pose else {}
        if tag not in KINDS or len(made) == len(values):
            yield from made
    for child in text.roots[0].children:
        found = _prune(context, child) if child.tag == "default" else None
        if found is not None:
            yield found


def _merge(elements: list[NativeElement]) -> list[NativeElement]:
    """Return one element for several of a tag; values of the last count, as for MuJoCo."""
    tags: dict[str, NativeElement] = {}
    for element in elements:
        first = tags.setdefault(element.tag, element)
        if first is not element:
            first.attributes.update(element.attributes)
            first.children += element.children
    for first in tags.values():
        first.children = _merge(first.children)
    return list(tags.values())


def _make_native(context: Context, section: str, element: Element) -> NativeElement:
    """Return an element with its children."""
    children = [_make_native(context, section, child) for child in element.children]
    written = _get_place(context, element)
    attributes = element.attributes
    if section in MERGED:  # its values name no file, and the text for MuJoCo lacks some
        attributes = context.expanded.get_element_at(_get_line(element)).attributes
    return NativeElement(written, section, element.tag, dict(attributes), children=children)


def _prune(context: Context, element: Element) -> NativeElement | None:
    """Return a default class with what concerns copied elements; None without such."""
    children = []
    for child in element.children:
        if child.tag == "default":
            inner = _prune(context, child)
            children += [] if inner is None else [inner]
        elif child.tag in CLASSES:
            children.append(_make_native(context, "default", child))
    if not children and not element.get("class"):
        return None
    written = _get_place(context, element)
    return NativeElement(written, "default", "default", dict(element.attributes), "", children)


def _list_parts(context: Context, text: _Text) -> Iterator[NativeElement]:
    """Yield the copied attributes of bodies, joints and others; report those that are not read."""
    defaults = [Defaults(root) for root in text.roots]
    held = _list_held_joints(context)
    for tag, (moving, shown) in PARTS.items():
        for number, row in enumerate(context.compiled.rows.get(tag, ())):
            element, name = text.lines.get(row["line"]), _get_name(context, tag, number, row)
            if element is None or element.tag != tag or not _is_of_robot(context, tag, number, row):
                continue
            root = next(one for one in defaults if one.root is _get_root(element))
            attributes = root.resolve(element)
            written = context.get_place(row)
            kept = {a: v for a, v in attributes.items() if a in (*moving, *shown)}
            if tag == "joint" and number in held and row["limited"]:
                kept["range"] = format_numbers_text(row["range"])
            if kept:
                yield _make_part(context, tag, name, row, kept)
            for attribute in _list_unread(context, tag, row, attributes):
                code = "setting" if attribute in moving else "display"
                code = code if attribute in kept and name else "attribute"
                label = f"{attribute} of <{tag}> {row['name']}".strip()
                _report(context, code, label, written, attributes.get(attribute))


def _list_held_joints(context: Context) -> set[int]:
    """Return the numbers of the joints that an equality holds, which are the limits in the robot.

    Their own range counts where the equality is switched off.
    """
    return {
        row["obj1id"]
        for row in context.list_rows("equality")
        if row["type"] == "joint" and row["obj2id"] < 0 and row["active0"]
    }


def _make_part(
    context: Context, tag: str, name: str, row: Row, kept: dict[str, str]
) -> NativeElement:
    """Return attributes of a part; an export copies those of a part with a name only."""
    written = context.get_place(row)
    if name:
        return NativeElement(written, "", tag, {"name": name, **kept})
    link = context.links[row["bodyid"]] if "bodyid" in row else ""
    return NativeElement(written, f"link {link}", tag, kept)


def _list_unread(context: Context, tag: str, row: Row, attributes: dict[str, str]) -> Iterator[str]:
    """Yield the attributes of a part that the robot does not hold."""
    yield from sorted(attributes.keys() - set(READ[tag]))
    if tag == "geom" and row["group"] > _LAST_GROUP:
        yield "group"
    if tag == "joint" and "springref" in attributes and not row["stiffness"]:
        yield "springref"
    low, high = row.get("actfrcrange", (0.0, 0.0))
    if tag == "joint" and low != -high:
        text = "bounds of the force at a joint that are not symmetric are read as the smaller"
        place, content = context.get_place(row).place, f"{low} {high}"
        context.losses.add("force-range", text, row["name"], place, content=content)


def _get_root(element: Element) -> Element:
    while element.parent is not None:
        element = element.parent
    return element


def _get_name(context: Context, tag: str, number: int, row: Row) -> str:
    """Return the name that a part has in the robot."""
    names = {"body": context.links, "joint": context.joints}.get(tag)
    return str(row["name"]) if names is None else names[number]


def _is_of_robot(context: Context, tag: str, number: int, row: Row) -> bool:
    """Tell whether a part is one of a link."""
    if tag == "body":
        return bool(context.links[number])
    if tag == "material":
        geoms = (geom for geom in context.list_rows("geom") if geom["matid"] == number)
        return any(context.has_link(geom) for geom in geoms)
    return "bodyid" not in row or context.has_link(row)


_TEXTS = {
    "attribute": ("attributes are not read", Severity.WARNING),
    "setting": ("settings that only MuJoCo has are not read", Severity.WARNING),
    "created": (
        "settings that only MuJoCo has are not read, nor copied from a model with <attach>, "
        "<replicate>, <composite> or <flexcomp>",
        Severity.WARNING,
    ),
    "display": ("attributes for display and users are not read", Severity.INFO),
    "custom": ("numbers, texts and tuples of <custom> are not read", Severity.INFO),
    "keyframe": ("only joint positions of keyframes are read", Severity.INFO),
}
_LAST_GROUP = 3
"""Group of collisions by convention; those above it are for the user. Chosen, no source."""

_SHOWN_ONLY = frozenset(("springref", "group", "user", "material", "rgba", "width", "objtype"))


def _report(
    context: Context, code: str, name: str, written: Written, content: str | None = None
) -> None:
    what, severity = _TEXTS[code]
    if code == "attribute" and name.split()[0] in _SHOWN_ONLY:
        severity = Severity.INFO
        code, what = "display-attribute", "attributes for display and users are not read"
    context.losses.add(code, what, name, written.place, severity, content)


def _report_section(context: Context, section: Element, setting: str) -> None:
    """Report what the robot does not hold of a section that an export to MJCF may copy.

    Args:
        context: The compiled model.
        section: The section.
        setting: Code of its settings, by whether an export copies them.
    """
    if section.tag in MERGED:
        _report_merged(context, section, setting)
        return
    for element in section.children:
        written = _get_place(context, element)
        if section.tag == "custom":
            name = element.get("name") or ""
            if not name.endswith(VELOCITY) and name != _OF_EXPORT:
                _report(context, "custom", name, written)
            continue
        read = READ_IN.get(section.tag)
        if read is None or element.tag == "pair":
            continue  # reported as a whole
        for attribute in sorted(element.attributes.keys() - read):
            code = "keyframe" if section.tag == "keyframe" else setting
            code = "display" if attribute in _SHOWN_ONLY else code
            name = f"{attribute} of <{element.tag}> {element.get('name') or ''}".strip()
            _report(context, code, name, written)


_OPTIONS = frozenset(row.mjcf.partition(" ")[2] for row in OF_MUJOCO)


def _report_merged(context: Context, section: Element, setting: str) -> None:
    written = _get_place(context, section)
    if section.tag == "size":
        return  # memory and numbers of elements
    if section.tag == "option":
        for attribute in sorted(section.attributes.keys() - _OPTIONS):
            _report(context, setting, f"{attribute} of <option>", written)
        return
    _report(context, "display", f"<{section.tag}>", written)


_MAIN = ""


class Defaults:
    """Attributes by class and tag."""

    def __init__(self, root: Element) -> None:
        """Read the classes of a model."""
        self.root = root
        self._found: dict[str, dict[str, dict[str, str]]] = {_MAIN: {}}
        for child in root.children:
            if child.tag == "default":
                self._add(child, _MAIN, _MAIN)

    def _add(self, element: Element, name: str, parent: str) -> None:
        own = self._found[name] = {t: dict(a) for t, a in self._found[parent].items()}
        for child in element.children:
            if child.tag != "default":
                own.setdefault(child.tag, {}).update(child.attributes)
        for child in element.children:
            if child.tag == "default":
                self._add(child, child.get("class") or _MAIN, name)

    def resolve(self, element: Element) -> dict[str, str]:
        """Return the attributes of an element, with those of its class or its body's."""
        given = self._found.get(self._find_class(element), self._found[_MAIN])
        return given.get(element.tag, {}) | element.attributes

    def _find_class(self, element: Element) -> str:
        own, body = element.get("class"), element.parent
        while own is None and body is not None:
            own, body = body.get("childclass"), body.parent
        return own or _MAIN
