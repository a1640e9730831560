"""Completion: elements, attributes, names, packages and files."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import UrdftoolError
from ..model.elements import JOINT_TYPES
from ..model.mesh_formats import READ_BY
from ..model.urdf_schema import DIALECTS, VOCABULARY
from ..source.packages import Packages, find_own_package
from ..source.safe_builtins import MATH
from .cursor import Cursor, find_cursor
from .knowledge import Knowledge
from .names import Names, get_names
from .scopes import find_macro
from .terms import ATTRIBUTES, ELEMENTS
from .words import BUILT_IN, XACRO, Word, WordKind

MOST_ITEMS = 500
"""Items of one answer; chosen: a person reads twenty, an editor filters what is typed."""

# CompletionItemKind; source: the protocol, 3.17
_FUNCTION, _VARIABLE, _CLASS = 3, 6, 7  # source: the protocol
_MODULE, _PROPERTY, _FILE, _FOLDER = 9, 10, 17, 19  # source: the protocol
_ENUM, _EVENT = 20, 23  # source: the protocol
_SNIPPET = 2  # InsertTextFormat; source: the protocol, 3.17
_EXPRESSION = re.compile(r"\$\{[^}]*?([A-Za-z_][\w.]*)?\Z")
_EXTENSION = re.compile(r"\$\(([^)\s]*)(\s+)?([^)\s]*)\Z")
_COMMANDS = {
    "arg": "value of an argument",
    "find": "folder of a package",
    "eval": "expression with the names of ROS 1",
    "env": "environment variable",
    "optenv": "environment variable, or a default",
    "dirname": "folder of this file",
}
_ATTRIBUTES = {
    f"{XACRO}macro": ("name", "params"),
    f"{XACRO}property": ("name", "value", "default", "scope", "lazy_eval", "remove"),
    f"{XACRO}arg": ("name", "default"),
    f"{XACRO}include": ("filename", "ns", "optional"),
    f"{XACRO}insert_block": ("name",),
    f"{XACRO}call": ("macro",),
    f"{XACRO}if": ("value",),
    f"{XACRO}unless": ("value",),
    f"{XACRO}element": ("xacro:name",),
    f"{XACRO}attribute": ("name", "value"),
    "gazebo": ("reference",),
}
"""Attributes of the elements of xacro, as xacro 2.1 reads them."""

_MESHES = tuple(f".{suffix}" for suffixes in READ_BY.values() for suffix in suffixes)
_SUFFIXES = {
    "texture": (".png", ".jpg", ".jpeg", ".dds", ".bmp", ".tga"),
    f"{XACRO}include": (".xacro", ".urdf"),
    "include": (".xacro", ".urdf"),
}
"""Ends of the names of files that an element may name; of others, those of meshes."""


class Item(NamedTuple):
    """What may be typed.

    Attributes:
        label: The text.
        kind: Kind of the protocol.
        detail: What it is.
        is_snippet: Whether it is an attribute, whose value comes next.
    """

    label: str
    kind: int
    detail: str = ""
    is_snippet: bool = False


def list_completions(knowledge: Knowledge, params: dict[str, Any]) -> list[dict[str, Any]]:
    """Return what may be typed at a position."""
    file = knowledge.read(params["path"])
    offset = knowledge.get_offset(params)
    cursor = find_cursor(file, offset) if knowledge.get_words(params["path"]) else None
    if cursor is None:
        return []
    typed, items = _Completion(knowledge, params["path"], cursor).list_items()
    start = offset - len(typed.encode(file.encoding, "replace"))
    span = knowledge.make_table(file).get_range(start, offset)
    unique = {item.label: item for item in reversed(list(items)) if item.label}
    return [
        _make_item(item, span, rank, snippets=bool(params.get("snippets")))
        for rank, item in enumerate(list(reversed(unique.values()))[:MOST_ITEMS])
    ]


def _make_item(item: Item, span: dict[str, Any], rank: int, *, snippets: bool) -> dict[str, Any]:
    found: dict[str, Any] = {
        "label": item.label,
        "kind": item.kind,
        "sortText": f"{rank:04}",
        "textEdit": {"range": span, "newText": item.label},
    }
    if item.detail:
        found["detail"] = item.detail
    if item.is_snippet and snippets:
        found["textEdit"]["newText"] = f'{item.label}="$1"'
        found["insertTextFormat"] = _SNIPPET
    return found


class _Completion:
    """Items for one position."""

    def __init__(self, knowledge: Knowledge, path: str, cursor: Cursor) -> None:
        self.knowledge, self.path, self.cursor = knowledge, path, cursor

    @property
    def names(self) -> Names:
        """Return the names of the robots of the file."""
        return get_names(self.knowledge, self.path)

    def list_items(self) -> tuple[str, Iterable[Item]]:
        """Return the text that an item replaces, and the items."""
        cursor = self.cursor
        if cursor.place == "tag":
            return cursor.text, self._list_tags()
        if cursor.place == "attribute":
            return cursor.text, self._list_attributes()
        expression = _EXPRESSION.search(cursor.text)
        if expression is not None:
            return expression[1] or "", self._list_names()
        extension = _EXTENSION.search(cursor.text)
        if extension is not None:
            return self._list_extension(*extension.groups())
        return self._list_values()

    # Elements and attributes ---------------------------------------------------------------

    def _list_tags(self) -> Iterator[Item]:
        element = self.cursor.element
        above = element.parent
        while above is not None and above.tag.startswith(XACRO):
            above = above.parent
        parent = above.tag if above is not None else ""
        present = {e.tag for e in (element.parent.children if element.parent else ())}
        known = VOCABULARY.get(parent)
        for tag in known.children if known is not None else ():
            if parent == "robot" or known is None or tag in known.many or tag not in present:
                yield Item(tag, _CLASS, ELEMENTS.get(tag, ""))
        for tag in sorted(DIALECTS.get(parent, ())):
            yield Item(tag, _CLASS, "element of a simulator or of ROS")
        if parent and self._has_xacro():
            for word in self._list_definitions("macro"):
                yield Item(XACRO + word.name, _FUNCTION, f"macro, {_format_place(word)}")
            yield from (Item(tag, _MODULE, "element of xacro") for tag in sorted(BUILT_IN))

    def _has_xacro(self) -> bool:
        root = self.cursor.element
        while root.parent is not None:
            root = root.parent
        return "xmlns:xacro" in root.attributes

    def _list_attributes(self) -> Iterator[Item]:
        element = self.cursor.element
        known = VOCABULARY.get(element.tag)
        names: list[tuple[str, str]] = []
        if known is not None:
            listed = (*known.words, *known.numbers)
            names = [(name, ATTRIBUTES.get((element.tag, name), "")) for name in listed]
        names += [(name, "") for name in _ATTRIBUTES.get(element.tag, ())]
        if element.tag.startswith(XACRO) and element.tag not in BUILT_IN:
            names += self._list_parameters(element.tag.removeprefix(XACRO))
        for name, detail in names:
            if name not in element.attributes:
                yield Item(name, _PROPERTY, detail, is_snippet=True)

    def _list_parameters(self, macro: str) -> Iterator[tuple[str, str]]:
        """Yield the parameters of a macro that are not blocks, those without a default first."""
        owner = macro.rpartition(".")[2]
        found = [
            word
            for word in self._list_definitions("name")
            if word.owner == owner and not _is_block(word)
        ]
        for word in sorted(found, key=_has_default):
            optional = ", which has a default" if _has_default(word) else ""
            yield word.name, f"parameter of macro {owner}{optional}"

    def _list_definitions(self, kind: WordKind) -> Iterator[Word]:
        for table in self.names.tables.values():
            for word in table.words:
                if word.kind == kind and word.is_definition:
                    yield word

    # Names ---------------------------------------------------------------------------------

    def _list_names(self) -> Iterator[Item]:
        """Yield properties and parameters that the element can use, the nearest first."""
        macro = find_macro(self.cursor.element)
        around = []
        while macro is not None:
            around.append(macro.start)
            macro = find_macro(macro.parent)
        found = self.names.scopes.list_visible(self.names.get_path(), around)
        for word in found:
            if _is_block(word):
                continue
            detail = f"parameter of macro {word.owner}" if word.owner else _format_value(word)
            yield Item(word.name, _VARIABLE, detail)
        for name in sorted(MATH):
            yield Item(name, _FUNCTION, "of Python's math")

    def _list_extension(
        self, command: str, blank: str | None, typed: str
    ) -> tuple[str, Iterable[Item]]:
        if not blank:
            return command, [Item(name, _FUNCTION, why) for name, why in _COMMANDS.items()]
        if command == "arg":
            words = self._list_definitions("argument")
            return typed, [Item(word.name, _VARIABLE, _format_value(word)) for word in words]
        if command == "find":
            return typed, self._list_packages()
        return typed, []

    def _list_values(self) -> tuple[str, Iterable[Item]]:
        """Return the items for a value or text that is a name."""
        cursor = self.cursor
        element, attribute = cursor.element, cursor.attribute
        kinds = cursor.words.get_kinds(element, attribute)
        if (element.tag, attribute) == ("joint", "type"):
            return cursor.text, [Item(name, _ENUM) for name in sorted(JOINT_TYPES)]
        if "file" in kinds:
            return self._list_files(cursor.text)
        if "macro" in kinds:
            words = self._list_definitions("macro")
            return cursor.text, [Item(word.name, _FUNCTION, _format_place(word)) for word in words]
        if (element.tag, attribute) == (f"{XACRO}insert_block", "name"):
            return cursor.text, self._list_blocks()
        typed = cursor.text if cursor.place == "value" else cursor.text.lstrip()
        return typed, self._list_parts(kinds)

    def _list_blocks(self) -> Iterator[Item]:
        macro = find_macro(self.cursor.element)
        for word in self._list_definitions("name"):
            if _is_block(word) and macro is not None and word.owner == macro.get("name"):
                yield Item(word.name, _VARIABLE, f"block of macro {word.owner}")

    def _list_parts(self, kinds: Iterable[WordKind]) -> Iterator[Item]:
        """Yield links, joints and materials: as this file writes them, then those of robots."""
        part_kinds = {kind for kind in kinds if kind in ("link", "joint", "material")}
        part_kinds |= {"link", "joint"} if "part" in kinds else set()
        path = self.names.get_path()
        for word in self.names.tables[path].words if path in self.names.tables else ():
            if word.kind in part_kinds and word.is_definition:
                yield Item(word.name, _EVENT, f"{word.kind} in this file")
        for description, robot in self.names.descriptions:
            name = os.path.basename(description.path)
            if "link" in part_kinds:
                yield from (Item(link, _EVENT, f"link of {name}") for link in robot.link)
            if "joint" in part_kinds:
                yield from (Item(joint, _EVENT, f"joint of {name}") for joint in robot.joint)
        if "material" in part_kinds:
            for word in self._list_definitions("material"):
                yield Item(word.name, _EVENT, f"material, {_format_place(word)}")

    # Packages and files --------------------------------------------------------------------

    def _list_packages(self) -> Iterator[Item]:
        for packages in self.names.list_packages():
            for name, folder in list_package_folders(packages).items():
                yield Item(name, _MODULE, str(folder))

    def _list_files(self, typed: str) -> tuple[str, Iterable[Item]]:
        """Return the part of a path that is typed, and the files and folders that may follow."""
        element = self.cursor.element
        if typed.startswith("package://") and "/" not in typed.removeprefix("package://"):
            return typed.removeprefix("package://"), self._list_packages()
        head, _, last = typed.rpartition("/")
        suffixes = _SUFFIXES.get(element.tag, _MESHES)
        items: list[Item] = []
        if not head:
            items = [Item("package://", _MODULE), Item("$(find ", _MODULE)]
        for packages in self.names.list_packages():
            folder = _resolve_folder(head, self.names.get_path(), packages)
            if folder is not None:
                items += _list_folder(packages, folder, suffixes)
        return last, items


def _resolve_folder(head: str, path: str, packages: Packages) -> Path | None:
    """Return the folder of the start of a path; None if it cannot be read."""
    found = re.match(r"(?:package://|(?:file://)?\$\(find\s+)([\w.-]+)\)?(?:/|\Z)", head)
    try:
        if found is not None:
            return packages.find(found[1]) / head[found.end() :]
    except UrdftoolError:
        return None
    return None if "$" in head else Path(os.path.dirname(path)) / head


def _list_folder(packages: Packages, folder: Path, suffixes: Iterable[str]) -> Iterator[Item]:
    endings = tuple(suffixes)
    try:
        found = packages.files.list_matches(folder, "*")
    except OSError:
        return
    for path in found:
        if path.name.startswith("."):
            continue
        if packages.files.is_folder(path):
            yield Item(path.name, _FOLDER)
        elif path.name.lower().endswith(endings):
            yield Item(path.name, _FILE)


def list_package_folders(packages: Packages) -> dict[str, Path]:
    """Return the folders of packages that are given, used, or in the workspace."""
    found = {**packages.named, **packages.used}
    for folder in packages.list_neighbors():
        package = find_own_package(folder / "package.xml", packages.files)
        if package is not None:
            found.setdefault(*package)
    return found


def _has_default(word: Word) -> bool:
    after = word.element.file.data[word.end : word.end + 2].lstrip()
    return after.startswith((b"=", b":="))


def _is_block(word: Word) -> bool:
    """Tell whether a name is that of a block, which expressions cannot use."""
    if word.attribute == "params":
        return word.element.file.data[word.start - 1 : word.start] == b"*"
    known = word.element.attributes
    return word.element.tag == f"{XACRO}property" and not {"value", "default"} & known.keys()


def _format_value(word: Word) -> str:
    attributes = word.element.attributes
    value = attributes.get("value", attributes.get("default"))
    return f"{_format_place(word)}" if value is None else f"{value} ({_format_place(word)})"


def _format_place(word: Word) -> str:
    file = word.element.file
    return f"{os.path.basename(file.path)}:{file.position(word.start)[0]}"
