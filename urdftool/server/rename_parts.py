"""Renaming of links, joints and materials, also where a macro makes them or is given their name."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from ..edit.around import add_files_around, rename_in_files
from ..edit.draft import Draft
from ..edit.references import NameChange, list_changes
from ..edit.references import Names as NewNames
from ..model.elements import Robot
from ..source.description import Description
from ..source.document import Element
from ..source.edit import Edit, parse_source, read_literal
from ..source.escape import escape
from ..source.location import Call, Place
from ..source.tags import locate_value
from .knowledge import make_path
from .names import Names
from .rename_edits import RefusedRename, SourceEdits, prove
from .words import XACRO, Word, list_texts

_COMPUTED = re.compile(rb"\$\{[^}]*\}|\$\([^)]*\)")
_SINGLE = re.compile(r"\$\{\s*(\w+)\s*\}|\$\(arg\s+([\w.-]+)\s*\)")


def split_written(data: bytes) -> Iterator[tuple[int, int]]:
    """Yield the spans of a name as written that are not computed."""
    position = 0
    for match in _COMPUTED.finditer(data):
        if match.start() > position:
            yield position, match.start()
        position = match.end()
    if position < len(data):
        yield position, len(data)


def rename_parts(
    names: Names, word: Word, span: tuple[int, int], new: str, edits: SourceEdits
) -> None:
    """Rename the links, joints or materials that a name means in each expansion.

    Raises:
        RefusedRename: A reference is computed, or the name is taken.
    """
    if span[0] == span[1]:
        raise RefusedRename("this name is computed", at=Place(word.element.file, *span))
    mapping = _map_values(names, word, span, new)
    old = word.element.file.data[slice(*span)].decode(word.element.file.encoding)
    renaming = _Renaming(names, (old, new), edits)
    known: set[int] = set()
    todo = list(names.descriptions)
    if not todo:
        raise RefusedRename("no robot with this file could be read")
    while todo:
        description, robot = todo.pop()
        if id(robot) in known:
            continue
        known.add(id(robot))
        renaming.add_robot(description, robot, _sort_names(robot, word, mapping))
        todo += [pair for path in edits.paths for pair in names.knowledge.read_descriptions(path)]
    for path in sorted(edits.paths):
        edits.check_inside(path)
    prove(names.knowledge, edits, renaming.changes, {})


def _map_values(names: Names, word: Word, span: tuple[int, int], new: str) -> dict[str, str]:
    """Return the new name of each part by its old name."""
    data = word.element.file.data
    before, after = data[word.start : span[0]], data[span[1] : word.end]
    patterns = [_make_pattern(part.decode("utf-8")) for part in (before, after)]
    literal = re.escape(data[slice(*span)].decode("utf-8"))
    pattern = re.compile(f"({patterns[0]}){literal}({patterns[1]})")
    mapping = {}
    for value in names.get_values(word):
        match = pattern.fullmatch(value)
        if match is not None:
            mapping[value] = match[1] + new + match[2]
    if not mapping:
        message = "no robot that was read has this name"
        raise RefusedRename(message, at=Place(word.element.file, *span))
    return mapping


def _make_pattern(written: str) -> str:
    pieces = re.split(r"\$\{[^}]*\}|\$\([^)]*\)", written)
    return ".*".join(map(re.escape, pieces))


def _sort_names(robot: Robot, word: Word, mapping: Mapping[str, str]) -> NewNames:
    """Return the new names of links, of joints and of materials.

    Raises:
        RefusedRename: A new name is taken, or a name is that of a link and of a joint.
    """
    if robot.format != "urdf":
        raise RefusedRename(f"names in {robot.format.upper()} are not changed")
    if word.kind == "material":
        return NewNames({}, {}, materials=mapping)
    links = {old: new for old, new in mapping.items() if old in robot.link}
    joints = {old: new for old, new in mapping.items() if old in robot.joint}
    for old in mapping:
        if old in links and old in joints:
            raise RefusedRename(f"'{old}' is a link and a joint", at=robot.joint[old].place)
    for new in (*links.values(), *joints.values()):
        part = robot.link.get(new) or robot.joint.get(new)
        if part is not None:
            raise RefusedRename(f"the robot has '{new}' already", at=part.place)
    return NewNames(links, joints)


class _Renaming:
    """Edits that change the names of parts of several robots."""

    def __init__(self, names: Names, part: tuple[str, str], edits: SourceEdits) -> None:
        """Create no edits."""
        self.names, self.part, self.edits = names, part, edits
        self.changes: dict[tuple[int, str], str] = {}
        self._kept: list[Any] = []  # objects whose id() is a key

    def add_robot(self, description: Description, robot: Robot, new: NewNames) -> None:
        """Change the names in a robot, its SRDF and its files of controllers."""
        for change in list_changes(robot.element, new):
            self._add(change)
        self._kept.append(robot)
        draft = Draft(file=description.files[0], robot=robot)
        add_files_around(draft)
        rename_in_files(draft, new.every, {"link": new.links, "joint": new.joints})
        for file in draft.around:
            edits = file.list_edits()
            if edits and self.edits.knowledge.read(file.file.path).data != file.file.data:
                raise self._refuse_xacro(file.file.path, new)
            for edit in edits:
                self.edits.add(file.file, edit)

    def _refuse_xacro(self, path: str, new: NewNames) -> RefusedRename:
        """Return the refusal for an SRDF of xacro, with the place of the name in its source."""
        table = self.edits.knowledge.get_words(path)
        for word in table.words if table is not None else ():
            if word.name in new.every and word.kind in ("link", "joint", "part"):
                at = Place(word.element.file, word.start, word.end)
                message = "an SRDF of xacro has this name; change it there first"
                return RefusedRename(message, at=at)
        message = f"{path} makes this name by xacro; change it there first"
        return RefusedRename(message)

    def _add(self, change: NameChange) -> None:
        element, attribute, name = change
        old = (element.get(attribute) or "") if attribute else element.text.strip()
        if old == name:
            return
        self.changes[id(element), attribute] = name
        self._trace(element, attribute, element.calls, (old, name))

    def _trace(
        self, element: Element, attribute: str, calls: tuple[Call, ...], values: tuple[str, str]
    ) -> None:
        """Change a value where it is written: here, or in a call, property or argument."""
        file = self.edits.knowledge.read(element.file.path)
        source = parse_source(file)
        raw = source.elements.get(element.start)
        if raw is None or file.data != element.file.data:
            raise RefusedRename("the file has changed since it was read", at=element.place)
        start, end, written = _read_written(raw, attribute)
        if written == values[0]:
            self.edits.add(file, Edit(start, end, _encode(values[1])))
        elif match := _SINGLE.fullmatch(written):
            self._follow(raw, attribute, match[1] or match[2], calls, values)
        else:
            self._change_part(raw, start, end)

    def _change_part(self, raw: Element, start: int, end: int) -> None:
        """Change the part of a computed name that is not computed."""
        data = raw.file.data
        spans = [
            (start + first, start + last)
            for first, last in split_written(data[start:end])
            if data[start + first : start + last].decode("utf-8", "replace") == self.part[0]
        ]
        if len(spans) != 1:
            shown = data[start:end].decode("utf-8", "replace")
            message = f"name '{shown}' is computed, and would have to change"
            raise RefusedRename(message, at=Place(raw.file, start, end))
        self.edits.add(raw.file, Edit(*spans[0], _encode(self.part[1])))

    def _follow(
        self,
        raw: Element,
        attribute: str,
        name: str,
        calls: tuple[Call, ...],
        values: tuple[str, str],
    ) -> None:
        """Change a value in the property, argument or call that gives it."""
        for definition in self._find_definitions(raw, attribute, name):
            element = definition.element
            if definition.attribute == "params":
                call = next((call for call in calls if call.macro), None)
                if call is not None and self._trace_call(call, name, calls, values):
                    return
            elif element.tag in (f"{XACRO}property", f"{XACRO}arg"):
                inner = "value" if "value" in element.attributes else "default"
                if read_literal(element, inner) is not None:
                    self._trace(element, inner, calls, values)
                    return
        start, end, written = _read_written(raw, attribute)
        message = f"name '{written}' is computed, and would have to change"
        raise RefusedRename(message, at=Place(raw.file, start, end))

    def _trace_call(
        self, call: Call, name: str, calls: tuple[Call, ...], values: tuple[str, str]
    ) -> bool:
        """Change an argument of a call; return whether the call has it."""
        source = parse_source(self.edits.knowledge.read(call.file.path))
        element = source.elements.get(call.start)
        if element is None or name not in element.attributes:
            return False
        self._trace(element, name, calls[calls.index(call) + 1 :], values)
        return True

    def _find_definitions(self, raw: Element, attribute: str, name: str) -> list[Word]:
        table = self.names.tables.get(make_path(raw.file.path))
        for word in table.words if table is not None else ():
            if (word.element.start, word.attribute, word.name) == (raw.start, attribute, name):
                if word.kind in ("name", "argument") and not word.is_definition:
                    if word.owner != raw.tag.removeprefix(XACRO):
                        return self.names.find_definitions(word)
        return []


def _read_written(raw: Element, attribute: str) -> tuple[int, int, str]:
    """Return the span of a value, or of the text of an element, and the text as written."""
    if attribute:
        spans = raw.file.locate_attributes(raw.start)
        if attribute not in spans:
            raise RefusedRename("the name is not written here", at=raw.place)
        start, end = locate_value(raw.file.data, spans[attribute])
        return start, end, read_literal(raw, attribute) or ""
    texts = list(list_texts(raw))
    if len(texts) != 1:
        raise RefusedRename("the name is not written as plain text", at=raw.place)
    text = raw.file.data[slice(*texts[0])]
    start = texts[0][0] + len(text) - len(text.lstrip())
    end = texts[0][0] + len(text.rstrip())
    return start, end, raw.file.data[start:end].decode(raw.file.encoding)


def _encode(name: str) -> bytes:
    return escape(name).encode("ascii", "xmlcharrefreplace")
