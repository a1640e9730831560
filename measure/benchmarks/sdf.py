"""``export sdf`` against Gazebo's own ``ign sdf -p``"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from . import peers
from .converters import CONVERTERS
from .robots import examples_and_made, options_of, resolved
from .table import Pairs, Table
from .timing import URDFTOOL, Call, command, in_turn

PEERS = ("ign sdf",)
ROBOTS = ("ur5_robot.urdf", "panda.urdf", "go2.urdf", "talos_full_v2.urdf", "pr2.urdf")
ABOUT = """\
`ign sdf -p` (libsdformat, C++, started by Ruby) prints a model that refers to the meshes in place;
so does urdftool with `--uri package`. By default urdftool copies them, with their textures. The
results are compared in [fidelity](fidelity.md)."""


def rows() -> Iterator[Table | str]:
    """A row a robot."""
    theirs = next(c for c in CONVERTERS if c.package == "ign sdf")
    if peers.version("ign sdf") is None:
        yield peers.missing("ign sdf")
    pairs = Pairs("robot", ["ign sdf -p"])
    copying = Pairs("robot", ["ign sdf -p"])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "copied").mkdir()
        for robot, path in examples_and_made(ROBOTS, folder):
            ours = [*URDFTOOL, "-q", "export", "sdf", path, *options_of(path), "--overwrite"]
            ours.append("--force")
            sides: dict[str, Call] = {
                "urdftool": command([*ours, "-o", folder / "x.sdf", "--uri", "package"]),
                "copying": command([*ours, "-o", folder / "copied" / "x.sdf"]),
            }
            words = theirs.words(resolved(path, folder / "in"), folder / "theirs.sdf")
            if words and peers.version("ign sdf"):
                sides["ign sdf -p"] = command(words, codes=(0,))
            taken = in_turn(sides, budget=10, label=robot)
            copied = taken.pop("copying")
            pairs.add(robot, taken)
            copying.add(f"{robot}, copying meshes", {**taken, "urdftool": copied})
    pairs.rows += copying.rows
    yield pairs.table("The rows that copy meshes do what the other does not.")
