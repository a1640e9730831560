"""The method coacd beside CoACD itself: ``python -m measure.benchmarks.collision_coacd FILE...``.

For each mesh that is named, or is in a folder that is named, the seconds of processor time, which
load hardly changes, and those of the clock, triangles, pieces and two largest distances, both
two-sided and relative to the diagonal: over all surfaces of all pieces, and of what can be touched.
Ours is the whole command, of CoACD only the call of its function. Its runs take minutes, and some
end the process, so each runs in one of its own. With ``--defaults FOLDER`` they are kept there, and
one that is there already is not run again; the row says so, since its seconds are of another time.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from urdftool.collision.distance import Surface, spread
from urdftool.collision.measure import ReferenceSurface, measure
from urdftool.collision.piece import make_mesh_piece
from urdftool.collision.surface import read_surface
from urdftool.geometry.load import load_mesh

from .timing import URDFTOOL

SUFFIXES = (".stl", ".obj", ".dae")
LIMIT = 900.0  # seconds after which CoACD's own run is given up

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
        Surface(a, spread(a, 80_000)).measure_distance(spread(b, 20_000).points).max()
        for a, b in ((one, other), (other, one))
    ]
    return max(distances) / size


class Row(NamedTuple):
    """What one side made of a mesh: seconds, numbers, and errors relative to the diagonal."""

    side: str
    processor: float
    clock: float
    triangles: int
    pieces: int
    error: float
    touched: float


def by_default(surface, made):
    with tempfile.TemporaryDirectory() as folder:
        given = f"{folder}/given.npz"
        np.savez(given, v=surface.vertices, f=surface.faces)
        words = [sys.executable, "-c", DEFAULT, given, str(made)]
        if not made.exists():
            try:
                subprocess.run(words, capture_output=True, timeout=LIMIT, check=True)
            except subprocess.SubprocessError:
                return None
        with np.load(made) as found:
            count = int(found["pieces"])
            pieces = [make_mesh_piece(found[f"v{k}"], found[f"f{k}"]) for k in range(count)]
            return float(found["processor"]), float(found["seconds"]), pieces


def by_ours(path):
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder, "made.obj")
        words = [*URDFTOOL, "-q", "collision", "mesh", path, "-o", made, "--method", "coacd"]
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        begin, used = time.perf_counter(), used_time()
        subprocess.run(
            [*map(str, words), "--no-cache"], capture_output=True, check=True, env=environment
        )
        seconds, processor = time.perf_counter() - begin, used_time() - used
        files = sorted(made.parent.glob("made_*.obj")) or [made]
        meshes = [load_mesh(file) for file in files]
        return processor, seconds, [make_mesh_piece(mesh.vertices, mesh.faces) for mesh in meshes]


def used_time():
    """Processor time [s] of processes that this one started and that have ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return children.ru_utime + children.ru_stime


def compared(path, folder) -> Iterator[tuple[str, Row | None]]:
    """Both sides of a mesh, CoACD's first; None for one that died or took too long."""
    kept = folder / f"{path.name}.npz"
    theirs = "kept" if kept.exists() else "default"
    surface = read_surface(path)
    target = ReferenceSurface(surface)
    for side, made in ((theirs, by_default(surface, kept)), ("ours", by_ours(path))):
        if made is None:
            yield side, None
            continue
        processor, seconds, pieces = made
        triangles = np.concatenate([piece.corners for piece in pieces])
        error = apart(surface.corners, triangles, surface.size)
        touched = measure(target, pieces).error
        yield side, Row(side, processor, seconds, len(triangles), len(pieces), error, touched)


def meshes(paths):
    """The files that are named, and those of folders that are."""
    for path in map(Path, paths):
        inside = sorted(path.iterdir()) if path.is_dir() else [path]
        yield from (file for file in inside if not path.is_dir() or file.suffix.lower() in SUFFIXES)


def main():
    reader = argparse.ArgumentParser()
    reader.add_argument("paths", nargs="+")
    reader.add_argument("--defaults", type=Path)
    given = reader.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = given.defaults or Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        for path in meshes(given.paths):
            before = None
            for side, row in compared(path, folder):
                print(f"{path.name[-50:]:50} {side:8} {said(row, before)}", flush=True)
                before = row


def said(row, before=None):
    """A row in words, and its times in parts of another's."""
    if row is None:
        return "died or took too long"
    text = (
        f"{row.processor:6.1f} s processor {row.clock:6.1f} s clock {row.triangles:6} triangles "
        f"{row.pieces:4} pieces {row.error:7.2%} touched {row.touched:.2%}"
    )
    if before is None:
        return text
    parts = [(row.processor, before.processor), (row.clock, before.clock)]
    parts += [(row.triangles, before.triangles), (row.error, before.error)]
    parts += [(row.touched, before.touched)]
    ratios = [f"{one / other:.2f}" for one, other in parts]
    return text + "  ({} processor, {} clock, {} triangles, {} error, {} touched)".format(*ratios)


if __name__ == "__main__":
    main()
