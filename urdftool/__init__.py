"""Toolchain for robot descriptions, as a library.

    >>> import urdftool
    >>> robot = urdftool.load("arm.urdf.xacro", args={"prefix": "left_"})
    >>> for finding in urdftool.check("arm.urdf.xacro"):
    ...     print(finding)

Each name is imported on first use, so that importing the package stays fast.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

__version__ = "0.1.0"

_HOMES = {
    "Finding": "finding",
    "Robot": "model.elements",
    "Severity": "diagnostic",
    "UrdftoolError": "errors",
    "check": "api.lint",
    "compute_inertia": "inertia.compute",
    "expand": "api.expand",
    "export_mjcf": "api.export",
    "export_sdf": "api.export",
    "export_urdf": "api.export_urdf",
    "export_usd": "api.export_usd",
    "fix": "api.fix",
    "load": "api.load",
    "simplify_collisions": "api.collisions",
    "simulate": "api.simulate",
    "verify": "api.verify",
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
    "export_mjcf",
    "export_sdf",
    "export_urdf",
    "export_usd",
    "fix",
    "load",
    "simplify_collisions",
    "simulate",
    "verify",
]

if TYPE_CHECKING:
    from .api.collisions import simplify_collisions
    from .api.expand import expand
    from .api.export import export_mjcf, export_sdf
    from .api.export_urdf import export_urdf
    from .api.export_usd import export_usd
    from .api.fix import fix
    from .api.lint import check
    from .api.load import load
    from .api.simulate import simulate
    from .api.verify import verify
    from .diagnostic import Severity
    from .errors import UrdftoolError
    from .finding import Finding
    from .inertia.compute import compute_inertia
    from .model.elements import Robot


def __getattr__(name: str) -> object:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'urdftool' has no attribute {name!r}")
    from importlib import import_module

    value = globals()[name] = getattr(import_module(f".{home}", __name__), name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
