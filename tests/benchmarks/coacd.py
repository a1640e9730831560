"""``collision --method coacd`` against CoACD's own defaults"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from . import peers
from .collision import line, meshes, ours
from .robots import example_folder
from .table import Table
from .timing import Call, command, in_turn

PEERS = ("coacd",)
MORE = ("z1_Link03.STL", "torso_lift_link.stl")
LIMIT = 900.0
ABOUT = f"""\
Whole commands; CoACD's `run_coacd` with its defaults is stopped after {LIMIT / 60:.0f} minutes.
Errors are measured as above."""

DEFAULT = """
import sys, coacd, numpy as np
coacd.set_log_level("error")
with np.load(sys.argv[1]) as given:
    parts = coacd.run_coacd(coacd.Mesh(given["vertices"], given["faces"]))
with open(sys.argv[2], "w") as file:
    first = 1
    for number, (vertices, faces) in enumerate(parts):
        file.write(f"o piece_{number}\\n")
        file.writelines("v %.9g %.9g %.9g\\n" % tuple(row) for row in vertices)
        file.writelines("f %d %d %d\\n" % tuple(row) for row in np.asarray(faces) + first)
        first += len(vertices)
"""


def rows() -> Iterator[Table | str]:
    """A row for each mesh and side."""
    import numpy as np

    from urdftool.collision.surface import read_surface

    chosen = peers.python()
    if chosen is None or not peers.has("coacd"):
        yield peers.missing("coacd")
        return
    table = Table(["mesh", "made by", "time, memory", "triangles", "pieces", "error"])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        data = example_folder()
        more = [found for part in MORE if data for found in sorted(data.rglob(part))[:1]]
        for path in (*meshes(folder), *more):
            surface = read_surface(path)
            given = folder / "given.npz"
            np.savez(given, vertices=surface.vertices, faces=surface.faces)
            made = {"urdftool, coacd": folder / "ours.stl", "CoACD": folder / "default.obj"}
            sides: dict[str, Call] = {
                "urdftool, coacd": ours(path, made["urdftool, coacd"], "coacd"),
                "CoACD": command(
                    [chosen, "-c", DEFAULT, given, made["CoACD"]], codes=(0,), limit=LIMIT
                ),
            }
            taken = in_turn(sides, rounds=1, budget=0, label=path.name)
            for side in sides:
                table.rows.append(line(path, side, taken[side], made[side]))
                made[side].unlink(missing_ok=True)
    table.reading = [
        "Both cut by CoACD; urdftool first takes triangles away that the error allows, and caps "
        "the vertices of a piece."
    ]
    yield table
