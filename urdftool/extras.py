"""Optional libraries: the extra that installs each, and the error for a missing one."""

from __future__ import annotations

from importlib.util import find_spec

from .errors import MissingDependency

EXTRA_OF = {
    "scipy": "mesh",
    "manifold3d": "mesh",
    "coacd": "mesh",
    "yourdfpy": "mesh",
    "pygraphviz": "draw",
    "PIL": "draw",
    "matplotlib": "draw",
    "pybullet": "simulate",
    "mujoco": "mujoco",
    "viser": "view",
    "distributed": "dask",
    "pxr": "usd",
    "newton": "usd-verify",
    "robot_descriptions": "robots",
    "fcl": "srdf",
    "pygls": "server",
    "lsprotocol": "server",
}
"""Extra that installs each optional library, by import name."""

DISTRIBUTION_OF = {
    "fcl": "python-fcl",
    "PIL": "Pillow",
    "matplotlib": "Matplotlib",
    "pxr": "usd-core",
}
"""Names on the package index that differ from the import name."""


def is_installed(library: str) -> bool:
    """Tell whether a library can be imported, without importing it."""
    return find_spec(library) is not None


def require(purpose: str, *libraries: str) -> None:
    """Check that libraries are installed, before any work starts.

    Args:
        purpose: Subject of the error message, such as ``'urdftool collision'``.
        libraries: Import names.

    Raises:
        MissingDependency: One of them is not installed.
    """
    for library in libraries:
        if not is_installed(library):
            raise make_missing_error(library, purpose)


def make_missing_error(library: str, purpose: str) -> MissingDependency:
    """Create the error for a library that is not installed."""
    name = DISTRIBUTION_OF.get(library, library)
    return MissingDependency(
        f"{purpose} requires {name}, which is not installed: {install_command(EXTRA_OF[library])}",
        library=library,
    )


def install_command(extra: str) -> str:
    """Return the command that installs an extra."""
    return f"pip install 'urdftool[{extra}]'"


def find_missing_library(error: BaseException) -> str | None:
    """Return the optional library that caused an error; None for any other error."""
    if isinstance(error, MissingDependency):
        return error.library or None
    name = error.name if isinstance(error, ModuleNotFoundError) else None
    library = (name or "").partition(".")[0]
    return library if library in EXTRA_OF else None


def is_own_module(error: ModuleNotFoundError) -> bool:
    """Tell whether the module that is not found is one of urdftool, or has no name."""
    return (error.name or __package__).partition(".")[0] == __package__
