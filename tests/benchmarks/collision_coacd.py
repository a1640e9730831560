"""The method coacd beside CoACD itself: ``python -m tests.benchmarks.collision_coacd FILE...``.

For each mesh that is named the seconds, triangles, pieces and two largest distances, both two-sided
and relative to the diagonal: over all surfaces of all pieces, and of what can be touched.
CoACD's own runs take minutes, and some end the process, so each runs in one of its own. With
``--defaults FOLDER`` they are kept there, and one that is there already is not run again; the row
says so, since its seconds are of another time.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from urdftool.collision.compute import Task, compute
from urdftool.collision.distance import Surface, spread
from urdftool.collision.measure import Target, measure
from urdftool.collision.piece import mesh_piece
from urdftool.collision.settings import Settings
from urdftool.collision.surface import read_surface

DEFAULT = """
import sys, time, coacd, numpy as np
coacd.set_log_level("error")
given = np.load(sys.argv[1])
begin = time.perf_counter()
parts = coacd.run_coacd(coacd.Mesh(given["v"], given["f"]))
seconds = time.perf_counter() - begin
arrays = {f"v{k}": np.asarray(v, float) for k, (v, _) in enumerate(parts)}
arrays |= {f"f{k}": np.asarray(f, int) for k, (_, f) in enumerate(parts)}
np.savez(sys.argv[2], seconds=seconds, pieces=len(parts), **arrays)
"""


def apart(one, other, size):
    distances = [
        Surface(a, spread(a, 80_000)).distance(spread(b, 20_000).points).max()
        for a, b in ((one, other), (other, one))
    ]
    return max(distances) / size


def by_default(surface, made):
    with tempfile.TemporaryDirectory() as folder:
        given = f"{folder}/given.npz"
        np.savez(given, v=surface.vertices, f=surface.faces)
        words = [sys.executable, "-c", DEFAULT, given, str(made)]
        if not made.exists() and subprocess.run(words, capture_output=True).returncode:
            return None
        with np.load(made) as found:
            count = int(found["pieces"])
            pieces = [mesh_piece(found[f"v{k}"], found[f"f{k}"]) for k in range(count)]
            return float(found["seconds"]), pieces


def main():
    reader = argparse.ArgumentParser()
    reader.add_argument("paths", nargs="+")
    reader.add_argument("--defaults", type=Path)
    given = reader.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        compare(given.paths, given.defaults or Path(folder))


def compare(paths, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for path in paths:
        kept = folder / f"{Path(path).name}.npz"
        name = "kept" if kept.exists() else "default"
        surface = read_surface(path)
        result = compute(Task(Path(path), settings=Settings(method="coacd")))
        rows = [(name, by_default(surface, kept)), ("ours", (result.seconds, result.pieces))]
        target = Target(surface)
        for name, row in rows:
            if row is None:
                print(f"{Path(path).name:50} {name:8} died")
                continue
            seconds, pieces = row
            made = np.concatenate([piece.corners for piece in pieces])
            error = apart(surface.corners, made, surface.size)
            touched = measure(target, pieces).error
            print(
                f"{Path(path).name:50} {name:8} {seconds:7.1f} s {len(made):6} triangles "
                f"{len(pieces):4} pieces {error:.2%} touched {touched:.2%}"
            )


if __name__ == "__main__":
    main()
