"""Imports that cost their time when they are used, not when they are named."""

from __future__ import annotations

import sys
from importlib.util import LazyLoader, find_spec, module_from_spec
from types import ModuleType


def import_lazily(name: str) -> None:
    """Make a module importable at no cost; its first use loads it."""
    if name in sys.modules:
        return
    spec = find_spec(name)
    if spec is None or spec.loader is None:
        return
    spec.loader = LazyLoader(spec.loader)
    module = module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)


def is_loaded(module: ModuleType) -> bool:
    """Whether a module has been loaded, and not only named."""
    return type(module) is ModuleType
