"""How cost grows with files: ``lint``"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator

from . import peers
from .robots import bullet_robots, example_robots, options_of
from .table import Pairs, Table
from .timing import URDFTOOL, Call, Taken, command, each, in_turn

PEERS = ("check_urdf", "simcheck")
COUNTS = (1, 10, 100)
ABOUT = """\
The first files of example-robot-data and pybullet_data, with the meshes they name. urdftool and
simcheck get all in one command, check_urdf one at a time."""


def rows() -> Iterator[Table | str]:
    """A row for each number of files."""
    robots = [*example_robots(), *bullet_robots()]
    if len(robots) < COUNTS[-1]:
        yield peers.missing("example-robot-data")
        return
    check, simcheck = peers.tool("check_urdf"), peers.tool("simcheck")
    names = [name for name, found in (("check_urdf", check), ("simcheck", simcheck)) if found]
    pairs = Pairs("files", names)
    with tempfile.TemporaryDirectory() as folder:
        for count in COUNTS:
            files = robots[:: len(robots) // count][:count]
            place = next((found for path in files if (found := options_of(path))), [])
            lint = [*URDFTOOL, "lint", *place, *files]
            sides: dict[str, Call] = {
                "urdftool": command([*lint, "--no-cache"]),
                "kept": command([*lint, "--cache-dir", folder]),
            }
            if check:
                sides["check_urdf"] = each([command([check, f], codes=range(256)) for f in files])
            taken = in_turn(sides, rounds=5, budget=20, label=f"{count} files")
            late: dict[str, Taken] = {}
            if simcheck and count < 100:  # a hundred would take minutes
                words = [simcheck, "check", "--static-only", "--no-cache", *files]
                late = in_turn({"simcheck": command(words)}, rounds=2, budget=10)
            kept = taken.pop("kept")
            pairs.add(f"{count}, nothing kept", {**taken, **late})
            pairs.add(f"{count}, nothing changed", {**taken, **late, "urdftool": kept})
    yield pairs.table(
        "Meshes are most of the work where nothing is kept: check_urdf does not open them."
    )
