"""The command-line toolchain for robot descriptions, as a library.

    >>> import urdftool
    >>> robot = urdftool.load("arm.urdf.xacro", args={"prefix": "left_"})
    >>> for finding in urdftool.check("arm.urdf.xacro"):
    ...     print(finding)

Each name is loaded when it is first used, so that importing the package costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

__version__ = "0.1.0"

_HOMES = {
    "Finding": "finding",
    "Robot": "model.elements",
    "Severity": "finding",
    "UrdftoolError": "errors",
    "check": "lint.run",
    "compute_inertia": "inertia.compute",
    "expand": "api",
    "load": "model.load",
}

__all__ = [
    "Finding",
    "Robot",
    "Severity",
    "UrdftoolError",
    "__version__",
    "check",
    "compute_inertia",
    "expand",
    "load",
]

if TYPE_CHECKING:
    from .api import expand
    from .errors import UrdftoolError
    from .finding import Finding, Severity
    from .inertia.compute import compute_inertia
    from .lint.run import check
    from .model.elements import Robot
    from .model.load import load


def __getattr__(name: str) -> object:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'urdftool' has no attribute {name!r}")
    from importlib import import_module

    value = globals()[name] = getattr(import_module(f".{home}", __name__), name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
