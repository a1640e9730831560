"""``collision`` of heavy meshes against CoACD, V-HACD, one hull and vendors' own collisions"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import peers
from .robots import example_folder
from .table import Table

PEERS = ("coacd", "pybullet")
CORPUS = peers.ROOT.parent / "shared" / "corpus-meshes"
ROBOTS = (
    "ur_description/urdf/ur5_robot.urdf", "panda_description/urdf/panda.urdf",
    "go2_description/urdf/go2.urdf", "g1_description/urdf/g1_29dof_rev_1_0.urdf",
    "talos_data/robots/talos_full_v2.urdf", "tiago_description/robots/tiago.urdf",
    "xarm_description/urdf/xarm7.urdf", "kinova_description/robots/kinova.urdf",
    "z1_description/urdf/z1.urdf", "allegro_hand_description/urdf/allegro_left_hand.urdf",
)  # fmt: skip
LIMIT = float(os.environ.get("URDFTOOL_COACD_LIMIT", "900"))  # seconds by the clock
KEPT = os.environ.get("URDFTOOL_COACD_RESULTS")  # a folder of results that are not computed again
OURS: tuple[tuple[str, dict[str, object]], ...] = (
    ("auto", {}),
    ("auto, tight", {"quality": "tight"}),
    ("auto, tight, 2 %, 48 pieces", {"quality": "tight", "max_error": 0.02, "max_hulls": 48}),
)
VHACD = """
import sys, pybullet
pybullet.vhacd(sys.argv[1], sys.argv[2], sys.argv[3], resolution=100000, gamma=0.0005)
"""
ABOUT = f"""\
Processor time (user and system) of one thread of BLAS for a mesh in memory: `auto` is a call of the
function behind `collision`, with its defaults, with `--quality tight`, and with `--max-error 0.02
--max-hulls 48` in addition; CoACD is `run_coacd` with its defaults, stopped after {LIMIT:.0f} s by
the clock; V-HACD is that of PyBullet with 100,000 voxels. Of each robot, the link with the most
triangles is taken. *Error* is the larger one of reach and excess, relative to the diagonal,
measured in the same way for all methods; *volume* is relative to that of the visual."""


class Line(NamedTuple):
    """What one method made of a mesh."""

    side: str
    seconds: float | None
    pieces: int
    triangles: int
    error: float
    reach: float
    excess: float
    volume: float


def rows() -> Iterator[Table | str]:
    """A line for each mesh and method, and medians."""
    from urdftool.collision.measure import ReferenceSurface
    from urdftool.collision.surface import read_surface

    head = ["mesh", "method", "processor", "pieces", "triangles", "error", "reach", "excess"]
    table = Table([*head, "volume"])
    sides: dict[str, list[Line]] = {}
    pairs: list[tuple[Line, Line]] = []
    with tempfile.TemporaryDirectory() as name:
        for shown, path, scale, vendor in _subjects():
            print(f"  {shown}", file=sys.stderr, flush=True)
            surface = read_surface(path, scale)
            target = ReferenceSurface(surface)
            found = []
            for line in _lines(target, surface, vendor, Path(name)):
                found.append(line)
                print("   ", *_cells(shown, line), file=sys.stderr, flush=True)
                sides.setdefault(line.side, []).append(line)
                table.rows.append(_cells(shown, line))
            by = {line.side: line for line in found}
            if "CoACD" in by:
                pairs.append((by[OURS[-1][0]], by["CoACD"]))
    for side, lines in sides.items():
        table.rows.append(_cells(f"median of {len(lines)}", _median(side, lines)))
    table.reading = _reading(pairs)
    yield table


def _subjects() -> Iterator[tuple[str, Path, tuple[float, float, float], Any]]:
    """Name, mesh file, scale and the vendor's pieces."""
    if CORPUS.is_dir():
        for path in sorted(CORPUS.iterdir()):
            if path.suffix.lower() in (".stl", ".obj", ".dae"):
                yield path.name.rpartition("__")[2], path, (1.0, 1.0, 1.0), None
    folder = example_folder()
    for name in ROBOTS:
        path = folder / "robots" / name if folder else None
        if path is not None and path.is_file() and (found := _heaviest(path)) is not None:
            yield found


def _heaviest(path: Path) -> tuple[str, Path, tuple[float, float, float], Any] | None:
    """The link of one visual mesh with most triangles, with its collision in the mesh's frame."""
    import urdftool
    from urdftool.collision.check import convert_shape
    from urdftool.collision.convex import compute_hull
    from urdftool.collision.piece import make_mesh_piece
    from urdftool.errors import UrdftoolError
    from urdftool.geometry.load import load_mesh
    from urdftool.model.elements import Mesh
    from urdftool.model.pose import make_pose

    robot = urdftool.load(path)
    best: Any = None
    for link in robot.links:
        if len(link.visuals) != 1 or not isinstance(link.visuals[0].geometry, Mesh):
            continue
        mesh, pose = link.visuals[0].geometry, make_pose(link.visuals[0].origin)
        try:
            file = Path(robot.source.resolve(mesh.filename))
            count = len(load_mesh(file).faces)
            pieces = [piece for shape in link.collisions for piece in convert_shape(robot, shape)]
        except UrdftoolError:
            continue
        if not pieces or (best is not None and count <= best[0]):
            continue
        back = np.array(pose.rotation).T
        shift = -back @ np.array(pose.translation)
        placed = [
            (p if p.is_primitive else make_mesh_piece(*compute_hull(p.vertices))).transform(
                back, shift
            )
            for p in pieces
        ]
        best = count, (f"{path.stem} {link.name}", file, mesh.scale, placed)
    return None if best is None else best[1]


def _lines(target: Any, surface: Any, vendor: Any, folder: Path) -> Iterator[Line]:
    from urdftool.collision.choose import choose
    from urdftool.collision.convex import compute_hull
    from urdftool.collision.piece import make_mesh_piece
    from urdftool.collision.settings import Settings

    for side, table in OURS:
        begin = time.process_time()
        choice = choose(surface, Settings().replace_some(table))
        yield _line(side, time.process_time() - begin, target, choice.pieces)
    begin = time.process_time()
    whole = [make_mesh_piece(*compute_hull(surface.vertices))]
    yield _line("one hull", time.process_time() - begin, target, whole)
    if vendor:
        yield _line("vendor's", None, target, vendor)
    for side, made in (("V-HACD", _vhacd), ("CoACD", _coacd)):
        result = made(surface, folder)
        if result is not None:
            yield _line(side, result[0], target, result[1])


def _line(side: str, seconds: float | None, target: Any, pieces: Any) -> Line:
    from urdftool.collision.measure import measure

    found = measure(target, pieces)
    triangles = sum(len(piece.faces) for piece in pieces if not piece.is_primitive)
    return Line(
        side, seconds, len(pieces), triangles, found.error, found.visual_to_collision / found.size,
        found.collision_to_visual / found.size, found.volume_ratio,
    )  # fmt: skip


def _coacd(surface: Any, folder: Path) -> tuple[float, Any] | None:
    from urdftool.collision.piece import make_mesh_piece

    from .collision_coacd import DEFAULT

    given = folder / "given.npz"
    arrays = [np.ascontiguousarray(array) for array in (surface.vertices, surface.faces)]
    name = sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()[:16]
    made = Path(KEPT or folder, f"{name}.npz")
    np.savez(given, v=surface.vertices, f=surface.faces)
    if not made.exists():
        try:
            subprocess.run(
                [sys.executable, "-c", DEFAULT, str(given), str(made)],
                capture_output=True, timeout=LIMIT, check=True,
            )  # fmt: skip
        except subprocess.SubprocessError:
            return None
    with np.load(made) as found:
        pieces = [
            make_mesh_piece(found[f"v{k}"], found[f"f{k}"]) for k in range(int(found["pieces"]))
        ]
        return float(found["processor"]), pieces


def _vhacd(surface: Any, folder: Path) -> tuple[float, Any] | None:
    from urdftool.collision.convex import compute_hull
    from urdftool.collision.piece import make_mesh_piece
    from urdftool.geometry.load import load_mesh

    given, made = folder / "given.obj", folder / "made.obj"
    with open(given, "w", encoding="utf-8") as file:
        file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in surface.vertices)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in surface.faces + 1)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        subprocess.run(
            [sys.executable, "-c", VHACD, str(given), str(made), str(folder / "log")],
            capture_output=True, timeout=LIMIT, check=True,
        )  # fmt: skip
    except subprocess.SubprocessError:
        return None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    mesh = load_mesh(made)
    pieces = [
        make_mesh_piece(*compute_hull(mesh.vertices[np.unique(mesh.get_part_faces(p))]))
        for p in mesh.parts
    ]
    return used, pieces


def _median(side: str, lines: Sequence[Line]) -> Line:
    def middle(name: str) -> float:
        return statistics.median(getattr(line, name) for line in lines)

    seconds = None if lines[0].seconds is None else middle("seconds")
    return Line(
        side, seconds, round(middle("pieces")), round(middle("triangles")), middle("error"),
        middle("reach"), middle("excess"), middle("volume"),
    )  # fmt: skip


def _cells(mesh: str, line: Line) -> Sequence[str]:
    return (
        mesh, line.side, "–" if line.seconds is None else f"{line.seconds:.2f} s",
        str(line.pieces), f"{line.triangles:,}", *(
            f"{100 * value:.1f} %" for value in (line.error, line.reach, line.excess)
        ), f"{line.volume:.2f}",
    )  # fmt: skip


def _reading(pairs: Sequence[tuple[Line, Line]]) -> list[str]:
    if not pairs:
        return []

    def ratio(name: str) -> str:
        return f"{statistics.median(getattr(a, name) / getattr(b, name) for a, b in pairs):.2f}"

    better = sum(a.error <= b.error for a, b in pairs)
    return [
        f"On the {len(pairs)} meshes that CoACD's defaults finished, `{OURS[-1][0]}` takes "
        f"{ratio('seconds')} of the processor time, {ratio('triangles')} of the triangles and "
        f"{ratio('pieces')} of the pieces, with {ratio('error')} times the error, in the median; "
        f"its error is not larger on {better}. `auto` takes the fewest pieces within its limit, "
        "not the smallest error."
    ]
