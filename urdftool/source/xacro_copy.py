"""The separate copy of xacro that expands, with faster tables of names.

xacro's table asks its parent by recursion, and tries for each value that is set whether it is a
number or a truth value, which raises up to three exceptions. Its methods are replaced by ones with
the same answers.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from types import ModuleType
from typing import Any

_LONGEST = 64  # characters of a literal that is remembered; chosen

_COPY = "urdftool_xacro"


def replace_methods(table: Any) -> None:
    """Replace methods of xacro's class of tables by ones that return the same."""
    table.__getitem__ = _make_getter(table)
    table._eval_literal = staticmethod(_make_conversion(table._eval_literal))


def _make_getter(kind: type) -> Callable[[Any, str], Any]:
    def get_item(table: Any, key: str) -> Any:
        while not dict.__contains__(table, key):
            table = table.parent
            if not isinstance(table, kind):  # the global symbols
                return table[key]
        return table._resolve_(key)

    return get_item


def _make_conversion(original: Callable[[Any], Any]) -> Callable[[Any], Any]:
    remembered = lru_cache(maxsize=1 << 12)(original)

    def convert(value: Any) -> Any:
        if type(value) is not str or len(value) > _LONGEST:
            return original(value)
        return remembered(value)

    return convert


def _load_xacro() -> Any:
    """Load a second copy of xacro under a separate name.

    Its functions and module state change during an expansion; other users of xacro in this
    process are not affected.
    """
    found = find_spec("xacro")
    if found is None or found.origin is None:
        raise ModuleNotFoundError("No module named 'xacro'", name="xacro")
    folders = found.submodule_search_locations
    spec = spec_from_file_location(_COPY, found.origin, submodule_search_locations=folders)
    assert spec is not None
    assert spec.loader is not None
    copy = sys.modules[_COPY] = module_from_spec(spec)
    spec.loader.exec_module(copy)
    replace_methods(copy.Table)
    return copy


xacro: Any = _load_xacro()


def _import_substitution_args() -> Any:
    """Return xacro's module for ``$(…)``, imported without yaml, which it rarely uses."""
    absent = "yaml" not in sys.modules
    if absent:
        sys.modules["yaml"] = ModuleType("yaml")
    try:
        return import_module(f"{_COPY}.substitution_args")
    finally:
        if absent:
            del sys.modules["yaml"]


substitution_args: Any = _import_substitution_args()
