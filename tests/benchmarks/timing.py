"""Time commands in turn, and say what came of it."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

PYTHON = sys.executable
URDFTOOL = [str(Path(PYTHON).parent / "urdftool")]
CORPUS = Path(__file__).resolve().parents[3] / "shared" / "corpus"


def run(command: Sequence[str], *, env: Mapping[str, str] | None = None) -> Callable[[], None]:
    """A call of a command whose output nobody reads; it may exit 0 or 1, but not fail.

    Python's bytecode cache is on, as it is for whoever has installed both sides.
    """
    chosen = dict(os.environ if env is None else env)
    chosen.pop("PYTHONDONTWRITEBYTECODE", None)

    def call() -> None:
        done = subprocess.run(
            command,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=chosen,
            check=False,
        )
        assert done.returncode in (0, 1), command

    return call


def in_turn(sides: Mapping[str, Callable[[], None]], rounds: int = 9) -> dict[str, float]:
    """The median seconds of each side, all sides once in each round."""
    taken: dict[str, list[float]] = {name: [] for name in sides}
    for call in sides.values():
        call()  # warm the caches of the file system
    for _ in range(rounds):
        for name, call in sides.items():
            begin = time.perf_counter()
            call()
            taken[name].append(time.perf_counter() - begin)
    return {name: statistics.median(times) for name, times in taken.items()}


def row(what: str, medians: Mapping[str, float], ours: str, theirs: str) -> str:
    """``what: 0.071 s against 0.045 s, ratio 1.58``."""
    ratio = medians[ours] / medians[theirs]
    return (
        f"{what:<44} {ours} {medians[ours]:.3f} s   {theirs} {medians[theirs]:.3f} s   "
        f"ratio {ratio:.2f}"
    )
