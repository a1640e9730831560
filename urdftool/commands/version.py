"""Print the version and, with ``-v``, the environment for a bug report."""

from __future__ import annotations

import click

from .. import __version__
from ..console import Console

CORE = ("click", "lxml", "numpy", "PyYAML", "trimesh", "xacro")


def print_version(console: Console) -> None:
    """Print the version; for a verbose console also Python, the libraries and the extras."""
    click.echo(f"urdftool {__version__}")
    if console.verbosity > 0:
        for line in describe_environment():
            click.echo(line)


def describe_environment() -> list[str]:
    """Describe Python, the machine, and each library with its version, by extra."""
    import platform
    import sys

    from ..extras import DISTRIBUTION_OF, EXTRA_OF, install_command
    from ..simulation.engines.registry import get_extra_library

    lines = [
        f"Python {platform.python_version()} on {platform.platform()}: {sys.executable}",
        f"core: {', '.join(f'{name} {_get_version(name)}' for name in CORE)}",
    ]
    for extra in dict.fromkeys(EXTRA_OF.values()):
        libraries = [library for library, of in EXTRA_OF.items() if of == extra]
        if extra == "simulate":
            libraries = [get_extra_library()]
        names = [DISTRIBUTION_OF.get(library, library) for library in libraries]
        versions = {name: _get_version(name) for name in names}
        text = ", ".join(f"{name} {version or 'missing'}" for name, version in versions.items())
        advice = "" if all(versions.values()) else f" ({install_command(extra)})"
        lines.append(f"[{extra}]: {text}{advice}")
    return lines


def _get_version(distribution: str) -> str | None:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(distribution)
    except PackageNotFoundError:
        return None
