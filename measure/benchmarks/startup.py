"""Start: ``--version`` and ``lint`` of one small URDF against importing click"""

from __future__ import annotations

from collections.abc import Iterator

from .robots import FIXTURES
from .table import Pairs, Table
from .timing import PYTHON, URDFTOOL, command, in_turn

PEERS = ("click",)
ROBOT = FIXTURES / "robots" / "ten_links.urdf"


def rows() -> Iterator[Table | str]:
    """A row for each of the two."""
    sides = {
        "python": command([PYTHON, "-c", "pass"]),
        "click": command([PYTHON, "-c", "import click"]),
        "--version": command([*URDFTOOL, "--version"]),
        "lint": command([*URDFTOOL, "lint", ROBOT]),
    }
    taken = in_turn(sides, rounds=31, label="--version, lint")
    pairs = Pairs("command", ["import click", "python -c pass"])
    for words in ("--version", "lint"):
        name = f"`urdftool {words}`" + (", 10 links, cached" if words == "lint" else "")
        pairs.add(
            name,
            {
                "urdftool": taken[words],
                "import click": taken["click"],
                "python -c pass": taken["python"],
            },
        )
    made = pairs.table()
    made.reading = [
        "The start of Python and click is the minimum of every command; a hook that lints one file "
        "per commit takes little more."
    ]
    yield made
