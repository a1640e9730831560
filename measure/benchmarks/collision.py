"""``collision`` against V-HACD"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from . import peers
from .meshes import bumpy_torus, write_stl
from .robots import example_folder
from .simplify import ruled
from .table import Table, cell
from .timing import URDFTOOL, Call, Taken, command, in_turn

PEERS = ("pybullet", "coacd")
LIMIT = 150.0
MESHES = ("wrist_roll_follower_so101_v1.stl", "torso_2.STL")
ABOUT = """\
Whole commands, without a cache. V-HACD is that of PyBullet with its defaults. **Error** is the
largest distance between the surfaces of the pieces and of the mesh, in both directions, relative
to the diagonal, measured by MeshLab: cuts inside the body count, although they cannot be touched.
`auto` takes the cheapest method within 1 % of error, which may not be convex pieces."""

V_HACD = """
import sys, pybullet
pybullet.vhacd(sys.argv[1], sys.argv[2], sys.argv[2] + ".log")
"""


def rows() -> Iterator[Table | str]:
    """A row for each mesh and method."""
    chosen = peers.python()
    table = Table(["mesh", "made by", "time, memory", "triangles", "pieces", "error"])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in meshes(folder):
            sides: dict[str, Call] = {}
            made: dict[str, Path] = {}
            for method in ("auto", "coacd"):
                side = f"urdftool, {method}"
                made[side] = folder / f"{method}.stl"
                sides[side] = ours(path, made[side], method)
            if chosen and peers.has("pybullet"):
                made["V-HACD"] = folder / "vhacd.obj"
                given = as_obj(path, folder / "given.obj")
                words = [chosen, "-c", V_HACD, given, made["V-HACD"]]
                sides["V-HACD"] = command(words, codes=(0,), limit=LIMIT)
            taken = in_turn(sides, rounds=1, budget=15, label=path.name)
            for side in sides:
                table.rows.append(line(path, side, taken[side], made[side]))
    if not any(row[1] == "V-HACD" for row in table.rows):
        yield peers.missing("pybullet")
    table.reading = [
        "Fewer triangles and pieces make a simulation faster, at the cost of a larger error. CoACD "
        "with its own defaults takes minutes per mesh; see its section."
    ]
    yield table


def ours(path: Path, made: Path, method: str) -> Call:
    words = [*URDFTOOL, "-q", "collision", "mesh", path, "-o", made, "--method", method]
    return command([*words, "--no-cache", "--overwrite", "--format", "json"], limit=LIMIT)


def line(path: Path, side: str, taken: Taken, made: Path) -> Sequence[str]:
    """A row: what was made, and how far it is from the mesh."""
    said = None if taken.why or not made.exists() else ruled(path, made)
    if said is None:
        return path.name, side, cell(taken), "–", "–", taken.why or "–"
    triangles, pieces, error = said
    return path.name, side, cell(taken), f"{triangles:,}", str(pieces_of(made, pieces)), _p(error)


def _p(error: float) -> str:
    return f"{100 * error:.1f} %"


def pieces_of(made: Path, parts: int) -> int:
    """Convex pieces: groups of an OBJ, files beside an STL, or its connected parts."""
    if made.suffix == ".obj":
        return sum(text.startswith("o ") for text in made.read_text("utf-8").splitlines()) or parts
    return len(list(made.parent.glob(f"{made.stem}_[0-9]*{made.suffix}"))) or 1


def as_obj(path: Path, target: Path) -> Path:
    """The mesh as an OBJ, each vertex once."""
    from urdftool.collision.surface import read_surface

    surface = read_surface(path)
    with open(target, "w", encoding="utf-8") as file:
        file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in surface.vertices)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in surface.faces + 1)
    return target


def meshes(folder: Path) -> Iterator[Path]:
    """Of robots, and a made one."""
    data = example_folder()
    for name in MESHES:
        found = sorted(data.rglob(name)) if data else []
        yield from found[:1]
    yield write_stl(folder / "torus.stl", *bumpy_torus(10_000))
