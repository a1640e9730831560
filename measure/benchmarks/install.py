"""Installation: the core, in a new environment, against simcheck and ruff"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from .peers import ROOT
from .robots import FIXTURES
from .table import Table

PEERS = ()
ROUNDS = 3
URDF = FIXTURES / "robots" / "ten_links.urdf"
ABOUT = """\
`pip install --no-cache-dir` into a new environment, from the same index, in turn. **Size** is what
came into it, compiled files included, without pip itself. **First finding** is the time from the
empty environment to the end of the first check of one file, the download included: the network's
share differs from machine to machine and from run to run."""

SIDES = {
    "urdftool": (str(ROOT), ["urdftool", "lint", str(URDF)]),
    "urdftool[all]": (f"{ROOT}[all]", ["urdftool", "lint", str(URDF)]),
    "simcheck": ("simcheck", ["simcheck", str(URDF), "--static-only"]),
    "ruff": ("ruff", ["ruff", "check", str(Path(__file__))]),
}


def rows() -> Iterator[Table | str]:
    """A row for each tool."""
    seconds: dict[str, list[float]] = {name: [] for name in SIDES}
    sizes: dict[str, float] = {}
    packages: dict[str, int] = {}
    for _ in range(ROUNDS):
        for name, (requirement, first) in SIDES.items():
            with tempfile.TemporaryDirectory() as folder:
                taken, sizes[name], packages[name] = _install(Path(folder), requirement, first)
                seconds[name].append(taken)
    table = Table(["installed", "size", "packages", "first finding"])
    for name in SIDES:
        table.rows.append(
            [name, f"{sizes[name]:.0f} MB", str(packages[name]), f"{median(seconds[name]):.1f} s"]
        )
    yield table


def _install(folder: Path, requirement: str, first: list[str]) -> tuple[float, float, int]:
    """Install a tool and run it once: seconds, megabytes, packages."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    size = (python, "-c", f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{_SIZE}")
    begin = time.perf_counter()
    pip = ("-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-cache-dir")
    subprocess.run([python, *pip, requirement], check=True, stderr=subprocess.DEVNULL)
    program = python.with_name(first[0])
    done = subprocess.run([program, *first[1:]], capture_output=True, cwd=folder, check=False)
    assert done.returncode in (0, 1), done.stderr
    taken = time.perf_counter() - begin
    said = subprocess.run(size, check=True, capture_output=True, text=True).stdout.split()
    return taken, float(said[0]), int(said[1])


_SIZE = """
from tests.installed_size import sizes
found = sizes()
print(sum(found.values()), sum(name.endswith(".dist-info") for name in found))
"""
