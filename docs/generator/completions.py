"""What a shell sources or loads to complete ``urdftool``, as the wheel brings it.

The scripts are click's; they ask ``urdftool`` itself, so they stay right whatever it learns.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from click.shell_completion import BashComplete, FishComplete, ZshComplete

from urdftool import cli

FOLDER = Path(__file__).resolve().parents[1] / "completions"
SHELLS = {"urdftool.bash": BashComplete, "_urdftool": ZshComplete, "urdftool.fish": FishComplete}


def completions() -> Iterator[tuple[Path, str]]:
    """Every script with its text."""
    for name, shell in SHELLS.items():
        yield FOLDER / name, shell(cli.main, {}, "urdftool", "_URDFTOOL_COMPLETE").source().lstrip()
