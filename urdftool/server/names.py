"""What names mean in the robots of a file: as xacro looked them up, or by the text alone."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator

from ..errors import UrdftoolError
from ..model.elements import Joint, Link, Robot
from ..source.description import Description
from ..source.document import Element
from ..source.expand import expand_xacro
from ..source.location import SourceFile
from ..source.packages import Packages
from .around import get_table, is_around, list_files_around, list_robots_around
from .knowledge import Knowledge, make_path
from .scopes import Scopes
from .words import XACRO, Word, WordTable

MOST_RECORDED = 3
"""Robots whose lookups are recorded to find a definition; chosen: each takes 0.1 to 0.2 s."""

MOST_BLANKS = 32
"""Bytes between a parameter and the mark of its forwarding; chosen: there are at most a few."""

_FORWARD = re.compile(rb"\s*:?=\s*\^")
_LINKS = ("link", "part")
_JOINTS = ("joint", "part")
_FIND = re.compile(r"\$\(find\s+([\w.-]+)\s*\)")
_Site = tuple[str, int]


def get_names(knowledge: Knowledge, path: str) -> Names:
    """Return the names of the robots that a file belongs to."""
    key = "names", make_path(path)
    if key not in knowledge.memo:
        knowledge.memo[key] = Names(knowledge, path)
    found: Names = knowledge.memo[key]
    return found


class Names:
    """Names in the files that the robots of a file have."""

    def __init__(self, knowledge: Knowledge, path: str) -> None:
        """Index the names of the robots that a file belongs to."""
        self.knowledge, self._path = knowledge, make_path(path)
        self.tables: dict[str, WordTable] = {}
        self._add_tables(knowledge.list_connected(path))
        self.descriptions = knowledge.list_descriptions(path)
        if not self.descriptions and is_around(path):
            self.descriptions = list_robots_around(knowledge, path)
            for description, _ in self.descriptions:
                self._add_tables(make_path(file.path) for file in description.files)
        self.scopes = Scopes(self.tables.values())
        self._recorded: dict[tuple[str, int, str, str], dict[_Site, None]] = {}
        self._macros: dict[_Site, dict[_Site, None]] = {}
        self._instances: dict[_Site, list[tuple[Element, Robot]]] = {}
        for description, robot in self.descriptions:
            self._add_instances(description, robot)
        for description, _ in self.descriptions[:MOST_RECORDED]:
            self._add_recorded(description)

    # Robots --------------------------------------------------------------------------------

    def _add_tables(self, paths: Iterable[str]) -> None:
        """Index the names of files, by resolved path."""
        for path in paths:
            table = self.tables.get(path) or get_table(self.knowledge, path)
            if table is not None:
                self.tables[path] = table

    def add_files_around(self) -> None:
        """Index the names in the SRDF and YAML files of the robots too."""
        for description, robot in self.descriptions:
            if robot.format == "urdf":
                self._add_tables(list_files_around(self.knowledge, description, robot))

    def _is_present(self, file: SourceFile) -> bool:
        """Tell whether a file that was read is as it is now."""
        table = self.tables.get(make_path(file.path))
        return table is not None and self.knowledge.read(file.path).data == file.data

    def _add_instances(self, description: Description, robot: Robot) -> None:
        """Index the elements of a robot by the element of the source."""
        present = {file.path for file in description.files if self._is_present(file)}
        paths = {path: make_path(path) for path in present}
        for made in description.document.root.walk():
            if made.file.path in present:
                site = paths[made.file.path], made.start
                self._instances.setdefault(site, []).append((made, robot))

    def _add_recorded(self, description: Description) -> None:
        """Add what xacro looks up in an expansion, in files that are as they were."""
        if description.expansion is None:
            return
        file, finder = description.files[0], description.packages
        try:
            done = expand_xacro(file, description.arguments, finder, record=True)
        except UrdftoolError:
            return
        files = {one.path: make_path(one.path) for one in done.files.values()}
        present = {one.path for one in done.files.values() if self._is_present(one)}
        for one in done.lookups or ():
            if one.file.path not in present:
                continue
            site = files[one.file.path], one.start
            known = self._recorded.setdefault((*site, one.kind, one.name), {})
            for found, start in one.definitions:
                if found.path in present:
                    known[files[found.path], start] = None
            if one.kind == "macro":
                self._macros.setdefault(site, {}).update(known)

    def get_path(self) -> str:
        """Return the resolved path of the file."""
        return self._path

    def list_packages(self) -> Iterator[Packages]:
        """Yield the finders of packages of the robots, or that of the file if it has none."""
        for description, _ in self.descriptions:
            yield description.packages
        if not self.descriptions:
            yield self.knowledge.make_packages(self._path)

    # Values --------------------------------------------------------------------------------

    def _list_instances(self, word: Word) -> list[tuple[Element, Robot]]:
        return self._instances.get((make_path(word.element.file.path), word.element.start), [])

    def get_values(self, word: Word) -> list[str]:
        """Return what a text is in each expansion; the text itself if it is not computed."""
        found = {
            (made.get(word.attribute) or "") if word.attribute else made.text.strip(): None
            for made, _ in self._list_instances(word)
        }
        if "$" not in word.name:
            return [word.name]
        return [value for value in found if value]

    def list_included(self, word: Word) -> Iterator[str]:
        """Yield the resolved paths of the files that an include names."""
        if not word.element.tag.endswith("include"):
            return
        path = make_path(word.element.file.path)
        known = self._recorded.get((path, word.element.start, "file", ""), {})
        yield from (found for found, _ in known)
        if known:
            return
        for packages in self.list_packages():
            found = _resolve_include(word.name, path, packages)
            if found and os.path.isfile(found):
                yield found

    # Definitions ---------------------------------------------------------------------------

    def find_definitions(self, word: Word) -> list[Word]:
        """Return the names that define what a name means, without repetition."""
        if word.is_definition:
            found = [word, *(self.find_recorded(word) if _is_forwarded(word) else ())]
        elif word.kind in (*_LINKS, "joint"):
            found = list(self._list_part_definitions(word)) or self._find_literal(word)
        elif word.kind == "material":
            found = list(self._list_materials(word))
        else:
            found = self.find_recorded(word) or self.scopes.find(word)
        return list({(one.element.file.path, one.start): one for one in found}.values())

    def find_recorded(self, word: Word) -> list[Word]:
        """Return the definitions that xacro used for a name, in all recorded expansions."""
        path, start = make_path(word.element.file.path), word.element.start
        if word.kind == "name" and word.owner and word.element.tag == XACRO + word.owner:
            macros = self._macros.get((path, start), {})
            return list(self._list_words(macros, "name", word.name))
        kind = word.kind
        starts = [start]
        if not word.attribute:
            starts += [child.start for child in word.element.children]
        for first in starts:
            for name in (word.name, f"*{word.name}", f"**{word.name}"):
                sites = self._recorded.get((path, first, kind, name))
                if sites:
                    return list(self._list_words(sites, kind, word.name))
        return []

    def _list_words(self, sites: dict[_Site, None], kind: str, name: str) -> Iterator[Word]:
        """Yield the words that define a name in elements."""
        for path, start in sites:
            words = [
                word for word in self.tables[path].list_definitions(start) if word.kind == kind
            ]
            named = [word for word in words if word.name == name]
            yield from named or [word for word in words if word.attribute == "name"]

    def _list_part_definitions(self, word: Word) -> Iterator[Word]:
        """Yield the definitions of the links and joints that a name means in each expansion."""
        instances = self._list_instances(word)
        robots = {id(robot): robot for _, robot in instances or self.descriptions}
        for value in self.get_values(word):
            for robot in robots.values():
                for part in _list_parts(robot, word.kind, value):
                    if part is not None and part.xml is not None:
                        yield from self._find_defined(part.xml)

    def _find_defined(self, made: Element) -> Iterator[Word]:
        """Yield the name of a link or joint in the source."""
        table = self.tables.get(make_path(made.file.path))
        if table is not None and self._is_present(made.file):
            for word in table.list_definitions(made.start):
                if word.kind == made.tag:
                    yield word

    def _find_literal(self, word: Word) -> list[Word]:
        """Return the links and joints whose name is written in the same way."""
        kinds = ("link", "joint") if word.kind == "part" else (word.kind,)
        found = [one for kind in kinds for one in self.scopes.list_definitions(kind, word.name)]
        here = [one for one in found if one.element.file is word.element.file]
        return here or found

    def _list_materials(self, word: Word) -> Iterator[Word]:
        """Yield the materials of a name that have a color or texture."""
        values = set(self.get_values(word)) or {word.name}
        for table in self.tables.values():
            for one in table.words:
                if one.kind == "material" and one.is_definition:
                    if values.intersection(self.get_values(one) or [one.name]):
                        yield one

    def list_computed_calls(self, definitions: list[Word]) -> Iterator[Word]:
        """Yield the names in calls of some macros that compute which macro they call."""
        sites = {
            (make_path(one.element.file.path), one.element.start)
            for one in definitions
            if one.kind == "macro"
        }
        for (path, start), macros in self._macros.items():
            for word in self.tables[path].words if sites.intersection(macros) else ():
                if word.element.start == start and word.kind == "macro" and "$" in word.name:
                    yield word

    # References ----------------------------------------------------------------------------

    def find_references(self, word: Word) -> list[Word]:
        """Return all names that mean the same as a name, definitions included."""
        if word.kind in ("link", "joint", "part", "material"):
            return list(self._list_named(word))
        targets = {_get_key(one) for one in self.find_definitions(word)}
        return [
            one
            for table in self.tables.values()
            for one in table.words
            if one.kind == word.kind and _has_same_end(one.name, word.name)
            if targets.intersection(map(_get_key, self.find_definitions(one)))
        ]

    def _list_named(self, word: Word) -> Iterator[Word]:
        """Yield the names that have a value of another in some expansion."""
        values = set(self.get_values(word)) or {word.name}
        kinds = {"link": _LINKS, "joint": _JOINTS, "part": ("link", "joint", "part")}
        for table in self.tables.values():
            for one in table.words:
                if one.kind in kinds.get(word.kind, (word.kind,)):
                    if values.intersection(self.get_values(one) or [one.name]):
                        yield one


def _list_parts(robot: Robot, kind: str, name: str) -> Iterator[Link | Joint | None]:
    """Yield the link and the joint that a name of a kind may mean."""
    if kind in _LINKS:
        yield robot.link.get(name)
    if kind in _JOINTS:
        yield robot.joint.get(name)


def _is_forwarded(word: Word) -> bool:
    """Tell whether a parameter has the value of a name of the caller: ``name:=^``."""
    after = word.element.file.data[word.end : word.end + MOST_BLANKS]
    return word.attribute == "params" and _FORWARD.match(after) is not None


def _get_key(word: Word) -> _Site:
    return word.element.file.path, word.start


def _has_same_end(one: str, other: str) -> bool:
    """Tell whether two names are equal but for namespaces."""
    return one.rpartition(".")[2] == other.rpartition(".")[2]


def _resolve_include(target: str, path: str, packages: Packages) -> str | None:
    """Return the path of an include as written; None if it is computed."""
    match = _FIND.match(target.removeprefix("file://"))
    try:
        if match is not None:
            rest = target.removeprefix("file://")[match.end() :]
            target = str(packages.find(match[1])) + rest
    except UrdftoolError:
        return None
    if "$" in target:
        return None
    return make_path(packages.find_installed(os.path.join(os.path.dirname(path), target)))
