"""Find physics engines by name, whether they are installed, and how to install them."""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable, Iterable
from importlib import import_module

from ...errors import MissingDependency
from ...extras import install_command, is_installed, make_missing_error
from .base import Capabilities, Engine

REGISTRY = {
    "pybullet": "pybullet",
    "mujoco": "mujoco",
}
"""Package of each engine, by the name of ``--engine``; the preferred one first."""

BOTH = "both"
"""Value of ``--engine`` that compares the first two engines."""


def load_engine(name: str) -> Engine:
    """Import an engine's package, which imports no library."""
    engine: Engine = import_module(f"{__package__}.{REGISTRY[name]}").ENGINE
    return engine


def get_engine_names(option: str) -> tuple[str, ...]:
    """Return the engines that a value of ``--engine`` runs."""
    return tuple(REGISTRY)[:2] if option == BOTH else (option,)


def get_library(name: str) -> str:
    """Return the Python package that an engine imports."""
    return load_engine(name).capabilities.library


def name_alternative(name: str, suits: Callable[[Capabilities], bool]) -> str:
    """Name the first other engine with suitable capabilities, as ``--engine mujoco``, or empty."""
    others = (load_engine(other).capabilities for other in REGISTRY if other != name)
    return next((f"--engine {other.name}" for other in others if suits(other)), "")


def choose_default_engine() -> str:
    """Choose the first engine that is installed.

    Raises:
        MissingDependency: None is installed.
    """
    for name in REGISTRY:
        if is_installed(get_library(name)):
            return name
    raise MissingDependency(
        f"'urdftool simulate' requires a physics engine, and none is installed: {_get_advice()}",
        library=get_extra_library(),
    )


def check_engines(names: Iterable[str]) -> None:
    """Refuse engines, keys of ``REGISTRY``, that are not installed, before any work is done.

    Raises:
        MissingDependency: An engine is not installed; the message has the command to install it.
    """
    for name in names:
        engine = load_engine(name)
        known = engine.capabilities
        if is_installed(known.library):
            continue
        if engine.has_wheel():
            raise make_missing_error(known.library, f"--engine {name}")
        raise MissingDependency(
            f"{known.title} is not installed and has wheels for {known.wheels} only, not for "
            f"{_format_here()}: {_get_advice()}",
            library=known.library,
        )


def get_extra_library() -> str:
    """Return the engine's library that the extra ``simulate`` installs on this machine."""
    *preferred, last = REGISTRY
    return get_library(next((name for name in preferred if load_engine(name).has_wheel()), last))


def _get_advice() -> str:
    """Describe which engine can be installed on this machine, and how."""
    if load_engine(next(iter(REGISTRY))).has_wheel():
        return install_command("simulate")
    for name in REGISTRY:
        if is_installed(get_library(name)):
            return f"use --engine {name}"
    for name in REGISTRY:
        if load_engine(name).has_wheel():
            return f"use --engine {name}, after {install_command('simulate')}"
    titles = " nor ".join(load_engine(name).capabilities.title for name in REGISTRY)
    return (
        f"neither {titles} has a wheel for {_format_here()}; simulate on Linux, macOS or "
        "Windows on x86-64, or on Linux or macOS on ARM"
    )


def _format_here() -> str:
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return f"Python {version} on {platform.system()} {platform.machine()}"
