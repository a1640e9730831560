"""Definitions of names by the text of files alone, for elements that no expansion reached."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence

from ..source.document import Element
from .words import XACRO, Word, WordTable

_MACRO = f"{XACRO}macro"


class Scopes:
    """Definitions in the files of some robots.

    A name in a macro is its parameter or property, or that of a macro around it. Then come macros
    that call this one, whose scope xacro searches, and properties outside of macros: those of the
    same file, or of the other files.
    """

    def __init__(self, tables: Iterable[WordTable]) -> None:
        """Index the names of documents."""
        self._definitions: dict[tuple[str, str], list[Word]] = {}
        self._calls: dict[str, list[Element]] = {}
        for table in tables:
            for word in table.words:
                if word.is_definition:
                    self._definitions.setdefault((word.kind, word.name), []).append(word)
                elif word.kind == "macro":
                    self._calls.setdefault(_strip(word.name), []).append(word.element)

    def list_definitions(self, kind: str, name: str) -> list[Word]:
        """Return all definitions of a name."""
        return self._definitions.get((kind, name), [])

    def find(self, word: Word) -> list[Word]:
        """Return what probably defines a name; several places where the text does not decide."""
        if word.is_definition:
            return [word]
        if word.kind == "macro":
            return self.list_definitions("macro", _strip(word.name))
        if word.kind == "name" and word.owner and word.element.tag == XACRO + word.owner:
            owner = _strip(word.owner)
            return [one for one in self.list_definitions("name", word.name) if one.owner == owner]
        if word.kind == "name":
            return self._find_name(word)
        return self.list_definitions(word.kind, word.name)

    def _find_name(self, word: Word) -> list[Word]:
        known = self.list_definitions("name", word.name)
        macro = find_macro(word.element)
        while macro is not None:
            inside = [one for one in known if get_scope(one) is macro]
            if inside:
                return inside
            macro = find_macro(macro.parent)
        around = list(self._list_dynamic(word, known))
        outside = [one for one in known if get_scope(one) is None]
        here = [one for one in outside if one.element.file is word.element.file]
        return [*around, *(here or outside)] or known

    def list_visible(self, path: str, macros: Sequence[int]) -> list[Word]:
        """Return properties and parameters that an element can use.

        Args:
            path: File of the element.
            macros: First bytes of the macros around it, innermost first.
        """
        outside: list[Word] = []
        inside: dict[int, list[Word]] = {start: [] for start in macros}
        for (kind, _), words in self._definitions.items():
            for word in words if kind == "name" else ():
                scope = get_scope(word)
                if scope is None:
                    outside.append(word)
                elif scope.start in inside and os.path.realpath(scope.file.path) == path:
                    inside[scope.start].append(word)
        return [word for words in (*inside.values(), outside) for word in words]

    def _list_dynamic(self, word: Word, known: list[Word]) -> Iterator[Word]:
        """Yield definitions in the macros that call the macro around a name."""
        macro = find_macro(word.element)
        todo, seen = [macro], set()
        while todo:
            called = todo.pop()
            name = (called.get("name") or "") if called is not None else ""
            if not name or name in seen:
                continue
            seen.add(name)
            for call in self._calls.get(name, ()):
                caller = find_macro(call)
                if caller is None:
                    continue
                inside = [one for one in known if get_scope(one) is caller]
                yield from inside
                if not inside:
                    todo.append(caller)


def _strip(name: str) -> str:
    """Return the name of a macro without its namespaces."""
    return name.rpartition(".")[2]


def find_macro(element: Element | None) -> Element | None:
    """Return the innermost definition of a macro that an element is or is in."""
    while element is not None and element.tag != _MACRO:
        element = element.parent
    return element


def get_scope(definition: Word) -> Element | None:
    """Return the macro in which a property or parameter is defined; None for all files."""
    if definition.element.get("scope") in ("global", "parent"):
        return None
    return find_macro(definition.element)
