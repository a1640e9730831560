"""``inertia mesh`` against trimesh"""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

from . import peers
from .meshes import bumpy_torus, write_stl
from .robots import example_folder
from .table import Pairs, Table
from .timing import URDFTOOL, Call, command, in_turn

PEERS = ("trimesh",)
MESHES = ("z1_Link01.STL", "torso_2.STL")
ABOUT = """\
Whole commands: mass, center of mass and inertia of a mesh file. trimesh integrates over the
triangles as they are. urdftool does so if the mesh is closed and oriented; otherwise it repairs it
first or uses its hull, and prints the method."""

TRIMESH = """
import sys, json, trimesh
mesh = trimesh.load_mesh(sys.argv[1])
mesh.density = 1000.0
print("INERTIA", json.dumps([mesh.mass, mesh.moment_inertia.tolist()]))
"""


def rows() -> Iterator[Table | str]:
    """A row a mesh."""
    chosen = peers.python()
    has = bool(chosen) and peers.has("trimesh")
    if not has:
        yield peers.missing("trimesh")
    pairs = Pairs("mesh", ["trimesh"] if has else [], extra=["their masses differ by"])
    with tempfile.TemporaryDirectory() as folder:
        for path in _meshes(Path(folder)):
            words = [*URDFTOOL, "inertia", "mesh", path, "--density", "1000", "--format", "json"]
            sides: dict[str, Call] = {"urdftool": command(words)}
            if has:
                sides["trimesh"] = command([chosen or "", "-c", TRIMESH, path], codes=(0,))
            taken = in_turn(sides, rounds=7, budget=10, label=path.name)
            apart = "–"
            if has and not taken["trimesh"].why and not taken["urdftool"].why:
                ours = _mass(taken["urdftool"].out)
                match = re.search(r"^INERTIA (.*)$", taken["trimesh"].out, re.MULTILINE)
                theirs = json.loads(match[1])[0] if match else None
                apart = f"{abs(ours - theirs) / abs(theirs):.0e}" if ours and theirs else "–"
            pairs.add(path.name, taken, apart)
    yield pairs.table(
        "Where masses differ the mesh is not closed, or faces inwards in places: trimesh "
        "gives a number all the same, and urdftool takes its time to find one that means something."
    )


def _mass(text: str) -> float | None:
    match = re.search(r'"mass":\s*([-+.\deE]+)', text)
    return float(match[1]) if match else None


def _meshes(folder: Path) -> Iterator[Path]:
    data = example_folder()
    for name in MESHES:
        found = sorted(data.rglob(name)) if data else []
        yield from found[:1]
    for triangles in (10_000, 100_000):
        yield write_stl(folder / f"torus_{triangles}.stl", *bumpy_torus(triangles))
