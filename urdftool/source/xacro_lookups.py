"""Record of what xacro looks up in an expansion: which element asks, and which element defined it.

xacro keeps names in tables of scopes. Recorded are the element that sets a name of a table, and
each element that reads it; so an answer is right for every scope, redefinition and include.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from .expansion import Lookup, LookupKind
from .location import SourceFile
from .xacro_tree import XacroElement

_PROPERTY, _INCLUDE = "xacro:property", "xacro:include"
_Site = tuple[SourceFile, int]
_PLACES = "_places"
"""Attribute of a table of xacro: element by name that set it."""
_NOTHING: Mapping[str, _Site] = {}


class LookupRecorder:
    """Record of one expansion.

    Attributes:
        found: Elements that define a name, in the order of first use, by the element that asks,
            the kind and the name.
    """

    def __init__(self, get_node: Callable[[], XacroElement | None]) -> None:
        """Create an empty record."""
        self.found: dict[tuple[_Site, LookupKind, str], dict[_Site, None]] = {}
        self._get_node = get_node
        self._askers: list[_Site] = []
        self._macro: _Site | None = None
        self._macro_type: type = type(None)
        self._arguments: dict[str, _Site] = {}

    def record(self, kind: LookupKind, name: str, definition: _Site | None) -> None:
        """Record that the present element reads a name."""
        node = self._get_node()
        if definition is None or (node is None and not self._askers):
            return
        key = self._askers[-1] if self._askers else _get_site(node), kind, name
        found = self.found.get(key)
        if found is None:
            self.found[key] = {definition: None}
        else:
            found[definition] = None

    def record_argument(self, element: XacroElement, name: str) -> None:
        """Store the first ``<xacro:arg>`` of a name, which gives its default."""
        self._arguments.setdefault(name, _get_site(element))

    def list_found(self) -> list[Lookup]:
        """Return the record."""
        return [
            Lookup(*site, kind, name, tuple(definitions))
            for (site, kind, name), definitions in self.found.items()
        ]

    def install(self, xacro: Any, substitution_args: Any) -> None:
        """Replace functions of xacro and of its tables by ones that record."""
        self._macro_type = xacro.Macro
        table = xacro.Table
        for owner, name, wrap in (
            (table, "_setitem", self._wrap_set),
            (table, "_resolve_", self._wrap_resolve),
            (xacro, "resolve_macro", self._wrap_resolve_macro),
            (xacro, "handle_macro_call", self._wrap_macro_call),
            (xacro, "eval_default_arg", self._wrap_default),
            (substitution_args, "_eval_arg", self._wrap_argument),
        ):
            setattr(owner, name, wrap(getattr(owner, name)))

    def _wrap_set(self, original: Callable[..., None]) -> Callable[..., None]:
        def set_item(table: Any, key: str, value: Any, unevaluated: bool) -> None:
            site = self._find_definition()
            if site is not None:
                table.__dict__.setdefault(_PLACES, {})[key] = site
            original(table, key, value, unevaluated)

        return set_item

    def _find_definition(self) -> _Site | None:
        """Return the element that sets a name: a property, an include, or the called macro."""
        node = self._get_node()
        if node is None:
            return None
        return _get_site(node) if node.tagName in (_PROPERTY, _INCLUDE) else self._macro

    def _wrap_resolve(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def resolve(table: Any, key: str) -> Any:
            value = dict.__getitem__(table, key)
            if isinstance(value, self._macro_type):
                return value
            site = table.__dict__.get(_PLACES, _NOTHING).get(key)
            self.record("name", key, site)
            if key not in table.unevaluated:
                return value
            if site is None:
                return original(table, key)
            return self._call_as(site, original, table, key)

        return resolve

    def _call_as(self, site: _Site, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function whose reads are those of another element than the present one."""
        self._askers.append(site)
        try:
            return function(*arguments)
        finally:
            self._askers.pop()

    def _wrap_resolve_macro(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def resolve(name: str, macros: Any, symbols: Any) -> Any:
            result = original(name, macros, symbols)
            self._macro = _get_site(result[2].body)
            self.record("macro", name, self._macro)
            return result

        return resolve

    def _wrap_macro_call(self, original: Callable[..., bool]) -> Callable[..., bool]:
        def call(*arguments: Any) -> bool:
            before = self._macro
            result = original(*arguments)
            self._macro = before
            return result

        return call

    def _wrap_default(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def evaluate(forward: Any, default: Any, symbols: Any, macro: Any) -> Any:
            site = _get_site(macro.body)
            return self._call_as(site, original, forward, default, symbols, macro)

        return evaluate

    def _wrap_argument(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def evaluate(name: str, args: Any) -> Any:
            self.record("argument", name, self._arguments.get(name))
            return original(name, args)

        return evaluate


def _get_site(node: Any) -> _Site:
    return node.file, node.start
