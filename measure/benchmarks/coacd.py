"""``collision --method coacd`` against CoACD's own defaults"""

from __future__ import annotations

import importlib.util
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from . import peers
from .collision import meshes
from .robots import example_folder
from .table import Table

PEERS = ("coacd",)
CORPUS = peers.ROOT.parent / "shared" / "corpus-meshes"
MORE = ("z1_Link03.STL", "torso_lift_link.stl")
LONG = 20.0  # seconds by the clock from which a run of CoACD counts as long
ABOUT = """\
For urdftool the whole command is timed, for CoACD only the call of its function, both with all
cores, one after the other. The errors are those of all surfaces of all pieces, and of the
surfaces that can be touched, relative to the diagonal. For one mesh: `python -m
measure.benchmarks.collision_coacd MESH`."""


def rows() -> Iterator[Table | str]:
    """A row for each mesh and side."""
    from .collision_coacd import compared

    if importlib.util.find_spec("coacd") is None:
        yield peers.missing("coacd")
        return
    head = ["mesh", "made by", "elapsed time", "processor", "triangles", "pieces"]
    table = Table([*head, "error", "touchable error"])
    pairs: list[tuple[Any, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        for path in _meshes(Path(name)):
            shown = path.name.rpartition("__")[2]
            print(f"  {shown}", file=sys.stderr, flush=True)
            (_, theirs), (_, ours) = compared(path, Path(name))
            assert ours is not None
            if theirs is not None:
                pairs.append((theirs, ours))
            table.rows += [_line(shown, "CoACD", theirs), _line(shown, "urdftool, coacd", ours)]
    long = [(theirs, ours) for theirs, ours in pairs if theirs.clock > LONG]
    if long:
        table.reading = [_reading(long)]
    yield table


def _meshes(folder: Path) -> Iterator[Path]:
    """Those of the corpus where it is beside the checkout, else those of example robots."""
    from .collision_coacd import meshes as named

    if CORPUS.is_dir():
        yield from named([CORPUS])
        return
    data = example_folder()
    more = [found for part in MORE if data for found in sorted(data.rglob(part))[:1]]
    yield from (*meshes(folder), *more)


def _line(mesh: str, side: str, row: Any) -> Sequence[str]:
    if row is None:
        return mesh, side, "died or took too long", *["–"] * 5
    _, processor, clock, triangles, pieces, error, touched = row
    return (
        mesh, side, f"{clock:.1f} s", f"{processor:.1f} s", f"{triangles:,}", str(pieces),
        f"{100 * error:.2f} %", f"{100 * touched:.2f} %",
    )  # fmt: skip


def _reading(pairs: Sequence[tuple[Any, Any]]) -> str:
    def span(name: str) -> str:
        ratios = [getattr(ours, name) / getattr(theirs, name) for theirs, ours in pairs]
        return f"{min(ratios):.2f} to {max(ratios):.2f}"

    return (
        f"Where the default takes over {LONG:.0f} s, urdftool takes {span('clock')} of its "
        f"elapsed time and {span('processor')} of its processor time, with "
        f"{span('triangles')} of its "
        f"triangles, {span('error')} of its error of all surfaces, and {span('touched')} of its "
        "touchable error."
    )
