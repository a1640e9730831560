"""How cost grows with links"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from pathlib import Path

from . import peers
from .robots import made, made_xacro
from .table import Pairs, Table, number
from .timing import URDFTOOL, Call, Taken, command, in_turn

PEERS = ("xacro", "check_urdf", "urdf_to_graphviz", "ign sdf", "mujoco")
COUNTS = (10, 100, 1000, 5000)
LIMIT = 60.0
ABOUT = """\
A generated robot: a base and arms of ten links without contacts, each link with an inertia, a
visual box, a collision box and a revolute joint; for `expand`, a macro call per link. Caches are
off; runs longer than a minute are stopped. **Exponent** is p in time ~ links^p between the two
largest robots, after subtracting the time of the smallest: 1 is linear, 2 is quadratic."""

IMPORT = """
import sys, mujoco
mujoco.mj_saveLastXML(sys.argv[2], mujoco.MjModel.from_xml_path(sys.argv[1]))
"""


def rows() -> Iterator[Table | str]:
    """A table for each command."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        urdf, xacro = {}, {}
        for count in COUNTS:
            urdf[count] = folder / f"made_{count}.urdf"
            urdf[count].write_text(made(count), "utf-8")
            xacro[count] = folder / f"made_{count}.urdf.xacro"
            xacro[count].write_text(made_xacro(count), "utf-8")
        for words, peer, theirs, files in _commands(folder, urdf, xacro):
            yield f"**`urdftool {' '.join(words)}`**" + (f" and {peer}" if peer else "")
            yield _grown(words, peer, theirs, files, folder)


def _commands(
    folder: Path, urdf: dict[int, Path], xacro: dict[int, Path]
) -> Iterator[tuple[list[str], str, list[str], dict[int, Path]]]:
    """Our words, the other's name and command, and the files."""
    tools = {name: peers.tool(name) for name in ("xacro", "check_urdf", "urdf_to_graphviz", "ign")}
    chosen = peers.python()
    mujoco = [chosen, "-c", IMPORT] if chosen and peers.has("mujoco") else []
    yield ["expand"], "xacro", [tools["xacro"] or ""], xacro
    yield ["lint", "--no-cache"], "check_urdf", [tools["check_urdf"] or ""], urdf
    graph = [tools["urdf_to_graphviz"] or ""] if peers.tool("dot") else [""]
    yield ["graph"], "urdf_to_graphviz", graph, urdf
    yield ["info"], "", [""], urdf
    yield ["export", "sdf"], "ign sdf -p", [tools["ign"] or "", "sdf", "-p"], urdf
    yield ["export", "mjcf"], "MuJoCo's import", mujoco or [""], urdf


def _grown(
    words: list[str], peer: str, theirs: list[str], files: dict[int, Path], folder: Path
) -> Table:
    pairs = Pairs("links", [peer] if peer and theirs[0] else [])
    times: dict[str, dict[int, Taken]] = {"urdftool": {}, peer: {}}
    alive = bool(theirs[0])
    for count, path in files.items():
        sides: dict[str, Call] = {"urdftool": _ours(words, path, folder)}
        if alive:
            out = [str(folder / f"theirs_{count}")] if theirs[-1] == IMPORT else []
            out = [str(folder / "theirs")] if peer == "urdf_to_graphviz" else out
            sides[peer] = command([*theirs, path, *out], cwd=folder, limit=LIMIT, codes=(0,))
        taken = in_turn(sides, rounds=7, budget=8, label=f"{words[-1]}, {count} links")
        pairs.add(f"{count:,}", taken)
        for side, value in taken.items():
            times[side][count] = value
        alive = alive and not taken[peer].why
    said = [f"{_exponent(times['urdftool'])} of urdftool"]
    if peer and len(times[peer]) == len(files) and not any(t.why for t in times[peer].values()):
        said.append(f"{_exponent(times[peer])} of {peer}")
    return pairs.table(f"Exponent: {', '.join(said)}.")


def _ours(words: list[str], path: Path, folder: Path) -> Call:
    out: list[str | Path] = []
    if words[0] in ("graph", "expand"):
        out = ["-o", folder / f"ours_{words[0]}"]
    elif words[0] == "export":
        out = ["-o", folder / f"ours{'.sdf' if words[1] == 'sdf' else '.xml'}", "--overwrite"]
    return command([*URDFTOOL, "-q", *words, path, *out], limit=LIMIT, cwd=folder)


def _exponent(taken: dict[int, Taken]) -> str:
    counts = sorted(taken)
    base = taken[counts[0]].seconds
    one, two = (taken[count].seconds - base for count in counts[-2:])
    if min(one, two) <= 0.01:
        return "none that can be measured"
    return number(math.log(two / one) / math.log(counts[-1] / counts[-2]))
