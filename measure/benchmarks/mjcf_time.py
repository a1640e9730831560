"""How long an export takes beside ``import mujoco``, each in a new process, in turn."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

FIXTURES = Path(__file__).parents[2] / "fixtures" / "formats" / "mjcf"
ROUNDS = 9


def table(folder: Path, only: str) -> str:
    """Medians, and their ratio."""
    urdftool = [sys.executable, "-m", "urdftool", "export", "mjcf"]
    commands = {
        "import mujoco": [sys.executable, "-c", "import mujoco"],
        "export without meshes": [*urdftool, str(FIXTURES / "arm.urdf"), "-o", str(folder / "arm")],
    }
    times: dict[str, list[float]] = {name: [] for name in commands}
    for _ in range(ROUNDS):
        for name, command in commands.items():
            start = time.perf_counter()
            subprocess.run(command, check=True, capture_output=True)
            times[name].append(time.perf_counter() - start)
    medians = {name: statistics.median(values) for name, values in times.items()}
    base = medians["import mujoco"]
    rows = [f"| {name} | {1000 * t:.0f} | {t / base:.2f} |" for name, t in medians.items()]
    return "\n".join(["| | ms | ratio |", "|---|---|---|", *rows])
