"""The method ``simplify`` against fast-simplification and pymeshlab"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from . import peers
from .meshes import bumpy_torus, write_stl
from .robots import example_folder
from .table import Pairs, Table
from .timing import PYTHON, Call, Taken, command, in_turn

PEERS = ("fast-simplification", "pymeshlab")
TARGET = 1000
MESHES = (
    "z1_description/meshes/visual/z1_Link01.STL",
    "so_arm_description/meshes/wrist_roll_pitch_so101_v2.stl",
    "talos_data/meshes/torso/torso_2.STL",
)
ABOUT = f"""\
Each library makes {TARGET:,} triangles of the same vertices and faces with its defaults; the
seconds are those of the call alone, the memory of the whole process. **Error** is the largest
distance of the two surfaces, both ways, relative to the diagonal, by MeshLab's own measure."""

OURS = """
from urdftool.collision.decimate import decimate
decimate(vertices[:3], faces[:1] % 3, 4)
begin = time.perf_counter()
points, triangles = decimate(vertices, faces, target)
"""
FAST = """
import fast_simplification
begin = time.perf_counter()
points, triangles = fast_simplification.simplify(vertices, faces, target_count=target)
"""
MESHLAB = """
import pymeshlab
meshes = pymeshlab.MeshSet()
meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
begin = time.perf_counter()
meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=target)
points, triangles = meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()
"""
FRAME = """
import sys, time, numpy as np
with np.load(sys.argv[1]) as given:
    vertices, faces = given["vertices"].astype(float), given["faces"].astype(np.int32)
target = int(sys.argv[3])
{}
print("SECONDS", time.perf_counter() - begin)
np.savez(sys.argv[2], vertices=points, faces=triangles)
"""


def rows() -> Iterator[Table | str]:
    """A row a mesh for the time, and one for the error."""
    chosen = peers.python()
    codes = {"fast-simplification": FAST, "pymeshlab": MESHLAB}
    there = {name: code for name, code in codes.items() if chosen and peers.has(name)}
    yield from (peers.missing(name) for name in codes if name not in there)
    pairs = Pairs("mesh", list(there), extra=["triangles"])
    errors = Table(["mesh", "urdftool", *there])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for title, vertices, faces in _meshes():
            given = folder / "given.npz"
            np.savez(given, vertices=vertices, faces=faces)
            original = write_stl(folder / "given.stl", vertices, faces)
            sides: dict[str, Call] = {"urdftool": _run(PYTHON, OURS, given, folder / "urdftool")}
            for peer, code in there.items():
                sides[peer] = _run(chosen or "", code, given, folder / peer)
            taken = in_turn(sides, rounds=5, budget=20, label=title)
            pairs.add(title, taken, f"{len(faces):,}")
            cells = [_error(taken[side], folder / side, original) for side in sides]
            errors.rows.append([title, *cells])
    yield pairs.table()
    errors.reading = [
        "urdftool leaves vertices where they are and never tears a surface; the others move them "
        "to where the error is least, and fast-simplification stops where faces would fold."
    ]
    yield errors


def _run(python: str, code: str, given: Path, made: Path) -> Call:
    return command(
        [python, "-c", FRAME.format(code), given, f"{made}.npz", str(TARGET)], own=True, codes=(0,)
    )


def _error(taken: Taken, made: Path, original: Path) -> str:
    """Error and triangles, by the ruler of the others."""
    if taken.why:
        return "failed"
    with np.load(f"{made}.npz") as found:
        faces = found["faces"].astype(np.int64)
        stl = write_stl(made.with_suffix(".stl"), found["vertices"], faces)
    said = ruled(original, stl)
    return f"{len(faces):,} triangles" if said is None else f"{said[2]:.2%} ({said[0]:,} triangles)"


def ruled(original: Path, made: Path) -> tuple[int, int, float] | None:
    """Triangles, pieces and error of a mesh; None where MeshLab is missing or fails."""
    chosen = peers.python()
    if chosen is None or not peers.has("pymeshlab"):
        return None
    ruler = Path(__file__).with_name("ruler.py")
    taken = command([chosen, ruler, original, made], codes=(0,))()
    found = dict(re.findall(r"^(TRIANGLES|PIECES|ERROR) (\S+)$", taken.out, re.MULTILINE))
    if taken.why or len(found) < 3:
        return None
    return int(found["TRIANGLES"]), int(found["PIECES"]), float(found["ERROR"])


def _meshes() -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    from urdftool.collision.surface import read_surface

    folder = example_folder()
    for name in MESHES:
        path = folder / "robots" / name if folder else None
        if path is not None and not path.exists():
            path = next(iter(sorted(folder.rglob(Path(name).name))), None) if folder else None
        if path is not None:
            surface = read_surface(path)
            yield path.name, surface.vertices, surface.faces
    yield "generated torus with waves", *bumpy_torus(200_000)
