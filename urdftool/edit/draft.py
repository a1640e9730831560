"""A plain URDF with changes that are not made yet."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

from ..diagnostic import Severity
from ..errors import ModelError
from ..finding import Finding
from ..lint.validate import require
from ..model.elements import Joint, Link, Robot
from ..model.load import make_robot
from ..model.part import Origin
from ..model.pose import IDENTITY, Pose, make_pose
from ..source.description import Description
from ..source.document import Element, parse
from ..source.edit import Edit, Source, apply, parse_source
from ..source.edit import insert_child as make_insertion
from ..source.edit import remove_element as make_removal
from ..source.edit import set_attribute as make_attribute
from ..source.escape import escape
from ..source.location import Place, SourceFile
from .numbers import format_rotation, format_vector, is_same_pose, measure_turn


@dataclass
class TextDraft:
    """A file of XML with changes that are not made yet.

    Attributes:
        file: The file as it is.
        edits: Changes of whole spans.
        values: New values of attributes, None for none, by start of the element and name.
        removed: Elements to remove, by start.
    """

    file: SourceFile
    edits: list[Edit] = field(default_factory=list)
    values: dict[tuple[int, str], tuple[Element, str | None]] = field(default_factory=dict)
    removed: dict[int, Element] = field(default_factory=dict)

    @property
    def source(self) -> Source:
        """Return the editable file.

        Raises:
            SourceError: Its encoding is not supported for edits.
        """
        return parse_source(self.file)

    def encode(self, text: str) -> bytes:
        """Return text in the encoding of the file; other letters as character references."""
        return text.encode(self.source.document.file.encoding, "xmlcharrefreplace")

    def set(self, element: Element, name: str, value: str) -> None:
        """Set an attribute, if it has another value."""
        if element.get(name) != value or (element.start, name) in self.values:
            self.values[element.start, name] = element, value

    def get(self, element: Element, name: str) -> str | None:
        """Return the new value of an attribute."""
        known = self.values.get((element.start, name))
        return element.get(name) if known is None else known[1]

    def remove_attribute(self, element: Element, name: str) -> None:
        """Remove an attribute."""
        if name in element.attributes:
            self.values[element.start, name] = element, None

    def set_text(self, element: Element, text: str) -> None:
        """Set the text of an element without children; spaces around it stay."""
        data = self.file.data
        start = self.file.find_tag_end(element.start)
        end = data.rfind(b"</", start, element.end)
        inner = data[start:end]
        left = start + len(inner) - len(inner.lstrip())
        right = max(left, end - len(inner) + len(inner.rstrip()))
        self.edits.append(Edit(left, right, escape(text).encode("ascii", "xmlcharrefreplace")))

    def remove(self, element: Element) -> None:
        """Remove an element, with its line if nothing else is on it."""
        self.removed[element.start] = element

    def insert_child(
        self, parent: Element, lines: Sequence[str], *, after: Element | None = None
    ) -> None:
        """Insert an element; its lines are indented by one tab for each level."""
        self.edits.append(make_insertion(self.source, parent, lines, after=after))

    def append(self, parent: Element, lines: Sequence[str]) -> None:
        """Insert an element after all children."""
        kept = [child for child in parent.children if child.start not in self.removed]
        self.insert_child(parent, lines, after=kept[-1] if kept else None)

    def append_bytes(self, text: bytes) -> None:
        """Insert text on lines of its own before the end tag of the root."""
        root, data = self.source.document.root, self.file.data
        end = data.rfind(b"</", 0, root.end)
        line = data.rfind(b"\n", 0, end) + 1
        at = line if not data[line:end].strip() else end
        self.edits.append(Edit(at, at, text if at == line else self.source.line_end + text))

    def list_edits(self) -> list[Edit]:
        """Return all changes as edits of the file."""
        edits = [make_removal(self.source, element) for element in self.removed.values()]
        return _drop_nested([*edits, *self.edits, *self._make_attributes()])

    def make_bytes(self) -> bytes:
        """Return the bytes of the file with all changes."""
        return apply(self.file, self.list_edits())

    def _make_attributes(self) -> list[Edit]:
        made = []
        for (_, name), (element, value) in self.values.items():
            if value is not None:
                made.append(make_attribute(self.source, element, name, value))
                continue
            start, end = self.file.locate_attributes(element.start)[name]
            while self.file.data[start - 1] in b" \t\r\n":
                start -= 1
            made.append(Edit(start, end, b""))
        return made


def _drop_nested(edits: list[Edit]) -> list[Edit]:
    """Return the edits without those inside of text that is removed or replaced."""
    kept: list[Edit] = []
    for edit in sorted(edits, key=lambda e: (e.start, -e.end)):
        if kept and kept[-1].start <= edit.start < kept[-1].end and edit.end <= kept[-1].end:
            continue
        kept.append(edit)
    return kept


@dataclass
class Draft(TextDraft):
    """A robot in plain URDF with changes that are not made yet.

    Attributes:
        robot: The robot as it is.
        lines: Words of each line of the correspondence.
        notes: What is not kept, or must be known, each with its place.
        around: Files around the description that are edited too.
        meshes: Content of new files by their paths relative to the output.
    """

    robot: Robot = field(default_factory=Robot)
    lines: list[list[str]] = field(default_factory=list)
    notes: list[Finding] = field(default_factory=list)
    around: list[TextDraft] = field(default_factory=list)
    meshes: dict[str, bytes | Path] = field(default_factory=dict)

    @property
    def root(self) -> Element:
        """Return the ``<robot>`` element."""
        return self.robot.element

    @property
    def description(self) -> Description:
        """Return the description of the robot."""
        source = self.robot.source
        assert source is not None
        return source

    def report(
        self, code: str, message: str, place: Place, *, kind: str = "", name: str = ""
    ) -> None:
        """Record what is not kept, or must be known."""
        self.notes.append(Finding(f"edit-{code}", Severity.WARNING, message, place, kind, name))

    def declare(self, *words: str) -> None:
        """Add a line to the correspondence."""
        self.lines.append(list(words))

    def find_link(self, name: str) -> Link:
        """Return a link.

        Raises:
            ModelError: There is none of that name.
        """
        return _find(self.robot.link, name, "link", self.file.path)

    def find_joint(self, name: str) -> Joint:
        """Return a joint.

        Raises:
            ModelError: There is none of that name.
        """
        return _find(self.robot.joint, name, "joint", self.file.path)

    def set_pose(
        self, owner: Element, origin: Origin | None, pose: Pose, *, after: Element | None = None
    ) -> None:
        """Set the ``<origin>`` of an element; numbers that are equal keep their text.

        Args:
            owner: The element that has the origin.
            origin: Its origin; None if it has none.
            pose: The new pose.
            after: Child after which a new origin is inserted; None inserts it first.
        """
        if is_same_pose(make_pose(origin), pose):
            return
        xyz, rpy = format_vector(pose.translation), format_rotation(pose.rotation)
        if origin is None or origin.xml is None:
            turned = "" if rpy == "0 0 0" else f' rpy="{rpy}"'
            self.insert_child(owner, [f'<origin xyz="{xyz}"{turned}/>'], after=after)
            return
        before = make_pose(origin)
        if format_vector(before.translation) != xyz:
            self.set(origin.xml, "xyz", xyz)
        if measure_turn(before.rotation, pose.rotation) > 1e-15 or origin.quaternion is not None:
            self.set(origin.xml, "rpy", rpy)
            self.remove_attribute(origin.xml, "quat_xyzw")


T = TypeVar("T")


def _find(parts: Mapping[str, T], name: str, kind: str, path: str) -> T:
    if name in parts:
        return parts[name]
    from ..suggestions import suggest_name

    hint = suggest_name(name, parts, 0.5) or f"; {kind}s: {', '.join(list(parts)[:8])}"
    raise ModelError(f"{kind} '{name}' does not exist{hint}", path=path)


def open_draft(robot: Robot) -> Draft:
    """Return the draft of a robot: of its file, or of the expansion of xacro.

    A file that the expansion does not change, such as one that xacro wrote, is plain URDF.

    Raises:
        ModelError: The robot is not a tree of URDF links.
        SourceError: The encoding of the file is not supported for edits.
    """
    description = robot.source
    if description is None or robot.format != "urdf":
        raise ModelError(
            f"a robot in {robot.format.upper()} is not edited; convert it with "
            "'urdftool export urdf' first",
            path=None if description is None else description.path,
        )
    file = description.files[0]
    if description.expansion is not None:
        if not _is_unchanged(description):
            file = SourceFile(file.path, description.expansion.text.encode("utf-8"))
    elif file is not description.document.file:
        file = description.document.file
    return open_file(description, file)


def _is_unchanged(description: Description) -> bool:
    """Tell whether the expansion of a xacro file is the file, such as one that xacro wrote."""
    if len(description.files) != 1:
        return False
    one, two = parse(description.files[0]).root, description.document.root
    return flatten_element(one, _XACRO) == flatten_element(two, _XACRO)


_XACRO = ("xmlns:xacro",)


def flatten_element(element: Element, ignored: Sequence[str] = ()) -> tuple[object, ...]:
    """Return tag, attributes, text and children of an element, to compare it."""
    inner = tuple(flatten_element(child) for child in element.children)
    values = sorted((k, v) for k, v in element.attributes.items() if k not in ignored)
    return element.tag, tuple(values), element.text.strip(), inner


def open_file(description: Description, file: SourceFile) -> Draft:
    """Return a draft of other bytes of a description, whose paths mean the same.

    Raises:
        ModelError: The links do not form a tree with one root, or a number cannot be read, so that
            the result could not be compared.
    """
    plain = replace(description, document=parse(file), files=[file], expansion=None, arguments={})
    robot = make_robot(plain)
    parse_source(file)
    _check_tree(robot)
    require(robot, "edit")
    return Draft(file=file, robot=robot)


def _check_tree(robot: Robot) -> None:
    """Check that names are unique, and that the links form a tree.

    Raises:
        ModelError: They do not.
    """
    for kind, parts in (("link", robot.links), ("joint", robot.joints)):
        seen = set()
        for part in parts:
            if part.name in seen or not part.name:
                what = (
                    f"{kind} '{part.name}' occurs twice" if part.name else f"a {kind} has no name"
                )
                raise ModelError(f"{what}; a robot with such a defect is not edited", at=part.place)
            seen.add(part.name)
    for joint in robot.joints:
        for name in (joint.parent, joint.child):
            if name not in robot.link:
                raise ModelError(
                    f"joint '{joint.name}': link '{name}' does not exist", at=joint.place
                )
    children = [joint.child for joint in robot.joints]
    for joint in robot.joints:
        if children.count(joint.child) > 1:
            raise ModelError(
                f"link '{joint.child}' is the child of two joints, a closed loop, which URDF "
                "does not have",
                at=joint.place,
            )
    if len(robot.tree.roots) != 1 or robot.tree.detached:
        raise ModelError("its links do not form a tree with one root", at=robot.place)


def is_identity(pose: Pose) -> bool:
    """Tell whether a pose is the identity except for rounding."""
    return is_same_pose(pose, IDENTITY)


def make_relative(path: Path, folder: Path) -> str:
    """Return a path as it is from a folder."""
    return os.path.relpath(path, folder).replace(os.sep, "/")
