"""``--version`` and ``lint`` of one URDF against importing click."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from .timing import PYTHON, URDFTOOL, in_turn, row, run

ROBOT = Path(__file__).parents[2] / "fixtures" / "robots" / "ten_links.urdf"


def rows() -> Iterator[str]:
    """A row for each of the two; 2.0 and 3.0 are the bounds that were set."""
    medians = in_turn(
        {
            "import click": run([PYTHON, "-c", "import click"]),
            "--version": run([*URDFTOOL, "--version"]),
            "lint": run([*URDFTOOL, "lint", str(ROBOT)]),
        },
        rounds=31,
    )
    yield row("urdftool --version (at most 2.0)", medians, "--version", "import click")
    yield row("urdftool lint, 10 links (at most 3.0)", medians, "lint", "import click")
