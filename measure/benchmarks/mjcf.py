"""``export mjcf`` against MuJoCo's own import, urdf2mjcf, xacrodoc and scikit-robot"""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from . import peers
from .converters import CONVERTERS, Converter
from .robots import examples_and_made, resolved
from .table import Pairs, Table
from .timing import Call, Taken, command, in_turn

PEERS = ("mujoco", "urdf2mjcf", "xacrodoc", "scikit-robot")
ROBOTS = (
    "ur5_robot.urdf", "panda.urdf", "go2.urdf", "solo12.urdf", "talos_full_v2.urdf", "icub.urdf",
    "baxter.urdf",
)  # fmt: skip
ABOUT = """\
Whole commands, from URDF to an MJCF file with its meshes. urdftool caches conversions of meshes;
*empty cache* is without. The others get a copy with paths instead of package URIs. A result that
MuJoCo does not load is a failure, with its reason below. The results are compared in
[fidelity](fidelity.md)."""

LOAD = "import sys, mujoco; mujoco.MjModel.from_xml_path(sys.argv[1])"


def rows() -> Iterator[Table | str]:
    """A row a robot."""
    others = [c for c in CONVERTERS if c.form == "mjcf" and not c.is_ours]
    names = [c.name for c in others if peers.version(c.package)]
    for other in others:
        if other.name not in names:
            yield peers.missing(other.package)
    ours = next(c for c in CONVERTERS if c.form == "mjcf" and c.is_ours)
    pairs = Pairs("robot", names)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for robot, path in examples_and_made(ROBOTS, folder):
            copy = resolved(path, folder / "in")
            sides = {"urdftool": _call(ours, path, folder / "ours" / "x.xml", folder / "kept")}
            sides["anew"] = _call(ours, path, folder / "ours" / "x.xml", None)
            for other in others:
                if other.name in names:
                    out = folder / other.package / path.stem / "x.xml"
                    sides[other.name] = _call(other, copy, out, None)
            taken = in_turn(sides, rounds=5, budget=15, label=robot)
            anew = taken.pop("anew")
            pairs.add(robot, taken)
            pairs.add(f"{robot}, empty cache", {**taken, "urdftool": anew})
    yield pairs.table(
        "MuJoCo's import reads no COLLADA and drops visuals; xacrodoc calls it. scikit-robot "
        "splits every mesh by color."
    )


def _call(converter: Converter, path: Path, out: Path, cache: Path | None) -> Call:
    """Convert, and see once whether MuJoCo loads it."""
    out.parent.mkdir(parents=True, exist_ok=True)
    words, folder = converter.words(path, out), out.parent
    assert words is not None
    loads: list[str] = []

    def convert() -> Taken:
        with tempfile.TemporaryDirectory() as empty:
            chosen = ["--overwrite", "--force"] if converter.is_ours else []
            env = {**os.environ, "XDG_CACHE_HOME": str(cache or empty)}
            call = command([*words, *chosen], limit=120, codes=(0,), cwd=folder, env=env)
            taken = call()
        if not taken.why and not loads:
            loads.append(_refusal(out))
        why = taken.why or (loads[0] if loads else "")
        return Taken(taken.seconds, taken.peak, why)

    return convert


def _refusal(path: Path) -> str:
    """Why MuJoCo does not load a file; empty if it does."""
    chosen = peers.python()
    if chosen is None:
        return ""
    done = subprocess.run([chosen, "-c", LOAD, str(path)], capture_output=True, text=True)
    if done.returncode == 0:
        return ""
    lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
    telling = [line for line in lines if "Error" in line or "violation" in line] or lines
    return "MuJoCo: " + telling[-1].replace(str(path.parent), "")[:150]
