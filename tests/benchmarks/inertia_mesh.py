"""Time ``load_mesh`` and ``estimate_mass_properties`` against trimesh on one large STL, in turn.

Run: python tests/benchmarks/inertia_mesh.py [TRIANGLES] [ROUNDS]
"""

import statistics
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import trimesh

from urdftool.inertia.estimate import estimate_mass_properties
from urdftool.meshes.load import load_mesh


def torus(triangles: int) -> trimesh.Trimesh:
    sections = max(8, round((triangles / 2) ** 0.5))
    return trimesh.creation.torus(0.1, 0.03, major_sections=sections, minor_sections=sections)


def ours(path: Path) -> np.ndarray:
    mesh = load_mesh(path)
    return estimate_mass_properties(mesh.vertices, mesh.faces, density=1.0).properties.inertia


def theirs(path: Path) -> np.ndarray:
    return trimesh.load_mesh(path).moment_inertia


def main(triangles: int, rounds: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "torus.stl"
        mesh = torus(triangles)
        mesh.export(path)
        times: dict[str, list[float]] = {"urdftool": [], "trimesh": []}
        for _ in range(rounds):
            for name, function in (("urdftool", ours), ("trimesh", theirs)):
                start = time.perf_counter()
                result = function(path)
                times[name].append(time.perf_counter() - start)
        difference = np.abs(ours(path) - result).max() / np.abs(result).max()
    medians = {name: statistics.median(values) for name, values in times.items()}
    print(f"{len(mesh.faces)} triangles, {rounds} rounds")
    for name, seconds in medians.items():
        print(f"{name:10} {seconds * 1000:8.1f} ms")
    print(f"ratio      {medians['urdftool'] / medians['trimesh']:8.2f}")
    print(f"difference {difference:.1e}")


if __name__ == "__main__":
    words = [*sys.argv[1:], "100000", "7"] if len(sys.argv) == 1 else [*sys.argv[1:], "7"]
    main(int(words[0]), int(words[1]))
