"""How cost grows with triangles"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from .meshes import bumpy_torus, write_stl
from .table import Table, cell
from .timing import URDFTOOL, command, in_turn

COUNTS = (10_000, 100_000, 500_000, 2_000_000)
LIMIT = 90.0
ABOUT = f"""\
A binary STL of a torus with waves, no two triangles in a plane. Caches are off; runs
longer than {LIMIT:.0f} s are stopped."""

ROBOT = """\
<robot name="one"><link name="base"><visual><geometry><mesh filename="{}"/></geometry></visual>
</link></robot>
"""


def rows() -> Iterator[Table | str]:
    """A row for each size."""
    commands = ("inertia mesh", "collision mesh --method simplify", "view --picture", "lint")
    table = Table(["triangles", *(f"`{words}`" for words in commands)])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for count in COUNTS:
            mesh = write_stl(folder / "mesh.stl", *bumpy_torus(count))
            robot = folder / "one.urdf"
            robot.write_text(ROBOT.format(mesh.name), "utf-8")
            made = folder / "made.stl"
            cells = []
            for words in (
                ["inertia", "mesh", mesh, "--mass", "1"],
                ["collision", "mesh", mesh, "-o", made, "--method", "simplify", "--no-cache"],
                ["view", robot, "--picture", folder / "picture.png"],
                ["lint", robot, "--no-cache"],
            ):
                more = ["--overwrite"] if words[0] == "collision" else []
                call = command([*URDFTOOL, "-q", *words, *more], cwd=folder, limit=LIMIT)
                label = f"{words[0]}, {count:,} triangles"
                cells.append(cell(in_turn({"it": call}, rounds=3, budget=6, label=label)["it"]))
            table.rows.append([f"{count:,}", *cells])
    table.reading = [
        "Simplification is a small part of `collision`; most of the time is the measurement of the "
        "error between both surfaces."
    ]
    yield table
