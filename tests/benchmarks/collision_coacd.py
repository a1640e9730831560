"""The method coacd beside CoACD itself: ``python -m tests.benchmarks.collision_coacd FILE``.

For each mesh that is named the seconds, triangles, pieces and the two-sided largest distance over
all surfaces of all pieces, relative to the diagonal. CoACD's own runs take minutes, and some end
the process, so each runs in one of its own.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from urdftool.collision.compute import Task, compute
from urdftool.collision.distance import Surface, spread
from urdftool.collision.settings import Settings
from urdftool.collision.surface import read_surface

DEFAULT = """
import sys, time, coacd, numpy as np
coacd.set_log_level("error")
given = np.load(sys.argv[1])
begin = time.perf_counter()
parts = coacd.run_coacd(coacd.Mesh(given["v"], given["f"]))
seconds = time.perf_counter() - begin
corners = np.concatenate([np.asarray(v)[np.asarray(f)] for v, f in parts])
np.savez(sys.argv[2], corners=corners, seconds=seconds, pieces=len(parts))
"""


def apart(one, other, size):
    distances = [
        Surface(a, spread(a, 80_000)).distance(spread(b, 20_000).points).max()
        for a, b in ((one, other), (other, one))
    ]
    return max(distances) / size


def by_default(surface):
    with tempfile.TemporaryDirectory() as folder:
        given, made = f"{folder}/given.npz", f"{folder}/made.npz"
        np.savez(given, v=surface.vertices, f=surface.faces)
        words = [sys.executable, "-c", DEFAULT, given, made]
        if subprocess.run(words, capture_output=True).returncode:
            return None
        with np.load(made) as found:
            return float(found["seconds"]), found["corners"], int(found["pieces"])


def main(paths):
    for path in paths:
        surface = read_surface(path)
        result = compute(Task(Path(path), settings=Settings(method="coacd")))
        corners = np.concatenate([piece.corners for piece in result.pieces])
        rows = [("default", by_default(surface))]
        rows.append(("ours", (result.seconds, corners, len(result.pieces))))
        for name, row in rows:
            if row is None:
                print(f"{Path(path).name:50} {name:8} died")
                continue
            seconds, made, pieces = row
            error = apart(surface.corners, made, surface.size)
            print(
                f"{Path(path).name:50} {name:8} {seconds:7.1f} s {len(made):6} triangles "
                f"{pieces:4} pieces {error:.2%}"
            )


if __name__ == "__main__":
    main(sys.argv[1:])
