"""``urdftool cmake-dir``: the folder of the CMake functions."""

from __future__ import annotations

from pathlib import Path

import click

from .grouped_help import GroupedCommand

FOLDER = Path(__file__).resolve().parents[1] / "cmake"


@click.command("cmake-dir", cls=GroupedCommand, groups={})
def command() -> None:
    """Print the folder of the CMake functions urdftool_expand and urdftool_lint.

    find_package(urdftool) finds them itself where the environment of urdftool is active. Otherwise,
    pass the folder to CMake:

    \b
        cmake -S . -B build -Durdftool_DIR="$(urdftool cmake-dir)"
    """  # noqa: D301 -- click reads the escape
    click.echo(FOLDER)
