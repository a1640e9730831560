"""Write the completion scripts of shells that the wheel contains.

The scripts are those of click. They call ``urdftool`` for the words, so they do not depend on its
options.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from click.shell_completion import BashComplete, FishComplete, ZshComplete

from urdftool import cli

FOLDER = Path(__file__).resolve().parents[1] / "completions"
SHELLS = {"urdftool.bash": BashComplete, "_urdftool": ZshComplete, "urdftool.fish": FishComplete}


def list_completions() -> Iterator[tuple[Path, str]]:
    """Yield every script with its text."""
    for name, shell in SHELLS.items():
        yield FOLDER / name, shell(cli.main, {}, "urdftool", "_URDFTOOL_COMPLETE").source().lstrip()
