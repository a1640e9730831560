"""The method coacd beside CoACD itself: ``python -m tests.benchmarks.collision_coacd FILE...``.

For each mesh that is named the seconds of processor time, which load hardly changes, and those of
the clock, triangles, pieces and two largest distances, both two-sided and relative to the diagonal:
over all surfaces of all pieces, and of what can be touched. CoACD's own runs take minutes, and some
end the process, so each runs in one of its own. With ``--defaults FOLDER`` they are kept there, and
one that is there already is not run again; the row says so, since its seconds are of another time.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
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
begin, used = time.perf_counter(), time.process_time()
parts = coacd.run_coacd(coacd.Mesh(given["v"], given["f"]))
seconds, processor = time.perf_counter() - begin, time.process_time() - used
arrays = {f"v{k}": np.asarray(v, float) for k, (v, _) in enumerate(parts)}
arrays |= {f"f{k}": np.asarray(f, int) for k, (_, f) in enumerate(parts)}
np.savez(sys.argv[2], seconds=seconds, processor=processor, pieces=len(parts), **arrays)
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
            return float(found["processor"]), float(found["seconds"]), pieces


def by_ours(path):
    begin, used = time.perf_counter(), used_time()
    pieces = compute(Task(path, settings=Settings(method="coacd"))).pieces
    return used_time() - used, time.perf_counter() - begin, pieces


def used_time():
    """Processor time [s] of this process and of those that it started and that have ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


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
        theirs = "kept" if kept.exists() else "default"
        surface = read_surface(path)
        target = Target(surface)
        for name, row in ((theirs, by_default(surface, kept)), ("ours", by_ours(Path(path)))):
            if row is None:
                print(f"{Path(path).name:50} {name:8} died")
                continue
            processor, seconds, pieces = row
            made = np.concatenate([piece.corners for piece in pieces])
            error = apart(surface.corners, made, surface.size)
            touched = measure(target, pieces).error
            print(
                f"{Path(path).name:50} {name:8} {processor:7.1f} s ({seconds:.1f} s by the clock) "
                f"{len(made):6} triangles {len(pieces):4} pieces {error:.2%} touched {touched:.2%}",
                flush=True,
            )


if __name__ == "__main__":
    main()
