"""Optional libraries: which extra installs each, and the message where one is missing."""

from __future__ import annotations

from importlib.util import find_spec

from .errors import MissingDependency

EXTRA_OF = {
    "scipy": "mesh",
    "manifold3d": "mesh",
    "collada": "mesh",
    "coacd": "mesh",
    "pygraphviz": "draw",
    "PIL": "draw",
    "matplotlib": "draw",
    "pybullet": "simulate",
    "mujoco": "mujoco",
    "viser": "view",
    "distributed": "dask",
}
"""The extra that installs each optional library, by the name it is imported under."""

DISTRIBUTION_OF = {"collada": "pycollada", "PIL": "Pillow", "matplotlib": "Matplotlib"}
"""Names on the package index that are not the name of the import."""


def is_installed(library: str) -> bool:
    """Tell whether a library can be imported, without importing it."""
    return find_spec(library) is not None


def require(purpose: str, *libraries: str) -> None:
    """Check that libraries are installed, before any work is done.

    Args:
        purpose: What requires them, as the subject of a sentence: ``'urdftool collision'``.
        libraries: Names of imports.

    Raises:
        MissingDependency: One of them is not installed.
    """
    for library in libraries:
        if not is_installed(library):
            raise missing(library, purpose)


def missing(library: str, purpose: str) -> MissingDependency:
    """Make the error about a library that is not installed."""
    name = DISTRIBUTION_OF.get(library, library)
    return MissingDependency(
        f"{purpose} requires {name}, which is not installed: {install_command(EXTRA_OF[library])}",
        library=library,
    )


def install_command(extra: str) -> str:
    """Return the command that installs an extra."""
    return f"pip install 'urdftool[{extra}]'"


def missing_library(error: BaseException) -> str | None:
    """Find the optional library that an error is about; None if it is about something else."""
    if isinstance(error, MissingDependency):
        return error.library or None
    name = error.name if isinstance(error, ModuleNotFoundError) else None
    library = (name or "").partition(".")[0]
    return library if library in EXTRA_OF else None
